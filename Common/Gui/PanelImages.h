// All the images among the controls.
#pragma once
#include <cstdint>

#include <vulkan/vulkan.h>

#include "Common/Gui/PanelImage.h"
#include "Common/Gui/Thumbnails.h"

namespace rt::gui {

struct PanelImages {
    static constexpr std::uint32_t kSceneSide = 64, kMaterialSide = 96; // pixels, as cmake/Thumbnails.cmake has it

    PanelImages(GraphicsDevice& device, VkRenderPass renderPass)
        : scenes(device, renderPass, "thumbnails", kSceneSide),
          materials(device, renderPass, "materials/thumbnails", kMaterialSide),
          probe(device, renderPass) {}

    void beginFrame() {
        scenes.beginFrame();
        materials.beginFrame();
        probe.beginFrame();
    }
    bool takeChange() {
        const bool areScenesNew = scenes.takeChange(), areMaterialsNew = materials.takeChange();
        return probe.takeChange() || areScenesNew || areMaterialsNew;
    }
    void upload(VkCommandBuffer commands, std::uint32_t frame) {
        scenes.upload(commands, frame);
        materials.upload(commands, frame);
        probe.upload(commands, frame);
    }
    void setCommands(VkCommandBuffer commands) {
        scenes.setCommands(commands);
        materials.setCommands(commands);
        probe.setCommands(commands);
    }

    Thumbnails scenes, materials;
    PanelImage probe;
};

} // namespace rt::gui
