#include "RayTracingGPU/GpuScene.h"

#include <cstring>
#include <optional>
#include <type_traits>
#include <utility>

#include "Common/Accel/SameGeometry.h"
#include "Common/Render/Stopwatch.h"
#include "RayTracingGPU/EngineChoice.h"

namespace rt::gpu {

template <class T>
std::uint64_t GpuScene::addToTree(vulkan::VulkanContext& context, const std::vector<T>& data, const char* name) {
    if (data.empty()) return 0;
    treeBuffers_.push_back(std::make_shared<const vulkan::Buffer>(vulkan::deviceArray<T>(context, data, name)));
    return treeBuffers_.back()->address();
}

GpuScene::GpuScene(vulkan::VulkanContext& context, app::GpuEngineKind engine,
                   std::shared_ptr<const scene::CompiledScene> compiled, const std::atomic<bool>* cancel,
                   const GpuScene* before)
    : compiled_(std::move(compiled)) {
    const bool hasStructure = usesAccelStructure(engine);
    const VkBufferUsageFlags usage = // vertices and triangles are built from
        hasStructure ? VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR : 0;
    uploadArrays(context, usage, before);
    if (hasStructure) {
        std::optional<AccelStructure::Before> levels;
        if (before != nullptr) levels.emplace(AccelStructure::Before{*before->compiled_, *before->accel_});
        accel_ = std::make_unique<AccelStructure>(context, *compiled_, arrays_, levels);
        buildSeconds_ = accel_->buildSeconds();
    } else if (before != nullptr && accel::sameInput(accel::inputOf(*before->compiled_), accel::inputOf(*compiled_))) {
        takeTree(*before);
    } else {
        buildTree(context, cancel);
    }
}

void GpuScene::uploadArrays(vulkan::VulkanContext& context, VkBufferUsageFlags usage, const GpuScene* before) {
    const scene::CompiledScene& old = before != nullptr ? *before->compiled_ : *compiled_;
    const auto upload = [&](const char* name, const auto& records, const auto& oldRecords, std::uint64_t& address) {
        using Record = typename std::decay_t<decltype(records)>::value_type;
        const std::size_t bytes = records.size() * sizeof(Record);
        const std::size_t place = arrayBuffers_.size();
        SharedBuffer& buffer = arrayBuffers_.emplace_back();
        if (records.empty()) return;
        const bool isSame = before != nullptr && records.size() == oldRecords.size() &&
                            std::memcmp(records.data(), oldRecords.data(), bytes) == 0;
        if (isSame) {
            buffer = before->arrayBuffers_[place];
        } else {
            buffer = std::make_shared<const vulkan::Buffer>(vulkan::deviceArray<Record>(context, records, name, usage));
        }
        address = buffer->address();
    };
    shared::forEachArray(upload, *compiled_, old, arrays_);
}

void GpuScene::takeTree(const GpuScene& from) {
    treeBuffers_ = from.treeBuffers_;
    tree_ = from.tree_;
    linearLists_ = from.linearLists_;
    shape_ = from.shape_;
}

void GpuScene::buildTree(vulkan::VulkanContext& context, const std::atomic<bool>* cancel) {
    const app::Stopwatch watch;
    const accel::AccelInput input = accel::inputOf(*compiled_);
    const std::optional<accel::GpuBvh> bvh = accel::buildGpuBvh(input, {}, cancel);
    if (!bvh) return;
    buildSeconds_ = watch.seconds();
    shape_ = traversalShape(*bvh);
    const accel::GpuTrees& t = bvh->trees;
    tree_.nodes = addToTree(context, t.nodes, "the tree");
    tree_.wideNodes = addToTree(context, t.wideNodes, "the tree");
    tree_.spheres = addToTree(context, t.spheres, "the tree's spheres");
    tree_.sphereMotions = addToTree(context, t.sphereMotions, "the tree's motion");
    tree_.sphereIndices = addToTree(context, t.sphereIndices, "the tree's spheres");
    tree_.quads = addToTree(context, t.quads, "the tree's quads");
    tree_.triangles = addToTree(context, t.triangles, "the tree's triangles");
    tree_.rounds = addToTree(context, t.rounds, "the tree's disks and cylinders");
    tree_.instanceRoots = addToTree(context, t.instanceRoots, "the tree's instances");
    tree_.root = t.root;

    std::vector<shared::vec4> lists = bvh->lists.vectors;
    lists.resize(shared::kListVectors);
    linearLists_ = std::make_shared<const vulkan::Buffer>(
        vulkan::deviceArray<shared::vec4>(context, lists, "primitives", VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT));
}

void GpuScene::provideMotion(vulkan::VulkanContext& context) {
    if (arrays_.sphereMotions != 0) return;
    const std::vector<shared::vec3> rest(compiled_->spheres.size(), shared::vec3(0.0f));
    rest_ = vulkan::deviceArray<shared::vec3>(context, rest, "motion");
    arrays_.sphereMotions = rest_.address();
    if (tree_.spheres == 0 || tree_.sphereMotions != 0) return;
    tree_.sphereMotions =
        addToTree(context, std::vector<shared::vec4>(rest.size(), shared::vec4(0.0f)), "the tree's motion");
}

} // namespace rt::gpu
