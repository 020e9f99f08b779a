#pragma once
#include <vector>

#include "Common/Shared/Base/Types.h"

namespace rt::scene {

// The table that directionalAlbedo() and sheenAlbedo() of PrincipledAlbedos.h read, kAlbedoSteps rows of as many
// entries: by quadrature, the first time that it is asked for.
const std::vector<shared::vec3>& directionalAlbedos();

// The table that stretchedAlbedo() reads, likewise.
const std::vector<shared::vec2>& stretchedAlbedos();

// What glassAlbedo() reads of one index of refraction, from outside and from inside. The last few are kept: a scene
// that is read again mostly has those of before.
std::vector<float> glassAlbedos(float ior);

} // namespace rt::scene
