#include "Common/Vulkan/Check.h"

namespace rt::vulkan {

std::string resultName(VkResult result) {
    switch (result) {
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            return "out of memory";
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            return "out of device memory";
        case VK_ERROR_INITIALIZATION_FAILED:
            return "initialization failed";
        case VK_ERROR_DEVICE_LOST:
            return "device lost";
        case VK_ERROR_MEMORY_MAP_FAILED:
            return "memory cannot be mapped";
        case VK_ERROR_LAYER_NOT_PRESENT:
            return "layer not installed";
        case VK_ERROR_EXTENSION_NOT_PRESENT:
            return "extension not supported";
        case VK_ERROR_FEATURE_NOT_PRESENT:
            return "feature not supported";
        case VK_ERROR_INCOMPATIBLE_DRIVER:
            return "no compatible driver";
        case VK_ERROR_TOO_MANY_OBJECTS:
            return "too many objects";
        default:
            return "Vulkan result " + std::to_string(static_cast<int>(result));
    }
}

void check(VkResult result, const std::string& what) {
    if (result >= VK_SUCCESS) return;
    if (result == VK_ERROR_DEVICE_LOST) {
        throw DeviceLostError(what + ": the device was lost; its driver was reset, or stopped work that took too long");
    }
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY) {
        throw RenderError(what + ": out of device memory; a smaller image or scene needs less");
    }
    throw RenderError(what + ": " + resultName(result));
}

} // namespace rt::vulkan
