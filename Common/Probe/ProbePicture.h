// The picture of a probe: maps over directions, and directions that were drawn.
#pragma once
#include "Common/Image/Image.h"
#include "Common/Probe/ProbeRun.h"

namespace rt::probe {

// Linear values in [0, 1], one channel three times: the root of a map's values by the greatest one, times `scale`, at
// most white. `width` and `height` of the picture; what is outside of the hemisphere is dark.
image::Image paint(const DirectionMap& map, float scale, std::uint32_t width, std::uint32_t height);

// All maps of the result side by side; the drawn directions that it shows are dots, and edges of strata lines.
image::Image pictureOf(const ProbeResult& result);

// The map itself, a channel.
image::Image imageOf(const DirectionMap& map);

} // namespace rt::probe
