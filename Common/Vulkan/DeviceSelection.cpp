#include "Common/Vulkan/DeviceSelection.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>

#include "Common/Core/Printable.h"
#include "Common/Core/TextSearch.h"
#include "Common/Vulkan/Check.h"

namespace rt::vulkan {
namespace {

std::string versionText(std::uint32_t version) {
    return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
           std::to_string(VK_API_VERSION_PATCH(version));
}

void addMissing(std::string& list, const std::string& what) {
    list += (list.empty() ? "" : ", ") + what;
}

std::vector<VkExtensionProperties> extensionsOf(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr), "Listing a device's extensions");
    std::vector<VkExtensionProperties> extensions(count);
    check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data()),
          "Listing a device's extensions");
    return extensions;
}

bool contains(const std::vector<VkExtensionProperties>& extensions, const char* name) {
    return std::any_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, name) == 0;
    });
}

// Of extensions first: features of those that are missing may not be asked for.
std::string missingFor(VkPhysicalDevice device, const std::vector<VkExtensionProperties>& extensions, RayTracing use) {
    std::string missing;
    for (const auto& names : {extensionsFor(use), structureExtensions()}) {
        for (const char* name : names) {
            if (!contains(extensions, name)) addMissing(missing, name);
        }
    }
    if (!missing.empty()) return missing;
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipeline{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR};
    VkPhysicalDeviceRayQueryFeaturesKHR query{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR};
    const bool isPipeline = use == RayTracing::Pipeline;
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structure{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR,
        isPipeline ? static_cast<void*>(&pipeline) : &query};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &structure};
    vkGetPhysicalDeviceFeatures2(device, &features);
    if (isPipeline && pipeline.rayTracingPipeline == VK_FALSE) addMissing(missing, "feature rayTracingPipeline");
    if (!isPipeline && query.rayQuery == VK_FALSE) addMissing(missing, "feature rayQuery");
    if (structure.accelerationStructure == VK_FALSE) addMissing(missing, "feature accelerationStructure");
    return missing;
}

bool hasShaderFigures(VkPhysicalDevice device, const std::vector<VkExtensionProperties>& extensions) {
    if (!contains(extensions, VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME)) return false;
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR figures{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &figures};
    vkGetPhysicalDeviceFeatures2(device, &features);
    return figures.pipelineExecutableInfo == VK_TRUE;
}

bool hasShaderClock(VkPhysicalDevice device, const std::vector<VkExtensionProperties>& extensions) {
    if (!contains(extensions, VK_KHR_SHADER_CLOCK_EXTENSION_NAME)) return false;
    VkPhysicalDeviceShaderClockFeaturesKHR clock{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_CLOCK_FEATURES_KHR};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &clock};
    vkGetPhysicalDeviceFeatures2(device, &features);
    return clock.shaderSubgroupClock == VK_TRUE;
}

std::string missingFeatures(VkPhysicalDevice device) {
    VkPhysicalDeviceVulkan12Features core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &core};
    vkGetPhysicalDeviceFeatures2(device, &features);
    std::string missing;
    if (core.bufferDeviceAddress == VK_FALSE) addMissing(missing, "feature bufferDeviceAddress");
    if (core.scalarBlockLayout == VK_FALSE) addMissing(missing, "feature scalarBlockLayout");
    return missing;
}

std::optional<std::uint32_t> findQueueFamily(VkPhysicalDevice device) {
    const std::vector<VkQueueFamilyProperties> families = queueFamiliesOf(device);
    std::optional<std::uint32_t> best;
    for (std::uint32_t i = 0; i < families.size(); ++i) {
        // A queue that can draw as well serves a window too.
        if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) == 0) continue;
        if (!best || (families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0) best = i;
        if ((families[*best].queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0) break;
    }
    return best;
}

bool canDraw(VkPhysicalDevice device, std::uint32_t queueFamily) {
    const std::vector<VkQueueFamilyProperties> families = queueFamiliesOf(device);
    if (queueFamily >= families.size() || (families[queueFamily].queueFlags & VK_QUEUE_GRAPHICS_BIT) == 0) return false;
    VkPhysicalDeviceFeatures features;
    vkGetPhysicalDeviceFeatures(device, &features);
    if (!features.sampleRateShading) return false;
    VkFormatProperties format;
    vkGetPhysicalDeviceFormatProperties(device, kDepthFormat, &format);
    return (format.optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT) != 0;
}

DeviceInfo describe(VkPhysicalDevice device) {
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
    vkGetPhysicalDeviceProperties2(device, &properties);
    DeviceInfo info;
    info.device = device;
    info.name = printable(properties.properties.deviceName);
    info.driver = printable(std::string(driver.driverName) + " " + driver.driverInfo);
    info.version = versionText(properties.properties.apiVersion);
    info.type = properties.properties.deviceType;
    if (properties.properties.apiVersion < kApiVersion) {
        info.missing = "Vulkan " + versionText(kApiVersion);
        return info;
    }
    const std::vector<VkExtensionProperties> extensions = extensionsOf(device);
    info.missing = missingFeatures(device);
    info.hasShaderClock = hasShaderClock(device, extensions);
    info.hasShaderFigures = hasShaderFigures(device, extensions);
    info.missingForPipeline = missingFor(device, extensions, RayTracing::Pipeline);
    info.missingForQuery = missingFor(device, extensions, RayTracing::Query);
    if (driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE && !info.missingForPipeline.empty()) {
        // Mesa's older software driver ends the loops of shaders early, which leaves work undone: seen with 22.3.6, not
        // with 25.0.7. Its version number does not tell them apart.
        addMissing(info.missing, "loops of any length (Mesa 25.0 has them)");
    }
    const std::optional<std::uint32_t> family = findQueueFamily(device);
    if (!family) addMissing(info.missing, "a compute queue");
    info.queueFamily = family.value_or(0);
    info.draws = family && canDraw(device, *family);
    return info;
}

