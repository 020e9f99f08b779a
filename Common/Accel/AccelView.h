// What traversal reads: nodes of eight children, and leaf blocks that hold primitives of one kind in arrays of lanes,
// ready for one SIMD register a component. Plain data; CpuAccel owns the memory.
#pragma once
#include <cstdint>

#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/Types.h"

namespace rt::accel {

inline constexpr std::uint32_t kWidth = 8; // children of a node and lanes of a leaf block

// Bounds of the depth of a tree, and so of the stack of a traversal.
inline constexpr std::uint32_t kMaxTreeDepth = 64;

// ---- references ----------------------------------------------------------------------------------------------------

// What a child of a node is: another node (its index), or a run of leaf blocks of one kind.
//   bit 31: leaf    30..28: kind    27..25: blocks - 1    24..0: index of the first block
using Reference = std::uint32_t;

enum class LeafKind : std::uint32_t { Sphere, NearSphere, MovingSphere, Quad, Triangle, Round, Instance };
inline constexpr std::uint32_t kLeafKinds = 7;

inline constexpr Reference kLeafBit = 1u << 31;
inline constexpr std::uint32_t kKindShift = 28;
inline constexpr std::uint32_t kCountShift = 25;
inline constexpr std::uint32_t kMaxLeafBlocks = 8;
inline constexpr std::uint32_t kMaxBlocks = 1u << kCountShift; // of one kind

// ---- records -------------------------------------------------------------------------------------------------------

// Slabs of the children: planes[2 a] are the lower bounds along axis a, planes[2 a + 1] the upper ones. The slab of a
// child that does not exist is inverted, so no ray enters it.
struct alignas(64) WideNode {
    float planes[6][kWidth];
    Reference child[kWidth];
};

// A node in half the memory of a WideNode, for trees in which rays visit many nodes for each leaf that they enter, and
// which hold no instances. Slabs like a WideNode's, in steps of QuantizationGrid from its origin, rounded outwards. In
// place of a child that does not exist there is some leaf of the tree.
struct alignas(64) QuantizedNode {
    std::uint16_t planes[6][kWidth];
    Reference child[kWidth];
};

struct QuantizationGrid {
    shared::vec3 origin{0.0f};
    float stepsPerUnit = 1.0f; // a power of two
};

// Lanes without a primitive hold NaN, which no ray hits. Lanes are in order of primitive index.
struct alignas(32) SphereBlock {
    float center[3][kWidth];
    float radius[kWidth];
    std::uint32_t primitive[kWidth]; // index into the scene's array, kNone for an empty lane
};

// Near spheres of Shapes.h, whose power shared::Sphere knows; few of any scene. In a list, lanes that they leave may
// have other spheres, of infinite power.
struct alignas(32) NearSphereBlock {
    float center[3][kWidth];
    float radius[kWidth];
    float power[kWidth];
    std::uint32_t primitive[kWidth];
};

struct alignas(32) MovingSphereBlock {
    float center[3][kWidth]; // at time 0
    float motion[3][kWidth];
    float radius[kWidth];
    std::uint32_t primitive[kWidth];
};

// See shared::QuadFrame.
struct alignas(32) QuadBlock {
    float corner[3][kWidth];
    float normal[3][kWidth];
    float dualU[3][kWidth];
    float dualV[3][kWidth];
    float margin[2][kWidth];
    std::uint32_t primitive[kWidth];
};

struct alignas(32) TriangleBlock {
    float vertex[3][3][kWidth]; // vertex, axis
    std::uint32_t primitive[kWidth];
};

// See shared::RoundFrame.
struct alignas(32) RoundBlock {
    float origin[3][kWidth];
    float dualU[3][kWidth];
    float dualV[3][kWidth];
    float dualW[3][kWidth];
    float hole[kWidth];
    std::uint32_t primitive[kWidth];
};

struct PlacedGeometry {
    shared::vec4 toObject[3]; // rows, as in shared::Instance
    Reference root;
    std::uint32_t instance;
};

// All primitives of one kind in a scene that is too small to gain from a tree. Their lanes hold packPrimitive() in
// place of the index of the primitive.
template <class Block>
struct LinearList {
    const Block* blocks = nullptr;
    std::uint32_t count = 0; // of blocks; the last may have empty lanes
};

inline constexpr std::uint32_t kPackedKindShift = 30;

constexpr std::uint32_t packPrimitive(std::uint32_t kind, std::uint32_t primitive) {
    return kind << kPackedKindShift | primitive;
}

// ---- the whole -----------------------------------------------------------------------------------------------------

struct AccelView {
    shared::Features kinds; // feature bits of the primitives that exist
    bool isLinear = false;  // the lists below hold everything; otherwise the tree does
    bool isLarge = false;   // does not fit into a core's own cache: worth fetching ahead

    LinearList<SphereBlock> listedSpheres;
    LinearList<NearSphereBlock> listedNearSpheres;
    LinearList<MovingSphereBlock> listedMovingSpheres;
    LinearList<QuadBlock> listedQuads;
    LinearList<TriangleBlock> listedTriangles;
    LinearList<RoundBlock> listedRounds;

    Reference root = 0; // of the world: its own primitives and the instances
    const WideNode* nodes = nullptr;
    const QuantizedNode* quantizedNodes = nullptr; // if not null, those of the world, the root first
    QuantizationGrid quantizationGrid;
    const SphereBlock* spheres = nullptr;
    const NearSphereBlock* nearSpheres = nullptr;
    const MovingSphereBlock* movingSpheres = nullptr;
    const QuadBlock* quads = nullptr;
    const TriangleBlock* triangles = nullptr;
    const RoundBlock* rounds = nullptr;
    const PlacedGeometry* instances = nullptr;
};

} // namespace rt::accel
