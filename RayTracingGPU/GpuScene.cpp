#include "RayTracingGPU/GpuScene.h"

#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include "Common/Accel/SameGeometry.h"
#include "Common/Render/Stopwatch.h"
#include "Common/Vulkan/Barrier.h"
#include "RayTracingGPU/EngineChoice.h"

namespace rt::gpu {

namespace {

// The first bytes of another buffer, then the data.
vulkan::Buffer extended(vulkan::VulkanContext& context, const vulkan::Buffer& first, VkDeviceSize bytes,
                        std::span<const std::byte> data, const char* name) {
    vulkan::Buffer buffer(context.memory(), bytes + data.size(), 0, vulkan::Memory::Device, name);
    context.run([&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, bytes};
        vkCmdCopyBuffer(commands, first.get(), buffer.get(), 1, &region);
        vulkan::barrier(commands, vulkan::kTransferWrite, vulkan::kTransferWrite | context.bufferUses());
    });
    vulkan::upload(context, buffer, data, bytes);
    return buffer;
}

} // namespace

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
        const bool keeps = before != nullptr && accel::canKeep(before->placed_, accel::inputOf(*before->compiled_),
                                                               accel::inputOf(*compiled_));
        buildTree(context, cancel, keeps ? before : nullptr);
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
    treeRest_ = from.treeRest_;
    tree_ = from.tree_;
    linearLists_ = from.linearLists_;
    shape_ = from.shape_;
    placed_ = from.placed_;
}

void GpuScene::buildTree(vulkan::VulkanContext& context, const std::atomic<bool>* cancel, const GpuScene* before) {
    const app::Stopwatch watch;
    const accel::AccelInput input = accel::inputOf(*compiled_);
    std::optional<accel::GpuBvh> bvh =
        accel::buildGpuBvh(input, {}, cancel, before != nullptr ? &before->placed_ : nullptr);
    if (!bvh) return;
    buildSeconds_ = watch.seconds();
    shape_ = traversalShape(*bvh);
    const accel::GpuTrees& t = bvh->trees;
    // Behind the `kept` first elements of the scene before.
    const auto add = [&](const auto& records, std::size_t kept, const char* name) -> std::uint64_t {
        using Record = typename std::decay_t<decltype(records)>::value_type;
        const std::size_t place = treeBuffers_.size();
        SharedBuffer& buffer = treeBuffers_.emplace_back();
        const VkDeviceSize keptBytes = before != nullptr ? kept * sizeof(Record) : 0;
        if (keptBytes == 0) {
            if (records.empty()) return 0;
            buffer = std::make_shared<const vulkan::Buffer>(vulkan::deviceArray<Record>(context, records, name));
        } else if (const SharedBuffer& old = before->treeBuffers_[place];
                   records.empty() && old->bytes() == keptBytes) {
            buffer = old;
        } else {
            buffer = std::make_shared<const vulkan::Buffer>(
                extended(context, *old, keptBytes, std::as_bytes(std::span(records)), name));
        }
        return buffer->address();
    };
    const accel::TreeCounts& kept = t.placed.counts;
    tree_.nodes = add(t.nodes, t.placed.isWide ? 0 : kept.nodes, "the tree");
    tree_.wideNodes = add(t.wideNodes, t.placed.isWide ? kept.nodes : 0, "the tree");
    tree_.spheres = add(t.spheres, kept.spheres, "the tree's spheres");
    tree_.sphereMotions = add(t.sphereMotions, input.motions.empty() ? 0 : kept.spheres, "the tree's motion");
    tree_.sphereIndices = add(t.sphereIndices, kept.spheres, "the tree's spheres");
    tree_.quads = add(t.quads, kept.quads, "the tree's quads");
    tree_.triangles = add(t.triangles, kept.triangles, "the tree's triangles");
    tree_.rounds = add(t.rounds, kept.rounds, "the tree's disks and cylinders");
    tree_.instanceRoots = add(t.instanceRoots, 0, "the tree's instances");
    tree_.root = t.root;
    placed_ = std::move(bvh->trees.placed);

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
    const std::vector<shared::vec4> none(rest.size(), shared::vec4(0.0f));
    treeRest_ =
        std::make_shared<const vulkan::Buffer>(vulkan::deviceArray<shared::vec4>(context, none, "the tree's motion"));
    tree_.sphereMotions = treeRest_->address();
}

} // namespace rt::gpu
