// The interface as an image: what ImGui has drawn, once more, to where it can be read.
#pragma once
#include <functional>

#include <vulkan/vulkan.h>

#include "Common/Gui/GraphicsDevice.h"
#include "Common/Gui/Layout.h"
#include "Common/Image/Image.h"

namespace rt::gui {

// `part` of a target of `extent` pixels, in pixels, as linear display intensities. `draw` records into a render pass
// that is compatible with the presenter's for that format, of 8 bits a channel. Waits for the device. Throws
// RenderError.
image::Image takeSnapshot(GraphicsDevice& device, VkFormat format, VkExtent2D extent, const Rect& part,
                          const std::function<void(VkCommandBuffer)>& draw);

} // namespace rt::gui
