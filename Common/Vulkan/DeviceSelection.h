// Which Vulkan devices there are, what each can do for us, and which one to take.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

#include "Common/Vulkan/Instance.h"

namespace rt::vulkan {

inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

// What is asked of a device beyond compute shaders.
enum class RayTracing { None, Pipeline, Query };

struct DeviceInfo {
    VkPhysicalDevice device = VK_NULL_HANDLE;
    std::string name;
    std::string driver;  // its name and version
    std::string version; // of Vulkan
    VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    std::uint32_t queueFamily = 0;
    bool draws = false;             // its queue rasterises, too, into kDepthFormat, and shades single samples
    bool hasShaderClock = false;    // shaders may ask what time it is
    bool hasShaderFigures = false;  // its driver tells what compiled shaders are like
    std::string missing;            // what it lacks to render at all, in words
    std::string missingForPipeline; // what it lacks beyond that for ray tracing pipelines
    std::string missingForQuery;    // likewise for ray queries, by which any shader traces rays
    bool isSoftware() const { return type == VK_PHYSICAL_DEVICE_TYPE_CPU; }
    bool isDiscrete() const { return type == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU; }
    bool suitable() const { return missing.empty(); }
    bool tracesRays() const { return missing.empty() && missingForPipeline.empty(); }
    bool queriesRays() const { return missing.empty() && missingForQuery.empty(); }
    bool serves(RayTracing needed) const {
        return needed == RayTracing::None ? suitable() : needed == RayTracing::Pipeline ? tracesRays() : queriesRays();
    }
    bool hasAccelStructures() const { return tracesRays() || queriesRays(); }
};

std::vector<VkQueueFamilyProperties> queueFamiliesOf(VkPhysicalDevice device);
// Throws RenderError where the driver cannot tell.
bool offersExtension(VkPhysicalDevice device, const char* name);

// Extensions of acceleration structures, and of what traces rays through them besides; we enable those of which a
// device has all.
const std::vector<const char*>& structureExtensions();
const std::vector<const char*>& extensionsFor(RayTracing use);

// In the driver's order: the index is what --device takes.
std::vector<DeviceInfo> findDevices(const Instance& instance);

// One line a device, with its engines and the reasons where one is missing; a line that says so where there is no
// device.
std::string describeDevices(const std::vector<DeviceInfo>& devices);

// The device with this index or with this text in its name, whatever the case; with an empty request the best: discrete
// before integrated before software. Only those with what is `needed`. Throws NoDeviceError naming what there is.
DeviceInfo chooseDevice(const std::vector<DeviceInfo>& devices, const std::string& request, RayTracing needed);

// The places of all devices of the best one's type: what the ranks of a host take in turn. Throws as chooseDevice().
std::vector<std::size_t> devicesForRanks(const std::vector<DeviceInfo>& devices, RayTracing needed);

} // namespace rt::vulkan
