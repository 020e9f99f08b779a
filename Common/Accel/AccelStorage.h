// The memory behind an AccelView.
#pragma once
#include "Common/Accel/AccelView.h"
#include "Common/Accel/LargeArray.h"

namespace rt::accel {

struct AccelStorage {
    LargeArray<WideNode> nodes;
    LargeArray<QuantizedNode> quantizedNodes;
    LargeArray<SphereBlock> spheres;
    LargeArray<NearSphereBlock> nearSpheres;
    LargeArray<MovingSphereBlock> movingSpheres;
    LargeArray<QuadBlock> quads;
    LargeArray<TriangleBlock> triangles;
    LargeArray<RoundBlock> rounds;
    LargeArray<PlacedGeometry> instances;
    LargeArray<SphereBlock> listedSpheres;
    LargeArray<NearSphereBlock> listedNearSpheres;
    LargeArray<MovingSphereBlock> listedMovingSpheres;
    LargeArray<QuadBlock> listedQuads;
    LargeArray<TriangleBlock> listedTriangles;
    LargeArray<RoundBlock> listedRounds;
};

} // namespace rt::accel
