// Objects of a device, made and owned in one step.
#pragma once
#include <span>
#include <string>

#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/Handle.h"

namespace rt::vulkan {

// As create(device, vkCreateFence, info, vkDestroyFence, "Creating a fence"). Throws as check() does.
template <class T, class Info>
Handle<T> create(VkDevice device, VkResult(VKAPI_PTR* make)(VkDevice, const Info*, const VkAllocationCallbacks*, T*),
                 const Info& info, typename Handle<T>::Destroy destroy, const std::string& what) {
    T object = VK_NULL_HANDLE;
    check(make(device, &info, nullptr, &object), what);
    return {device, object, destroy};
}

// For drawing to all of these images, of one size.
Handle<VkFramebuffer> createFramebuffer(VkDevice device, VkRenderPass renderPass, std::span<const VkImageView> views,
                                        VkExtent2D extent, const char* what);

Handle<VkImageView> createView(VkDevice device, VkImage image, VkFormat format, VkImageAspectFlags aspect,
                               const char* what);

} // namespace rt::vulkan
