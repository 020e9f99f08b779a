// Transforms of pbrt files.
#pragma once
#include "Common/Scene/Affine.h"
#include "Common/Scene/Pbrt/PbrtParser.h"

namespace rt::scene {

// Of Translate, Scale, Rotate, LookAt, Transform and ConcatTransform, without its perspective. Throws InputError.
Affine pbrtMap(const PbrtDirective& directive);
bool hasPerspective(const PbrtDirective& directive);

} // namespace rt::scene
