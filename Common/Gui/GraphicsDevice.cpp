#include "Common/Gui/GraphicsDevice.h"

#include <vector>

#include "Common/Core/TextSearch.h"
#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/DeviceSelection.h"

namespace rt::gui {
namespace {

using vulkan::check;

bool presents(VkPhysicalDevice device, std::uint32_t family, VkSurfaceKHR surface) {
    VkBool32 answer = VK_FALSE;
    check(vkGetPhysicalDeviceSurfaceSupportKHR(device, family, surface, &answer), "Asking who draws to the window");
    return answer == VK_TRUE;
}

std::optional<std::uint32_t> presentingFamily(VkPhysicalDevice device, VkSurfaceKHR surface) {
    const std::vector<VkQueueFamilyProperties> families = vulkan::queueFamiliesOf(device);
    for (std::uint32_t i = 0; i < families.size(); ++i) {
        if ((families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0 && presents(device, i, surface)) return i;
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
    vkDeviceWaitIdle(device());
    memory_.reset();
    device_.reset(); // before the surface that its swapchains were of
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
        if (properties.apiVersion < vulkan::kApiVersion) continue;
        if (!vulkan::offersExtension(device, VK_KHR_SWAPCHAIN_EXTENSION_NAME)) continue;
        const auto family = presentingFamily(device, surface_);
        if (!family) continue;
        const bool named = !preferred.empty() && contains(properties.deviceName, preferred);
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
    VkDevice device = VK_NULL_HANDLE;
    check(vkCreateDevice(physical_, &info, nullptr, &device), "Opening " + name_);
    device_.reset(device);
    vkGetDeviceQueue(device, queueFamily_, 0, &queue_);
    memory_.emplace(physical_, device, false);
}

void GraphicsDevice::renewSurface(const Window& window) {
    vkDestroySurfaceKHR(instance_.get(), surface_, nullptr);
    surface_ = VK_NULL_HANDLE;
    surface_ = window.createSurface(instance_.get());
    if (!presents(physical_, queueFamily_, surface_)) throw RenderError(name_ + " cannot draw to the window any more");
}

void GraphicsDevice::run(const std::function<void(VkCommandBuffer)>& record) {
    VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    poolInfo.queueFamilyIndex = queueFamily_;
    VkCommandPool pool = VK_NULL_HANDLE;
    check(vkCreateCommandPool(device(), &poolInfo, nullptr, &pool), "Creating a command pool");
    const vulkan::Handle<VkCommandPool> owner(device(), pool, vkDestroyCommandPool);
    VkCommandBufferAllocateInfo allocation{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocation.commandPool = pool;
    allocation.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    check(vkAllocateCommandBuffers(device(), &allocation, &commands), "Creating a command buffer");
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

} // namespace rt::gui
