// The picture of a probe: a density over all directions, and directions that were drawn.
#pragma once
#include <optional>
#include <span>

#include "Common/Image/Image.h"
#include "Common/Probe/Probe.h"

namespace rt::probe {

// Linear values in [0, 1]: at the left all directions in cells of one solid angle (the map's own layout), at the right
// the hemisphere above the surface as Lambert's azimuthal projection, of equal areas as well, seen from above with the
// normal in the middle. Brightness is the root of the density by the greatest one; the first 512 of the drawn
// directions are dots.
image::Image pictureOf(const Probe& probe, const Strategy& strategy, const DirectionMap& map,
                       std::span<const std::optional<shared::vec3>> drawn);

// The map itself, per steradian, a channel.
image::Image imageOf(const DirectionMap& map);

} // namespace rt::probe
