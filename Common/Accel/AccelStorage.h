// The memory behind an AccelView.
#pragma once
#include "Common/Accel/AccelView.h"
#include "Common/Accel/LargeArray.h"

namespace rt::accel {

struct AccelStorage {
    LargeArray<WideNode> nodes;
    LargeArray<SparseNode> sparseNodes;
    LargeArray<SphereBlock> spheres;
    LargeArray<MovingSphereBlock> movingSpheres;
    LargeArray<QuadBlock> quads;
    LargeArray<TriangleBlock> triangles;
    LargeArray<PlacedGeometry> instances;
    LargeArray<SphereBlock> flatSpheres;
    LargeArray<MovingSphereBlock> flatMovingSpheres;
    LargeArray<QuadBlock> flatQuads;
    LargeArray<TriangleBlock> flatTriangles;
};

} // namespace rt::accel
