// The acceleration structures of a scene: a bottom level per geometry for triangles and quads and one for spheres, each
// only where there are such primitives, and a top level of all instances.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "Common/Scene/CompiledScene.h"
#include "RayTracingGPU/AccelBuilder.h"
#include "Shaders/Records.h"

namespace rt::gpu {

class AccelStructure {
  public:
    // Of another version of the scene, from which levels are taken over that would be the same.
    struct Before {
        const scene::CompiledScene& scene;
        const AccelStructure& structure;
    };
    // Reads positions and triangles from the scene's buffers on the device. Throws RenderError.
    AccelStructure(vulkan::VulkanContext& context, const scene::CompiledScene& scene, const shared::SceneArrays& arrays,
                   const std::optional<Before>& before);

    VkAccelerationStructureKHR topLevel() const { return topLevel_->structures.front().structure.get(); }
    double buildSeconds() const { return buildSeconds_; } // on the device, compaction included

  private:
    // A bottom level and where its hit groups begin in the shader binding table.
    struct BottomLevel {
        std::uint32_t geometry = 0; // of the scene
        std::uint32_t hitRecord = 0;
        VkDeviceAddress address = 0;
        std::shared_ptr<const AccelStorage> storage; // that it is in, with others
    };
    // Which there are, those taken over with their storage.
    void listBottomLevels(const scene::CompiledScene& scene, const std::optional<Before>& before);
    void buildBottomLevels(AccelBuilder& builder, const scene::CompiledScene& scene, const shared::SceneArrays& arrays);
    std::vector<VkAccelerationStructureInstanceKHR> listInstances(const scene::CompiledScene& scene) const;
    void buildTopLevel(AccelBuilder& builder, const scene::CompiledScene& scene);
    bool hasLevelsOf(const AccelStructure& other) const;

    vulkan::VulkanContext& context_;
    std::vector<BottomLevel> bottomLevels_; // geometry by geometry
    std::shared_ptr<const AccelStorage> topLevel_;
    double buildSeconds_ = 0;
};

} // namespace rt::gpu
