// The camera and film of pbrt files.
#pragma once
#include <string>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Pbrt/PbrtNotices.h"
#include "Common/Scene/Pbrt/PbrtParameters.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// What a file says of its view.
struct PbrtView {
    std::string kind = "perspective"; // of camera
    PbrtParameters camera, film;
    Affine fromWorld; // to the camera's space: x to the right, y up, z forwards, which is left-handed
    double aspect = 1;

    // A film's size; throws InputError.
    void setFilm(PbrtParameters parameters, PbrtNotices& notices);
    // Whether the world must be mirrored for a right-handed camera to show what pbrt draws.
    bool mirrors() const { return !fromWorld.mirrors(); }
};

// Sets the scene's camera and aspect, of a world that `toScene` maps.
void setPbrtCamera(const PbrtView& view, const Affine& toScene, SceneDesc& scene, PbrtNotices& notices);

} // namespace rt::scene
