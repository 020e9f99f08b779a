// Where blurred mirrors show lights in an image.
#pragma once
#include "Common/Scene/ImagePlane.h"
#include "Common/Scene/Silhouettes.h"

namespace rt::scene {

// Adds the pixels in which a quad of metal with little fuzz shows a light as a small and bright spot, too small to be
// the same for all of a pixel's samples. What is in between is not looked at. None of many lights or quads. The lens is
// taken for a point; `edges` has the image's parts.
void addLightsInMirrors(const CompiledScene& scene, const ImagePlane& plane, Silhouettes& edges);

} // namespace rt::scene
