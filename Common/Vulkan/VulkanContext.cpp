#include "Common/Vulkan/VulkanContext.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/MemoryType.h"

namespace rt::vulkan {
namespace {

template <class Function>
void load(VkDevice device, const char* name, Function& function) {
    function = reinterpret_cast<Function>(vkGetDeviceProcAddr(device, name));
    if (function == nullptr) throw RenderError(std::string("the Vulkan driver lacks the function ") + name);
}

} // namespace

VulkanContext::VulkanContext(const ContextOptions& options)
    : instance_(options.validation), info_(chooseDevice(findDevices(instance_), options.device, options.rayTracing)) {
    vkGetPhysicalDeviceMemoryProperties(info_.device, &memory_);
    queryLimits();
    createDevice();
    try {
        if (info_.tracesRays()) loadFunctions();
        VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
        pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
        pool.queueFamilyIndex = info_.queueFamily;
        VkCommandPool commandPool = VK_NULL_HANDLE;
        check(vkCreateCommandPool(device_, &pool, nullptr, &commandPool), "Creating a command pool");
        commandPool_ = {device_, commandPool, vkDestroyCommandPool};

        run_.emplace(*this);
    } catch (...) {
        commandPool_ = {};
        vkDestroyDevice(device_, nullptr);
        throw;
    }
}

VulkanContext::~VulkanContext() {
    if (device_ == abandonedDevice) {
        instance_.abandon();
        return;
    }
    vkDeviceWaitIdle(device_);
    run_.reset();
    commandPool_ = {};
    vkDestroyDevice(device_, nullptr);
}

void VulkanContext::createDevice() {
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipeline{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR};
    pipeline.rayTracingPipeline = VK_TRUE;
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structure{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR, &pipeline};
    structure.accelerationStructure = VK_TRUE;
    const bool rays = info_.tracesRays();
    VkPhysicalDeviceVulkan12Features core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    if (rays) core.pNext = &structure;
    core.bufferDeviceAddress = VK_TRUE;
    core.scalarBlockLayout = VK_TRUE;
    std::vector<const char*> extensions;
    if (rays) extensions = pipelineExtensions();
    VkPhysicalDeviceShaderClockFeaturesKHR clock{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_CLOCK_FEATURES_KHR};
    if (info_.hasShaderClock) {
        clock.shaderSubgroupClock = VK_TRUE;
        clock.pNext = core.pNext;
        core.pNext = &clock;
        extensions.push_back(VK_KHR_SHADER_CLOCK_EXTENSION_NAME);
    }
    const VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &core, {}};

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
    check(vkCreateDevice(info_.device, &info, nullptr, &device_), "Opening " + info_.name);
    vkGetDeviceQueue(device_, info_.queueFamily, 0, &queue_);
}

void VulkanContext::loadFunctions() {
    RayTracingFunctions& f = rayTracing_;
    load(device_, "vkCreateAccelerationStructureKHR", f.createAccelerationStructure);
    load(device_, "vkDestroyAccelerationStructureKHR", f.destroyAccelerationStructure);
    load(device_, "vkGetAccelerationStructureBuildSizesKHR", f.getBuildSizes);
    load(device_, "vkGetAccelerationStructureDeviceAddressKHR", f.getAccelerationStructureAddress);
    load(device_, "vkCmdBuildAccelerationStructuresKHR", f.cmdBuild);
    load(device_, "vkCmdCopyAccelerationStructureKHR", f.cmdCopy);
    load(device_, "vkCmdWriteAccelerationStructuresPropertiesKHR", f.cmdWriteProperties);
    load(device_, "vkCreateRayTracingPipelinesKHR", f.createPipelines);
    load(device_, "vkGetRayTracingShaderGroupHandlesKHR", f.getGroupHandles);
    load(device_, "vkCmdTraceRaysKHR", f.cmdTraceRays);
}

void VulkanContext::queryLimits() {
    VkPhysicalDeviceAccelerationStructurePropertiesKHR structure{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR};
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR pipeline{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR, &structure};
    VkPhysicalDeviceIDProperties identity{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES};
    if (info_.tracesRays()) identity.pNext = &pipeline;
    VkPhysicalDeviceMaintenance3Properties memory{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES,
                                                  &identity};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &memory};
    vkGetPhysicalDeviceProperties2(info_.device, &properties);
    limits_.groupHandleSize = pipeline.shaderGroupHandleSize;
    limits_.groupHandleAlignment = pipeline.shaderGroupHandleAlignment;
    limits_.groupBaseAlignment = pipeline.shaderGroupBaseAlignment;
    limits_.maxInvocations = pipeline.maxRayDispatchInvocationCount;
    limits_.scratchAlignment = structure.minAccelerationStructureScratchOffsetAlignment;
    limits_.maxPrimitives = structure.maxPrimitiveCount;
    limits_.maxInstances = structure.maxInstanceCount;
    limits_.maxAllocation = memory.maxMemoryAllocationSize;
    const VkPhysicalDeviceLimits& core = properties.properties.limits;
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
    if (result == VK_ERROR_DEVICE_LOST) abandonedDevice = device_;
    check(result, "Running on " + info_.name);
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

std::uint32_t VulkanContext::memoryType(std::uint32_t allowed, VkMemoryPropertyFlags required,
                                        VkMemoryPropertyFlags preferred) const {
    for (const VkMemoryPropertyFlags wanted : {required | preferred, required}) {
        if (const auto type = findMemoryType(memory_, allowed, wanted)) return *type;
    }
    throw RenderError(info_.name + " has no memory of the kind that is needed");
}

void barrier(VkCommandBuffer commands) {
    VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    memory.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    memory.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &memory, 0, nullptr, 0,
                         nullptr);
}

} // namespace rt::vulkan
