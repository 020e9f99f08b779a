// What a ray hits, as kernels trace it.
#pragma once
#include <cstdint>

#include "Common/Probe/SceneFormulas.h"
#include "Common/Shared/Base/Random.h"

namespace rt::probe {

// In (0, end), behind layers that it goes through; `number` as for goesThrough(). The distance is from where the ray
// begins.
shared::Hit nextHit(const SceneFormulas& scene, shared::Features features, const shared::Ray& ray,
                    const shared::Sampler& sampler, std::uint32_t number, float end);

} // namespace rt::probe
