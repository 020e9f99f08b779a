// Which Vulkan devices there are, whether each can trace rays for us, and which one to take.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

#include "Common/Vulkan/Instance.h"

namespace rt::vulkan {

struct DeviceInfo {
    VkPhysicalDevice device = VK_NULL_HANDLE;
    std::string name;
    std::string driver;  // its name and version
    std::string version; // of Vulkan
    VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    std::uint32_t queueFamily = 0;
    std::string missing; // what it lacks, in words; empty: suitable
    bool suitable() const { return missing.empty(); }
};

// Extensions that a suitable device has and that we enable.
const std::vector<const char*>& requiredExtensions();

// In the driver's order: the index is what --device takes.
std::vector<DeviceInfo> findDevices(const Instance& instance);

// One line a device, with the reason where one is unsuitable; a line that says so where there is none.
std::string describeDevices(const std::vector<DeviceInfo>& devices);

// The device with this index or with this text in its name, whatever the case; with an empty request the best: discrete
// before integrated before software. Throws NoDeviceError naming what there is.
DeviceInfo chooseDevice(const std::vector<DeviceInfo>& devices, const std::string& request);

}  // namespace rt::vulkan
