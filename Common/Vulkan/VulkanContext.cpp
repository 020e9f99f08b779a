#include "Common/Vulkan/VulkanContext.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/Create.h"
#include "Common/Vulkan/StagingRing.h"

namespace rt::vulkan {
namespace {

template <class Function>
void load(VkDevice device, const char* name, Function& function) {
    function = reinterpret_cast<Function>(vkGetDeviceProcAddr(device, name));
    if (function == nullptr) throw RenderError(std::string("the Vulkan driver lacks the function ") + name);
}

} // namespace

VulkanContext::VulkanContext(const ContextOptions& options)
    : instance_(options.validation),
      info_(chooseDevice(findDevices(instance_), options.device, options.rayTracing)),
      shaderFigures_(options.shaderFigures) {
    queryLimits();
    createDevice();
    loadFunctions();
    memory_.emplace(info_.device, device(), true);
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = info_.queueFamily;
    commandPool_ = create(device(), vkCreateCommandPool, pool, vkDestroyCommandPool, "Creating a command pool");
    run_.emplace(*this);
    staging_ = std::make_unique<StagingRing>(*this);
}

VulkanContext::~VulkanContext() {
    if (isAbandoned(device())) {
        instance_.abandon();
    } else {
        vkDeviceWaitIdle(device());
    }
}

void VulkanContext::createDevice() {
    VkPhysicalDeviceVulkan12Features core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    core.bufferDeviceAddress = VK_TRUE;
    core.scalarBlockLayout = VK_TRUE;
    std::vector<const char*> extensions;
    const auto enable = [&](bool is, auto& features, const std::vector<const char*>& names) {
        if (!is) return;
        features.pNext = core.pNext;
        core.pNext = &features;
        extensions.insert(extensions.end(), names.begin(), names.end());
    };
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structure{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR};
    structure.accelerationStructure = VK_TRUE;
    enable(info_.hasAccelStructures(), structure, structureExtensions());
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipeline{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR};
    pipeline.rayTracingPipeline = VK_TRUE;
    enable(info_.tracesRays(), pipeline, extensionsFor(RayTracing::Pipeline));
    VkPhysicalDeviceRayQueryFeaturesKHR query{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR};
    query.rayQuery = VK_TRUE;
    enable(info_.queriesRays(), query, extensionsFor(RayTracing::Query));
    VkPhysicalDeviceShaderClockFeaturesKHR clock{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_CLOCK_FEATURES_KHR};
    clock.shaderSubgroupClock = VK_TRUE;
    enable(info_.hasShaderClock, clock, {VK_KHR_SHADER_CLOCK_EXTENSION_NAME});
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR figures{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR};
    figures.pipelineExecutableInfo = VK_TRUE;
    enable(hasShaderFigures(), figures, {VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME});
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &core, {}};
    features.features.sampleRateShading = info_.draws ? VK_TRUE : VK_FALSE;

    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = info_.queueFamily;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    VkDevice device = VK_NULL_HANDLE;
    check(vkCreateDevice(info_.device, &info, nullptr, &device), "Opening " + info_.name);
    device_.reset(device);
    vkGetDeviceQueue(device, info_.queueFamily, 0, &queue_);
}

void VulkanContext::loadFunctions() {
    RayTracingFunctions& f = rayTracing_;
    if (info_.hasAccelStructures()) {
        load(device(), "vkCreateAccelerationStructureKHR", f.createAccelerationStructure);
        load(device(), "vkDestroyAccelerationStructureKHR", f.destroyAccelerationStructure);
        load(device(), "vkGetAccelerationStructureBuildSizesKHR", f.getBuildSizes);
        load(device(), "vkGetAccelerationStructureDeviceAddressKHR", f.getAccelerationStructureAddress);
        load(device(), "vkCmdBuildAccelerationStructuresKHR", f.cmdBuild);
        load(device(), "vkCmdCopyAccelerationStructureKHR", f.cmdCopy);
        load(device(), "vkCmdWriteAccelerationStructuresPropertiesKHR", f.cmdWriteProperties);
    }
    if (info_.tracesRays()) {
        load(device(), "vkCreateRayTracingPipelinesKHR", f.createPipelines);
        load(device(), "vkGetRayTracingShaderGroupHandlesKHR", f.getGroupHandles);
        load(device(), "vkCmdTraceRaysKHR", f.cmdTraceRays);
    }
}

