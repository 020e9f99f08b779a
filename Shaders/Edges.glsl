// Where camera rays are split at edges of lights.
#include "Common/Shared/Technique/EdgeRays.h"

// Whether there may be edge rays at all.
bool hasEdges() {
    return uses(kFeatures, renderParams(), kMethodEdgeRays);
}

uint placeOfPixel(uvec2 pixel) {
    return pixel.y * constants.params.width + pixel.x;
}

// Of this pixel, as scene::Silhouettes::parts, where there are edge rays.
uint packedPart(uvec2 pixel) {
    return constants.edgeParts.at[placeOfPixel(pixel)];
}

// How many edge rays a sample of this pixel has.
uint edgeRays(uvec2 pixel) {
    if (!hasEdges() || constants.params.edgeRays == 0u) return 0u;
    uint index = placeOfPixel(pixel);
    return (constants.edges.at[index / 32u] >> index % 32u & 1u) != 0u ? constants.params.edgeRays : 0u;
}
