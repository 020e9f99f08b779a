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

} // namespace

bool buildSceneTrees(const AccelInput& input, const BvhSettings& settings, const std::atomic<bool>* cancel,
                     std::atomic<std::uint64_t>* primitivesDone, const std::function<void(SceneTree)>& add) {
    BvhSettings treeSettings = settings;
    treeSettings.singleGroup = static_cast<std::uint32_t>(LeafKind::Instance);
    std::vector<Box> geometryBoxes(input.geometries.size()); // empty for one that is not used or has nothing in it
    const auto buildTree = [&](std::uint32_t geometry, std::vector<std::uint32_t> instances) {
        SceneTree tree{geometry, TreeItems(input, input.geometries[geometry], std::move(instances)), {}};
        if (tree.items.size() == 0) return true;
        std::vector<Box> boxes;
        resizeLarge(boxes, tree.items.size());
        parallelChunks(settings.threads, boxes.size(), kBoxChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                boxes[i] = tree.items.box(static_cast<std::uint32_t>(i), geometryBoxes);
            }
        });
        const std::vector<std::uint8_t> kinds = tree.items.kinds();
        std::optional<Bvh> bvh = buildBvh({std::move(boxes), kinds}, treeSettings, cancel, primitivesDone);
        if (!bvh) return false;
        geometryBoxes[geometry] = bvh->nodes[0].box;
        tree.bvh = std::move(*bvh);
        add(std::move(tree));
        return true;
    };

    std::vector<bool> used(input.geometries.size(), false);
    for (const shared::Instance& instance : input.instances) {
        used[instance.geometry] = true;
    }
    for (std::uint32_t g = 1; g < input.geometries.size(); ++g) {
        if (used[g] && !buildTree(g, {})) return false;
    }
    std::vector<std::uint32_t> placed;
    for (std::uint32_t i = 0; i < input.instances.size(); ++i) {
        if (!isEmpty(geometryBoxes[input.instances[i].geometry])) placed.push_back(i);
    }
    return buildTree(0, std::move(placed));
}

} // namespace rt::accel