void VulkanContext::queryLimits() {
    VkPhysicalDeviceAccelerationStructurePropertiesKHR structure{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR};
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR pipeline{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR};
    VkPhysicalDeviceIDProperties identity{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES};
    if (info_.hasAccelStructures()) identity.pNext = &structure;
    if (info_.tracesRays()) {
        pipeline.pNext = identity.pNext;
        identity.pNext = &pipeline;
    }
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &identity};
    vkGetPhysicalDeviceProperties2(info_.device, &properties);
    limits_.groupHandleSize = pipeline.shaderGroupHandleSize;
    limits_.groupHandleAlignment = pipeline.shaderGroupHandleAlignment;
    limits_.groupBaseAlignment = pipeline.shaderGroupBaseAlignment;
    limits_.maxInvocations = pipeline.maxRayDispatchInvocationCount;
    limits_.scratchAlignment = structure.minAccelerationStructureScratchOffsetAlignment;
    limits_.maxPrimitives = structure.maxPrimitiveCount;
    limits_.maxInstances = structure.maxInstanceCount;
    const VkPhysicalDeviceLimits& core = properties.properties.limits;
    limits_.maxGroupSize = std::min(core.maxComputeWorkGroupInvocations, core.maxComputeWorkGroupSize[0]);
    limits_.maxDrawnSide = std::min({core.maxFramebufferWidth, core.maxFramebufferHeight, core.maxImageDimension2D,
                                     static_cast<std::uint32_t>(core.maxViewportDimensions[0]),
                                     static_cast<std::uint32_t>(core.maxViewportDimensions[1])});
    limits_.vendor = properties.properties.vendorID;
    limits_.deviceId = properties.properties.deviceID;
    std::memcpy(limits_.pipelineCacheId, properties.properties.pipelineCacheUUID, VK_UUID_SIZE);
    std::copy(std::begin(identity.deviceUUID), std::end(identity.deviceUUID), limits_.uuid.begin());

    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(info_.device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(info_.device, &count, families.data());
    const std::uint32_t bits = families[info_.queueFamily].timestampValidBits;
    if (bits > 0) limits_.timestampSeconds = properties.properties.limits.timestampPeriod * 1e-9;
    limits_.timestampMask = bits >= 64 ? std::numeric_limits<std::uint64_t>::max() : (std::uint64_t{1} << bits) - 1;
}

void VulkanContext::submit(VkCommandBuffer commands, VkFence fence) {
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    const VkResult result = vkQueueSubmit(queue_, 1, &submit, fence);
    if (result == VK_ERROR_DEVICE_LOST) abandon(device());
    check(result, "Running on " + info_.name);
}

VkResult VulkanContext::wait(VkFence fence, std::uint64_t nanoseconds) {
    return vkWaitForFences(device(), 1, &fence, VK_TRUE, nanoseconds);
}

void VulkanContext::run(const Record& record) {
    run_->begin(record);
    run_->finish();
}

double VulkanContext::runTimed(const Record& record) {
    run_->begin(record);
    return finishTimed(*run_);
}

double VulkanContext::finishTimed(Run& run) {
    const double seconds = run.finish();
    longestRun_ = std::max(longestRun_, seconds);
    return seconds;
}

Access VulkanContext::bufferUses() const {
    constexpr VkAccessFlags kShaders =
        VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_UNIFORM_READ_BIT;
    Access uses = kTransferRead | kTransferWrite | Access{VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, kShaders};
    if (info_.draws) uses.stages |= VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
    // Vertices, boxes and instances are shader reads, too, and so is the shader binding table.
    if (info_.hasAccelStructures()) uses.stages |= VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
    if (info_.tracesRays()) uses.stages |= VK_PIPELINE_STAGE_RAY_TRACING_SHADER_BIT_KHR;
    return uses;
}

Access VulkanContext::structureUses() const {
    Access uses = kStructureRead;
    if (info_.tracesRays()) uses = uses | kStructureTrace;
    if (info_.queriesRays()) uses = uses | kStructureQuery;
    return uses;
}

} // namespace rt::vulkan
