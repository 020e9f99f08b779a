#include "Common/Gui/GraphicsDevice.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/MemoryType.h"

namespace rt::gui {
namespace {

using vulkan::check;

std::string lowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

bool hasSwapchain(VkPhysicalDevice device) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
    return std::any_of(extensions.begin(), extensions.end(), [](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, VK_KHR_SWAPCHAIN_EXTENSION_NAME) == 0;
    });
}

std::optional<std::uint32_t> presentingFamily(VkPhysicalDevice device, VkSurfaceKHR surface) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    for (std::uint32_t i = 0; i < count; ++i) {
        VkBool32 presents = VK_FALSE;
        vkGetPhysicalDeviceSurfaceSupportKHR(device, i, surface, &presents);
        if ((families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0 && presents == VK_TRUE) return i;
    }
    return std::nullopt;
}

int rank(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return 3;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return 2;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return 1;
        default:
            return 0;
    }
}

} // namespace

GraphicsDevice::GraphicsDevice(const Window& window, bool validation, const std::string& preferred)
    : instance_(validation, Window::instanceExtensions()), surface_(window.createSurface(instance_.get())) {
    try {
        choose(preferred);
        createDevice();
    } catch (...) {
        vkDestroySurfaceKHR(instance_.get(), surface_, nullptr);
        throw;
    }
}

GraphicsDevice::~GraphicsDevice() {
    vkDeviceWaitIdle(device_);
    vkDestroyDevice(device_, nullptr);
    vkDestroySurfaceKHR(instance_.get(), surface_, nullptr);
}

void GraphicsDevice::choose(const std::string& preferred) {
    std::uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(instance_.get(), &count, nullptr), "Listing Vulkan devices");
    std::vector<VkPhysicalDevice> devices(count);
    check(vkEnumeratePhysicalDevices(instance_.get(), &count, devices.data()), "Listing Vulkan devices");
    int best = -1;
    for (VkPhysicalDevice device : devices) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(device, &properties);
        if (properties.apiVersion < vulkan::kApiVersion || !hasSwapchain(device)) continue;
        const auto family = presentingFamily(device, surface_);
        if (!family) continue;
        const bool named =
            !preferred.empty() && lowerCase(properties.deviceName).find(lowerCase(preferred)) != std::string::npos;
        const int score = rank(properties.deviceType) + (named ? 10 : 0);
        if (score <= best) continue;
        best = score;
        physical_ = device;
        queueFamily_ = *family;
        name_ = properties.deviceName;
        isSoftware_ = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
        maxStorageBytes_ = properties.limits.maxStorageBufferRange;
    }
    if (best < 0) {
        throw vulkan::NoDeviceError("no Vulkan device can draw to a window; --headless renders without one");
    }
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);
}

void GraphicsDevice::createDevice() {
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = queueFamily_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    const char* const extension = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = &extension;
    check(vkCreateDevice(physical_, &info, nullptr, &device_), "Opening " + name_);
    vkGetDeviceQueue(device_, queueFamily_, 0, &queue_);
}

void GraphicsDevice::renewSurface(const Window& window) {
    vkDestroySurfaceKHR(instance_.get(), surface_, nullptr);
    surface_ = VK_NULL_HANDLE;
    surface_ = window.createSurface(instance_.get());
}

std::uint32_t GraphicsDevice::memoryType(std::uint32_t allowed, VkMemoryPropertyFlags wanted) const {
    if (const auto type = vulkan::findMemoryType(memory_, allowed, wanted)) return *type;
    throw RenderError(name_ + " has no memory of the kind that is needed");
}

void GraphicsDevice::run(const std::function<void(VkCommandBuffer)>& record) {
    VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    poolInfo.queueFamilyIndex = queueFamily_;
    VkCommandPool pool = VK_NULL_HANDLE;
    check(vkCreateCommandPool(device_, &poolInfo, nullptr, &pool), "Creating a command pool");
    const vulkan::Handle<VkCommandPool> owner(device_, pool, vkDestroyCommandPool);
    VkCommandBufferAllocateInfo allocation{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocation.commandPool = pool;
    allocation.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    check(vkAllocateCommandBuffers(device_, &allocation, &commands), "Creating a command buffer");
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands, &begin), "Recording commands");
    record(commands);
    check(vkEndCommandBuffer(commands), "Recording commands");
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    check(vkQueueSubmit(queue_, 1, &submit, VK_NULL_HANDLE), "Drawing on " + name_);
    check(vkQueueWaitIdle(queue_), "Drawing on " + name_);
}

GraphicsBuffer::GraphicsBuffer(const GraphicsDevice& device, VkDeviceSize bytes, VkBufferUsageFlags usage,
                               VkMemoryPropertyFlags memory)
    : bytes_(bytes) {
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = bytes;
    info.usage = usage;
    VkBuffer buffer = VK_NULL_HANDLE;
    check(vkCreateBuffer(device.device(), &info, nullptr, &buffer), "Memory for the picture");
    buffer_ = {device.device(), buffer, vkDestroyBuffer};
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device.device(), buffer, &needs);
    VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = device.memoryType(needs.memoryTypeBits, memory);
    VkDeviceMemory storage = VK_NULL_HANDLE;
    check(vkAllocateMemory(device.device(), &allocation, nullptr, &storage), "Memory for the picture");
    memory_ = {device.device(), storage, vkFreeMemory};
    check(vkBindBufferMemory(device.device(), buffer, storage, 0), "Memory for the picture");
    if ((memory & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0) {
        check(vkMapMemory(device.device(), storage, 0, VK_WHOLE_SIZE, 0, &mapped_), "Memory for the picture");
    }
}

} // namespace rt::gui
