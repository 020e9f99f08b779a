// A density on the unit square in proportion to the bilinear function between values at its corners: samples that are uniform in
// something are brought closer to a product with a smooth function, of which the corners are known.
#ifndef RT_SHARED_BILINEAR_H
#define RT_SHARED_BILINEAR_H
#include "PiecewiseFit.h"

RT_SHARED_BEGIN

struct Bilinear {
    float at00; // (0,0); none negative, not all 0
    float at10; // (1,0)
    float at01;
    float at11;
};

RT_FN float bilinearDensity(RT_IN(Bilinear) f, vec2 p) {
    float value = mix(mix(f.at00, f.at10, p.x), mix(f.at01, f.at11, p.x), p.y);
    return 4.0f * value / (f.at00 + f.at10 + f.at01 + f.at11);
}

// x from its own density, then y from that at x.
RT_FN vec2 sampleBilinear(RT_IN(Bilinear) f, vec2 u) {
    float x0 = f.at00 + f.at01;
    float x1 = f.at10 + f.at11;
    float x = invertLinear(x0, x1, u.x * 0.5f * (x0 + x1));
    float y0 = mix(f.at00, f.at10, x);
    float y1 = mix(f.at01, f.at11, x);
    return vec2(x, invertLinear(y0, y1, u.y * 0.5f * (y0 + y1)));
}

RT_SHARED_END

#endif
