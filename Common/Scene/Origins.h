// Which object of its description each primitive of a compiled scene comes from.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "Common/Scene/Compiler/Bounds.h"

namespace rt::scene {

struct CompiledScene;
struct ObjectDesc;

// Primitives from `first` on, up to where the next run begins.
struct OriginRun {
    std::uint32_t first;
    std::uint32_t object;
};

// Objects are those of the scene's own lists that are no groups, counted depth first (pathOfLeaf() leads back). What
// stands in a prototype counts as the instance.
struct Origins {
    std::vector<OriginRun> spheres, quads, triangles, rounds; // of the world, the geometry without instances
    std::vector<std::uint32_t> instances;                     // of each
};

// `runs` are not empty, as there is the primitive.
std::uint32_t originOf(std::span<const OriginRun> runs, std::uint32_t primitive);

// How many an object counts as: of a group, all that are in it. Hidden ones count.
std::uint32_t leafCount(const ObjectDesc& object);

// Objects that follow each other.
struct ObjectRange {
    std::uint32_t first = 0, count = 0;
};

// For each of the ranges, which are sorted and apart from each other: of all that comes from its objects, in the units
// and at the place of the description; empty where nothing does.
std::vector<Bounds> boundsOf(const CompiledScene& scene, std::span<const ObjectRange> ranges);

} // namespace rt::scene
