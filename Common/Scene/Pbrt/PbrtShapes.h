// Shapes of pbrt files as objects of a scene.
#pragma once
#include <string>
#include <vector>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Pbrt/PbrtBudget.h"
#include "Common/Scene/Pbrt/PbrtFiles.h"
#include "Common/Scene/Pbrt/PbrtNotices.h"
#include "Common/Scene/Pbrt/PbrtParameters.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

struct PbrtShape {
    std::vector<ObjectDesc> objects; // without materials; their fronts are where pbrt has the normal
    bool isInsideOut = false;        // but of these, of which ours have no such side
    std::size_t lights = 1;          // that pbrt makes of it where it emits: each triangle of a mesh is one
};

class PbrtShapes {
  public:
    // All must outlive this.
    PbrtShapes(PbrtFiles& files, PbrtBudget& budget, PbrtNotices& notices)
        : files_(files), budget_(budget), notices_(notices) {}

    // In the shape's own space; `isReversed`: by ReverseOrientation. Throws InputError.
    PbrtShape make(const std::string& kind, const PbrtParameters& parameters, bool isReversed);

  private:
    PbrtShape sphere(const PbrtParameters& parameters);
    PbrtShape disk(const PbrtParameters& parameters, bool isReversed);
    PbrtShape cylinder(const PbrtParameters& parameters);
    template <class Real>
    MeshOf<Real> triangles(const PbrtParameters& parameters);
    PbrtShape patches(const PbrtParameters& parameters, bool isReversed);
    MeshData subdivided(const PbrtParameters& parameters);
    PbrtShape ofFile(const PbrtParameters& parameters, bool isReversed);
    template <class Real>
    PbrtShape meshShape(MeshOf<Real> mesh, bool isReversed);

    PbrtFiles& files_;
    PbrtBudget& budget_;
    PbrtNotices& notices_;
};

// Of the shape's surface in the world.
double pbrtArea(const PbrtShape& shape, const Affine& toWorld);

} // namespace rt::scene
