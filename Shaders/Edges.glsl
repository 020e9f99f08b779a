// Where camera rays are split at edges of lights.
#include "Common/Shared/Path/EdgeRays.h"

// How many edge rays a sample of this pixel has.
uint edgeRays(uvec2 pixel) {
    if (kHasEdges == 0u || constants.params.edgeRays == 0u) return 0u;
    uint index = pixel.y * constants.params.width + pixel.x;
    return (constants.edges.at[index / 32u] >> index % 32u & 1u) != 0u ? constants.params.edgeRays : 0u;
}
