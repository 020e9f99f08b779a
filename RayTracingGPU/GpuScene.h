// The compiled scene on the device.
#pragma once
#include <atomic>
#include <memory>

#include "Common/Accel/GpuBvh.h"
#include "Common/Render/Names.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Vulkan/StagingRing.h"
#include "RayTracingGPU/AccelStructure.h"
#include "RayTracingGPU/SpecializationConstants.h"
#include "Shaders/Records.h"

namespace rt::gpu {

// The arrays that exist, and what rays are traced through: an acceleration structure of the device, or the tree or the
// lists of the compute engine. Immutable.
class GpuScene {
  public:
    // Uploads and builds what is not the same in `before`, a scene of the same engine or null. Useless when *cancel
    // became true. Throws RenderError.
    GpuScene(vulkan::VulkanContext& context, app::GpuEngineKind engine,
             std::shared_ptr<const scene::CompiledScene> compiled, const std::atomic<bool>* cancel,
             const GpuScene* before = nullptr);

    // A superset of the scene's features may look for motion where there is none: sets it to zero.
    void provideMotion(vulkan::VulkanContext& context);

    const scene::CompiledScene& compiled() const { return *compiled_; }
    const shared::SceneArrays& arrays() const { return arrays_; }
    const shared::TreeArrays& tree() const { return tree_; }
    double buildSeconds() const { return buildSeconds_; }

    // Of engines that usesAccelStructure().
    VkAccelerationStructureKHR topLevel() const { return accel_->topLevel(); }
    // Of the compute engine.
    const vulkan::Buffer& linearLists() const { return *linearLists_; }
    const TraversalShape& shape() const { return shape_; }

  private:
    using SharedBuffer = std::shared_ptr<const vulkan::Buffer>; // with other versions of the scene
    void uploadArrays(vulkan::VulkanContext& context, VkBufferUsageFlags usage, const GpuScene* before);
    // `before`: a scene whose trees but for the world's are this one's, or null.
    void buildTree(vulkan::VulkanContext& context, const std::atomic<bool>* cancel, const GpuScene* before);
    void takeTree(const GpuScene& from);

    std::shared_ptr<const scene::CompiledScene> compiled_;
    std::vector<SharedBuffer> arrayBuffers_; // of each array; null where that is empty
    std::vector<SharedBuffer> treeBuffers_;  // likewise of the tree's
    accel::PlacedTrees placed_;
    vulkan::Buffer rest_;   // of spheres: motion that is none
    SharedBuffer treeRest_; // likewise of the tree's
    shared::SceneArrays arrays_{};
    shared::TreeArrays tree_{};
    std::unique_ptr<AccelStructure> accel_;
    SharedBuffer linearLists_;
    TraversalShape shape_;
    double buildSeconds_ = 0;
};

} // namespace rt::gpu
