// The render pass that windows are drawn in.
#pragma once
#include <vulkan/vulkan.h>

#include "Common/Vulkan/Handle.h"

namespace rt::gui {

// One attachment, stored at the end. All that differ in no more than these parameters, `format` apart, are compatible:
// what is recorded for one may be drawn in the other. Throws RenderError.
vulkan::Handle<VkRenderPass> makeWindowRenderPass(VkDevice device, VkFormat format, VkAttachmentLoadOp loadOp,
                                                  VkImageLayout finalLayout);

} // namespace rt::gui
