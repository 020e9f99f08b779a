// A part of the window as an image file.
#pragma once
#include <functional>

#include <vulkan/vulkan.h>

#include "Common/Gui/GraphicsDevice.h"
#include "Common/Gui/Gui.h"

namespace rt::gui {

// Writes what gui.partToSave asks for, as a file of its part of the window, and asks no longer. `draw` records into a
// render pass that is compatible with the presenter's for `format`, of 8 bits a channel. Waits for the device; what
// fails is told in the window, unless the device is lost.
void savePart(Gui& gui, GraphicsDevice& device, VkFormat format, const std::function<void(VkCommandBuffer)>& draw);

} // namespace rt::gui
