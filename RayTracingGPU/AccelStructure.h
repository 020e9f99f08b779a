// The acceleration structures of a scene: a bottom level per geometry for triangles and quads and one for spheres, each
// only where there are such primitives, and a top level of all instances.
#pragma once
#include <cstdint>
#include <vector>

#include "Common/Scene/CompiledScene.h"
#include "RayTracingGPU/AccelBuilder.h"
#include "Shaders/Records.h"

namespace rt::gpu {

class AccelStructure {
  public:
    // Reads positions and triangles from the scene's buffers on the device. Throws RenderError.
    AccelStructure(vulkan::VulkanContext& context, const scene::CompiledScene& scene,
                   const shared::SceneArrays& arrays);

    VkAccelerationStructureKHR topLevel() const { return topLevel_.structures.front().structure.get(); }
    double buildSeconds() const { return buildSeconds_; } // on the device, compaction included

  private:
    // A bottom level and where its hit groups begin in the shader binding table.
    struct BottomLevel {
        std::uint32_t geometry = 0; // of the scene
        std::uint32_t hitRecord = 0;
        VkDeviceAddress address = 0;
    };

    void buildBottomLevels(AccelBuilder& builder, const scene::CompiledScene& scene, const shared::SceneArrays& arrays);
    std::vector<VkAccelerationStructureInstanceKHR> listInstances(const scene::CompiledScene& scene) const;
    void buildTopLevel(AccelBuilder& builder, const scene::CompiledScene& scene);

    vulkan::VulkanContext& context_;
    std::vector<BottomLevel> bottomLevels_; // geometry by geometry
    std::vector<AccelStorage> bottomStorage_;
    AccelStorage topLevel_;
    double buildSeconds_ = 0;
};

} // namespace rt::gpu
