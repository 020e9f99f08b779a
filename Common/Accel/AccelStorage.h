// The memory behind an AccelView.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "Common/Accel/AccelView.h"

namespace rt::accel {

// A fixed number of records that start uninitialised.
template <class T>
struct Array {
    std::unique_ptr<T[]> data;
    std::size_t size = 0;

    void allocate(std::size_t count) {
        if (count != 0) data = std::make_unique_for_overwrite<T[]>(count);
        size = count;
    }
    std::size_t bytes() const { return size * sizeof(T); }
};

struct AccelStorage {
    std::vector<WideNode> nodes;
    Array<SphereBlock<kWidth>> spheres;
    Array<MovingSphereBlock<kWidth>> movingSpheres;
    Array<QuadBlock<kWidth>> quads;
    Array<TriangleBlock<kWidth>> triangles;
    Array<PlacedGeometry> instances;
    Array<SphereBlock<kFlatWidth>> flatSpheres;
    Array<MovingSphereBlock<kFlatWidth>> flatMovingSpheres;
    Array<QuadBlock<kFlatWidth>> flatQuads;
    Array<TriangleBlock<kFlatWidth>> flatTriangles;
};

}  // namespace rt::accel