const char* kindName(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return "discrete";
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return "integrated";
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return "virtual";
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return "software";
        default:
            return "of another kind";
    }
}

int rank(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return 4;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return 3;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return 2;
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return 1;
        default:
            return 0;
    }
}

std::string lacks(const DeviceInfo& device, RayTracing needed) {
    if (!device.missing.empty()) return device.missing;
    return needed == RayTracing::Query ? device.missingForQuery : device.missingForPipeline;
}

// What the devices that do not serve a need are without.
const char* nameOf(RayTracing needed) {
    return needed == RayTracing::Query ? "ray queries" : "a ray tracing pipeline";
}

const DeviceInfo* findRequested(const std::vector<DeviceInfo>& devices, const std::string& request, RayTracing needed) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(request.data(), request.data() + request.size(), index);
    if (error == std::errc() && end == request.data() + request.size()) {
        return index < devices.size() ? &devices[index] : nullptr;
    }
    const DeviceInfo* found = nullptr;
    for (const DeviceInfo& device : devices) {
        if (!rt::contains(device.name, request)) continue;
        if (found == nullptr || (device.serves(needed) && !found->serves(needed))) found = &device;
    }
    return found;
}

} // namespace

std::vector<VkQueueFamilyProperties> queueFamiliesOf(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    return families;
}

bool offersExtension(VkPhysicalDevice device, const char* name) {
    return contains(extensionsOf(device), name);
}

const std::vector<const char*>& structureExtensions() {
    static const std::vector<const char*> extensions{VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                                     VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};
    return extensions;
}

const std::vector<const char*>& extensionsFor(RayTracing use) {
    static const std::vector<const char*> none, pipeline{VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME},
        query{VK_KHR_RAY_QUERY_EXTENSION_NAME};
    return use == RayTracing::None ? none : use == RayTracing::Pipeline ? pipeline : query;
}

std::vector<DeviceInfo> findDevices(const Instance& instance) {
    std::uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(instance.get(), &count, nullptr), "Listing Vulkan devices");
    std::vector<VkPhysicalDevice> handles(count);
    check(vkEnumeratePhysicalDevices(instance.get(), &count, handles.data()), "Listing Vulkan devices");
    std::vector<DeviceInfo> devices;
    devices.reserve(handles.size());
    for (VkPhysicalDevice handle : handles) devices.push_back(describe(handle));
    return devices;
}

std::string describeDevices(const std::vector<DeviceInfo>& devices) {
    if (devices.empty()) return "no Vulkan device\n";
    std::string text;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const DeviceInfo& device = devices[i];
        text += std::to_string(i) + ": " + device.name + " (" + kindName(device.type) + ", " + device.driver +
                ", Vulkan " + device.version + "): ";
        if (!device.suitable()) {
            text += "unsuitable, lacks " + device.missing + "\n";
        } else if (!device.tracesRays()) {
            text += std::string(device.queriesRays() ? "query and compute" : "compute") + " only; pipeline lacks " +
                    device.missingForPipeline + "\n";
        } else {
            text += std::string(device.queriesRays() ? "query, " : "") + "pipeline, compute: suitable\n";
        }
    }
    return text;
}

DeviceInfo chooseDevice(const std::vector<DeviceInfo>& devices, const std::string& request, RayTracing needed) {
    const bool anyServes = needed == RayTracing::None;
    const DeviceInfo* chosen = nullptr;
    if (!request.empty()) {
        chosen = findRequested(devices, request, needed);
        if (chosen == nullptr) {
            throw NoDeviceError("no Vulkan device matches '" + request + "'; --list-devices shows what there is");
        }
        if (!chosen->serves(needed)) {
            const std::string purpose = anyServes ? " cannot render" : std::string(" does not have ") + nameOf(needed);
            throw NoDeviceError(chosen->name + purpose + ": it lacks " + lacks(*chosen, needed));
        }
        return *chosen;
    }
    for (const DeviceInfo& device : devices) {
        if (!device.serves(needed)) continue;
        if (chosen == nullptr || rank(device.type) > rank(chosen->type)) chosen = &device;
    }
    if (chosen == nullptr) {
        std::string found = devices.empty() ? "there is no Vulkan device" : "";
        for (const DeviceInfo& device : devices) addMissing(found, device.name + " lacks " + lacks(device, needed));
        throw NoDeviceError("no Vulkan device " + (anyServes ? "can render" : std::string("has ") + nameOf(needed)) +
                            ": " + found +
                            (anyServes ? "; a newer driver may help" : "; --engine compute does without"));
    }
    return *chosen;
}

std::vector<std::size_t> devicesForRanks(const std::vector<DeviceInfo>& devices, RayTracing needed) {
    const VkPhysicalDeviceType type = chooseDevice(devices, "", needed).type;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < devices.size(); ++i)
        if (devices[i].type == type && devices[i].serves(needed)) places.push_back(i);
    return places;
}

} // namespace rt::vulkan
