// The memory behind an AccelView.
#pragma once
#include "Common/Accel/AccelView.h"
#include "Common/Accel/LargeArray.h"

namespace rt::accel {

struct AccelStorage {
    LargeArray<WideNode> nodes;
    LargeArray<SphereBlock<kWidth>> spheres;
    LargeArray<MovingSphereBlock<kWidth>> movingSpheres;
    LargeArray<QuadBlock<kWidth>> quads;
    LargeArray<TriangleBlock<kWidth>> triangles;
    LargeArray<PlacedGeometry> instances;
    LargeArray<SphereBlock<kFlatWidth>> flatSpheres;
    LargeArray<MovingSphereBlock<kFlatWidth>> flatMovingSpheres;
    LargeArray<QuadBlock<kFlatWidth>> flatQuads;
    LargeArray<TriangleBlock<kFlatWidth>> flatTriangles;
};

}  // namespace rt::accel
