#include "Common/Accel/Build/SceneTrees.h"

#include <optional>
#include <utility>

#include "Common/Core/Parallel.h"
#include "Common/Core/SystemMemory.h"

namespace rt::accel {
namespace {

constexpr std::size_t kBoxChunk = 1u << 13; // items whose boxes are made at a time

bool isEmpty(const Box& box) {
    return !(box.lower.x <= box.upper.x);
}

// Of one geometry; `boxes`: of those that its instances place. Gives the box of the tree, empty where there is none;
// nothing: cancelled.
std::optional<Box> buildTree(const AccelInput& input, std::uint32_t geometry, std::vector<std::uint32_t> instances,
                             std::span<const Box> geometryBoxes, const BvhSettings& settings,
                             const std::atomic<bool>* cancel, std::atomic<std::uint64_t>* primitivesDone,
                             const std::function<void(SceneTree)>& add) {
    SceneTree tree{geometry, TreeItems(input, input.geometries[geometry], std::move(instances)), {}};
    if (tree.items.size() == 0) return Box{};
    std::vector<Box> boxes;
    resizeLarge(boxes, tree.items.size());
    parallelChunks(settings.threads, boxes.size(), kBoxChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            boxes[i] = tree.items.box(static_cast<std::uint32_t>(i), geometryBoxes);
        }
    });
    BvhSettings treeSettings = settings;
    treeSettings.singleGroup = static_cast<std::uint32_t>(LeafKind::Instance);
    const std::vector<std::uint8_t> kinds = tree.items.kinds();
    std::optional<Bvh> bvh = buildBvh({std::move(boxes), kinds}, treeSettings, cancel, primitivesDone);
    if (!bvh) return std::nullopt;
    const Box box = bvh->nodes[0].box;
    tree.bvh = std::move(*bvh);
    add(std::move(tree));
    return box;
}

} // namespace

std::optional<std::vector<Box>> buildPlacedTrees(const AccelInput& input, const BvhSettings& settings,
                                                 const std::atomic<bool>* cancel,
                                                 std::atomic<std::uint64_t>* primitivesDone,
                                                 const std::function<void(SceneTree)>& add) {
    const std::vector<bool> isPlaced = placedGeometries(input);
    std::vector<Box> boxes(input.geometries.size());
    for (std::uint32_t g = 1; g < input.geometries.size(); ++g) {
        if (!isPlaced[g]) continue;
        const std::optional<Box> box = buildTree(input, g, {}, boxes, settings, cancel, primitivesDone, add);
        if (!box) return std::nullopt;
        boxes[g] = *box;
    }
    return boxes;
}

bool buildWorldTree(const AccelInput& input, std::span<const Box> placed, const BvhSettings& settings,
                    const std::atomic<bool>* cancel, std::atomic<std::uint64_t>* primitivesDone,
                    const std::function<void(SceneTree)>& add) {
    std::vector<std::uint32_t> instances;
    for (std::uint32_t i = 0; i < input.instances.size(); ++i) {
        if (!isEmpty(placed[input.instances[i].geometry])) instances.push_back(i);
    }
    return buildTree(input, 0, std::move(instances), placed, settings, cancel, primitivesDone, add).has_value();
}

bool buildSceneTrees(const AccelInput& input, const BvhSettings& settings, const std::atomic<bool>* cancel,
                     std::atomic<std::uint64_t>* primitivesDone, const std::function<void(SceneTree)>& add) {
    const auto placed = buildPlacedTrees(input, settings, cancel, primitivesDone, add);
    return placed && buildWorldTree(input, *placed, settings, cancel, primitivesDone, add);
}

} // namespace rt::accel
