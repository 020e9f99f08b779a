// Lights of pbrt files as those of a scene: docs/pbrt.md says what becomes of each.
#pragma once
#include <optional>
#include <string>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Pbrt/PbrtFiles.h"
#include "Common/Scene/Pbrt/PbrtMaterials.h"
#include "Common/Scene/Pbrt/PbrtNotices.h"
#include "Common/Scene/Pbrt/PbrtParameters.h"
#include "Common/Scene/Pbrt/PbrtShapes.h"
#include "Common/Scene/Pbrt/PbrtTextures.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

class PbrtLights {
  public:
    // All must outlive this.
    PbrtLights(SceneDesc& scene, PbrtFiles& files, PbrtTextures& textures, PbrtNotices& notices)
        : scene_(scene), files_(files), textures_(textures), notices_(notices) {}

    // A LightSource directive. Throws InputError.
    void add(const std::string& kind, const PbrtParameters& parameters, const Affine& toWorld);
    // What an AreaLightSource makes of a shape's surface.
    void addEmission(const PbrtParameters& parameters, const PbrtShape& shape, const Affine& toWorld,
                     PbrtSurface& surface);

  private:
    glm::dvec3 color(const PbrtParameters& parameters, const char* name); // times "scale"
    void point(const PbrtParameters& parameters, const Affine& toWorld);
    void spot(const PbrtParameters& parameters, const Affine& toWorld);
    void projection(const PbrtParameters& parameters, const Affine& toWorld);
    void distant(const PbrtParameters& parameters, const Affine& toWorld);
    void infinite(const PbrtParameters& parameters, const Affine& toWorld);
    void addImage(const PbrtParameters& parameters, const std::string& file, const Affine& toWorld);
    void addSpot(const PbrtParameters& parameters, SpotLightDesc light);

    SceneDesc& scene_;
    PbrtFiles& files_;
    PbrtTextures& textures_;
    PbrtNotices& notices_;
};

} // namespace rt::scene
