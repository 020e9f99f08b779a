// A density on the unit square in proportion to the bilinear function between values at its corners: samples that are
// uniform in something are brought closer to a product with a smooth function, of which the values at the corners
// (0,0), (1,0), (0,1) and (1,1) are known: none negative, not all 0.
#ifndef RT_SHARED_BILINEAR_H
#define RT_SHARED_BILINEAR_H
#include "Common/Shared/Base/Sampling.h"

RT_SHARED_BEGIN

RT_FN float bilinearDensity(vec4 corners, vec2 p) {
    float value = mix(mix(corners.x, corners.y, p.x), mix(corners.z, corners.w, p.x), p.y);
    return 4.0f * value / (corners.x + corners.y + corners.z + corners.w);
}

// x from its own density, then y from that at x.
RT_FN vec2 sampleBilinear(vec4 corners, vec2 u) {
    float x0 = corners.x + corners.z;
    float x1 = corners.y + corners.w;
    float x = invertLinear(x0, x1, u.x * 0.5f * (x0 + x1));
    float y0 = mix(corners.x, corners.y, x);
    float y1 = mix(corners.z, corners.w, x);
    return vec2(x, invertLinear(y0, y1, u.y * 0.5f * (y0 + y1)));
}

RT_SHARED_END

#endif
