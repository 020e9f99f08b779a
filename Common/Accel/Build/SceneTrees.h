// The binary trees of a compiled scene, whatever layout they end up in: one for each geometry that instances place, and
// the world's over its own primitives and the instances.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "Common/Accel/Build/BvhBuilder.h"
#include "Common/Accel/Build/TreeItems.h"
#include "Common/Accel/Bvh.h"

namespace rt::accel {

struct SceneTree {
    std::uint32_t geometry; // of the scene; 0 is the world
    TreeItems items;
    Bvh bvh; // over the items; not empty. Every instance is alone in its leaf
};

// Hands over tree after tree, the world's last; there is none of a geometry with nothing in it. False: cancelled.
// *primitivesDone, if given, rises by the number of primitives and instances. The trees refer to `input`.
bool buildSceneTrees(const AccelInput& input, const BvhSettings& settings, const std::atomic<bool>* cancel,
                     std::atomic<std::uint64_t>* primitivesDone, const std::function<void(SceneTree)>& add);

// In two parts: first all but the world's. Gives the box of each geometry, empty for one that no instance places or
// that has nothing in it; nothing: cancelled.
std::optional<std::vector<Box>> buildPlacedTrees(const AccelInput& input, const BvhSettings& settings,
                                                 const std::atomic<bool>* cancel,
                                                 std::atomic<std::uint64_t>* primitivesDone,
                                                 const std::function<void(SceneTree)>& add);
// Then the world's, by those boxes.
bool buildWorldTree(const AccelInput& input, std::span<const Box> placed, const BvhSettings& settings,
                    const std::atomic<bool>* cancel, std::atomic<std::uint64_t>* primitivesDone,
                    const std::function<void(SceneTree)>& add);

} // namespace rt::accel
