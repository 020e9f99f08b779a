#include "RayTracingGPU/GpuScene.h"

#include <optional>
#include <utility>

#include "Common/Render/Stopwatch.h"
#include "RayTracingGPU/EngineChoice.h"

namespace rt::gpu {

template <class T>
std::uint64_t GpuScene::add(vulkan::VulkanContext& context, const std::vector<T>& data, const char* name,
                            VkBufferUsageFlags usage) {
    if (data.empty()) return 0;
    buffers_.push_back(vulkan::deviceArray<T>(context, data, name, usage));
    return buffers_.back().address();
}

GpuScene::GpuScene(vulkan::VulkanContext& context, app::GpuEngineKind engine,
                   std::shared_ptr<const scene::CompiledScene> compiled, const std::atomic<bool>* cancel)
    : compiled_(std::move(compiled)) {
    const scene::CompiledScene& s = *compiled_;
    const bool hasStructure = usesAccelStructure(engine);
    const VkBufferUsageFlags usage = // vertices and triangles are built from
        hasStructure ? VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR : 0;
    shared::forEachArray([&](const char* name, const auto& records,
                             std::uint64_t& address) { address = add(context, records, name, usage); },
                         s, arrays_);
    if (!hasStructure) {
        buildTree(context, cancel);
        return;
    }
    accel_ = std::make_unique<AccelStructure>(context, s, arrays_);
    buildSeconds_ = accel_->buildSeconds();
}

void GpuScene::buildTree(vulkan::VulkanContext& context, const std::atomic<bool>* cancel) {
    const app::Stopwatch watch;
    const scene::CompiledScene& s = *compiled_;
    const accel::AccelInput input{s.spheres,   s.sphereMotions, s.quads,     s.positions,
                                  s.triangles, s.geometries,    s.instances, s.rounds};
    const std::optional<accel::GpuBvh> bvh = accel::buildGpuBvh(input, {}, cancel);
    if (!bvh) return;
    buildSeconds_ = watch.seconds();
    shape_ = traversalShape(*bvh);
    const accel::GpuTrees& t = bvh->trees;
    tree_.nodes = add(context, t.nodes, "the tree");
    tree_.wideNodes = add(context, t.wideNodes, "the tree");
    tree_.spheres = add(context, t.spheres, "the tree's spheres");
    tree_.sphereMotions = add(context, t.sphereMotions, "the tree's motion");
    tree_.sphereIndices = add(context, t.sphereIndices, "the tree's spheres");
    tree_.quads = add(context, t.quads, "the tree's quads");
    tree_.triangles = add(context, t.triangles, "the tree's triangles");
    tree_.rounds = add(context, t.rounds, "the tree's disks and cylinders");
    tree_.instanceRoots = add(context, t.instanceRoots, "the tree's instances");
    tree_.root = t.root;

    std::vector<shared::vec4> lists = bvh->lists.vectors;
    lists.resize(shared::kListVectors);
    linearLists_ = vulkan::deviceArray<shared::vec4>(context, lists, "primitives", VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
}

void GpuScene::provideMotion(vulkan::VulkanContext& context) {
    if (arrays_.sphereMotions != 0) return;
    const std::vector<shared::vec3> rest(compiled_->spheres.size(), shared::vec3(0.0f));
    arrays_.sphereMotions = add(context, rest, "motion");
    if (tree_.spheres == 0) return;
    tree_.sphereMotions = add(context, std::vector<shared::vec4>(rest.size(), shared::vec4(0.0f)), "the tree's motion");
}

} // namespace rt::gpu
