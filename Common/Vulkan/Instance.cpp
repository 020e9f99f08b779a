#include "Common/Vulkan/Instance.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "Common/Core/Log.h"
#include "Common/Vulkan/Check.h"

namespace rt::vulkan {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

bool hasValidationLayer() {
    std::uint32_t count = 0;
    check(vkEnumerateInstanceLayerProperties(&count, nullptr), "Listing Vulkan layers");
    std::vector<VkLayerProperties> layers(count);
    check(vkEnumerateInstanceLayerProperties(&count, layers.data()), "Listing Vulkan layers");
    return std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
        return std::strcmp(layer.layerName, kValidationLayer) == 0;
    });
}

std::atomic<std::uint64_t> allMessages{0};

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* counter) {
    constexpr std::uint64_t kMaxShown = 20;
    const auto before = static_cast<std::atomic<std::uint64_t>*>(counter)->fetch_add(1, std::memory_order_relaxed);
    allMessages.fetch_add(1, std::memory_order_relaxed);
    if (before < kMaxShown) logWarning(std::string("validation: ") + data->pMessage);
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(std::atomic<std::uint64_t>& counter) {
    VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = onMessage;
    info.pUserData = &counter;
    return info;
}

} // namespace

std::uint64_t Instance::allValidationMessages() {
    return allMessages.load(std::memory_order_relaxed);
}

Instance::Instance(bool validation, std::vector<const char*> extensions) {
    if (validation && !hasValidationLayer()) {
        throw RenderError(std::string("--validation needs the layer ") + kValidationLayer +
                          "; Debian and Ubuntu: apt install vulkan-validationlayers");
    }
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "Ray Tracing Twins";
    application.apiVersion = kApiVersion;

    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;

    VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(messages_);
    const std::array enabled{VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkValidationFeaturesEXT checks{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, &messenger};
    checks.enabledValidationFeatureCount = static_cast<std::uint32_t>(enabled.size());
    checks.pEnabledValidationFeatures = enabled.data();
    if (validation) {
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
        info.pNext = &checks;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &kValidationLayer;
    }
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
    // A driver's description that it cannot read is no driver to newer loaders, to older ones memory that ran out.
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
        throw NoDeviceError(
            "no Vulkan driver is installed, or a driver's file is damaged; Mesa's software driver needs version "
            "25.0 or newer (./build.sh run provides it)");
    }
    if (result == VK_ERROR_OUT_OF_HOST_MEMORY)
        throw NoDeviceError("Vulkan does not start: a driver's file is damaged, or memory is short");
    check(result, "Starting Vulkan");
    if (!validation) return;

    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
    const VkResult created = create(instance_, &messenger, nullptr, &messenger_);
    if (created != VK_SUCCESS) vkDestroyInstance(instance_, nullptr);
    check(created, "Listening to Vulkan's validation");
}

Instance::~Instance() {
    if (messenger_ != VK_NULL_HANDLE) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(instance_, messenger_, nullptr);
    }
    vkDestroyInstance(instance_, nullptr);
}

} // namespace rt::vulkan
