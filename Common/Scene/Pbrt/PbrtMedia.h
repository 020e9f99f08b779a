// Media of pbrt files.
#pragma once
#include <map>
#include <string>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Pbrt/PbrtFiles.h"
#include "Common/Scene/Pbrt/PbrtNotices.h"
#include "Common/Scene/Pbrt/PbrtParameters.h"
#include "Common/Scene/Pbrt/PbrtShapes.h"

namespace rt::scene {

class PbrtMedia {
  public:
    // Both must outlive this.
    PbrtMedia(PbrtFiles& files, PbrtNotices& notices) : files_(files), notices_(notices) {}

    void define(const std::string& name, PbrtParameters parameters);
    // Makes of a shape without a surface what is inside: of a sphere a homogeneous medium, else nothing, with a notice
    // where there is a medium. An empty name: none.
    void fill(const std::string& name, PbrtShape& shape, const Affine& toWorld, const PbrtPlace& place);

  private:
    glm::dvec3 coefficient(const PbrtParameters& parameters, const char* name, const glm::dvec3& usual);

    PbrtFiles& files_;
    PbrtNotices& notices_;
    std::map<std::string, PbrtParameters> known_;
};

} // namespace rt::scene
