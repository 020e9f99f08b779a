// The acceleration structures of a scene: a bottom level per geometry for triangles and quads and one for spheres, each only
// where there are such primitives, and a top level of all instances.
#pragma once
#include <cstdint>
#include <vector>

#include "Common/Scene/CompiledScene.h"
#include "Common/Vulkan/VulkanResources.h"
#include "Shaders/Records.h"

namespace rt::gpu {

class AccelStructure {
  public:
    // Reads positions and triangles from the scene's buffers on the device. Throws RenderError.
    AccelStructure(vulkan::VulkanContext& context, const scene::CompiledScene& scene,
                   const shared::SceneArrays& arrays);

    VkAccelerationStructureKHR topLevel() const { return topLevel_.structure.get(); }
    double buildSeconds() const { return buildSeconds_; } // on the device, compaction included

  private:
    struct Structure {
        vulkan::Buffer storage;
        vulkan::Handle<VkAccelerationStructureKHR> structure; // lies in storage
        VkDeviceAddress address = 0;
    };
    // A bottom level and where its hit groups begin in the shader binding table.
    struct BottomLevel {
        Structure structure;
        std::uint32_t geometry = 0; // of the scene
        std::uint32_t hitRecord = 0;
    };
    // Geometries of one structure, with the number of primitives in each.
    struct BuildInput {
        std::vector<VkAccelerationStructureGeometryKHR> geometries;
        std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
        VkAccelerationStructureTypeKHR type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
    };

    Structure allocate(VkAccelerationStructureTypeKHR type, VkDeviceSize bytes);
    Structure build(const BuildInput& input);
    Structure compact(Structure original);
    void addSurfaces(const scene::CompiledScene& scene, const shared::SceneArrays& arrays, std::uint32_t geometry);
    void addSpheres(const scene::CompiledScene& scene, std::uint32_t geometry);
    void buildTopLevel(const scene::CompiledScene& scene);

    vulkan::VulkanContext& context_;
    std::vector<BottomLevel> bottomLevels_;
    Structure topLevel_;
    double buildSeconds_ = 0;
};

} // namespace rt::gpu
