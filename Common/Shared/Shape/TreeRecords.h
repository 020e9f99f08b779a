// The layout of acceleration structures that shaders traverse on their own: a tree whose nodes hold the boxes of
// their children, two or four, with primitives in the order of its leaves, or, for the smallest scenes, lists without a
// tree.
#ifndef RT_SHARED_TREE_RECORDS_H
#define RT_SHARED_TREE_RECORDS_H
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

// ---- references ----------------------------------------------------------------------------------------------------

// What a child of a node is: another node (its index), or a run of primitives of one kind in their array.
//   bit 31: leaf    30..29: kind    28..26: primitives - 1    25..0: index of the first
// Two bits of kind are not enough for a leaf of kind 3: with a count of 1 it is an instance, named by its index in the
// scene, and disks and cylinders, one less than the count, otherwise.
const uint kInstanceLeaf = 3u; // beside kSphere, kQuad, kTriangle
const uint kMaxRoundsOfLeaf = 7u;
const uint kTreeLeaf = 0x80000000u;
const uint kTreeKindShift = 29u;
const uint kTreeCountShift = 26u;
const uint kTreeLeafSize = 8u;            // most primitives of a leaf
const uint kTreeItems = (1u << 26u) - 1u; // most primitives of a kind; the last index stays free for kTreeReturn
const uint kTreeNothing = 0xffffffffu;    // in place of a child
const uint kTreeReturn = 0xffffffffu;     // on a traversal's stack: the instance ends here
const uint kTreeEnd = 0xfffffffeu;        // at its bottom; no leaf, since instances are alone in theirs

RT_FN uint treeLeaf(uint kind, uint first, uint count) {
    return kTreeLeaf | kind << kTreeKindShift | (count - 1u) << kTreeCountShift | first;
}
RT_FN uint treeLeafKind(uint leaf) {
    return leaf >> kTreeKindShift & 3u;
}
RT_FN uint treeLeafFirst(uint leaf) {
    return leaf & kTreeItems;
}
RT_FN uint treeLeafCount(uint leaf) {
    return (leaf >> kTreeCountShift & (kTreeLeafSize - 1u)) + 1u;
}

RT_FN uint roundLeaf(uint first, uint count) {
    return treeLeaf(kRound, first, count + 1u);
}
// Of a leaf of kind 3.
RT_FN bool isRoundLeaf(uint leaf) {
    return treeLeafCount(leaf) > 1u;
}

// ---- records -------------------------------------------------------------------------------------------------------
// Vectors of four, so that each is one load. Indices among floats are their bits.

// Slabs: the middle of the first child and half of its extent, then of the second.
struct TreeNode {
    vec4 x;
    vec4 y;
    vec4 z;
    uvec4 children; // two references; the rest is unused
};

// Middles and half extents along each axis, a component for each child. Where there are fewer than four, the others'
// extents are negative, so that no ray enters them.
struct WideTreeNode {
    vec4 middleX;
    vec4 halfX;
    vec4 middleY;
    vec4 halfY;
    vec4 middleZ;
    vec4 halfZ;
    uvec4 children; // references; kTreeNothing where there are fewer than four
    uvec4 unused;   // so that a node is a line of most caches
};

// See QuadFrame.
struct TreeQuad {
    vec4 corner;
    vec4 normal; // w: index of the primitive
    vec4 dualU;  // w: margin of u
    vec4 dualV;  // w: margin of v
};

struct TreeTriangle {
    vec4 vertex0; // w: index of the primitive
    vec4 vertex1;
    vec4 vertex2;
};

// See RoundFrame.
struct TreeRound {
    vec4 origin; // w: Round::hole
    vec4 dualU;  // w: index of the primitive
    vec4 dualV;
    vec4 dualW;
};

// ---- lists ---------------------------------------------------------------------------------------------------------
// Vectors of one array: two a sphere (center, radius, that is negative for near spheres; motion, index of the
// primitive), two a quad whose edges run along axes (below), four a cuboid (below), then four of any other quad, three
// a triangle, four a disk or cylinder, as above.
//
// Quads along axes, those perpendicular to x first, then to y, to z: center and index of the primitive; half of what
// they extend (intersectAxisQuad()) along the two axes that follow the perpendicular one in cyclic order.
//
// Cuboids: center; three vectors whose products with what leads from the center to a face's middle are 1. The first
// two have faces, the index of a quad in each byte: those on the negative sides, in the order of the vectors, then
// those on the positive sides.

const uint kNoFace = 255u;
const uint kMaxListedPrimitives = 64u; // most that lists may hold
const uint kListVectors = 4u * kMaxListedPrimitives;

RT_SHARED_END

#endif
