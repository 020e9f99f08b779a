// Densities that are fitted piece by piece to masses known at some places. A sampler draws from the fit, which is inverted
// exactly, and states the density of the fit, not of what it is fitted to. So no equation is solved by iteration and no
// sample is off: what the fit misses appears as weights near 1.
#ifndef RT_SHARED_PIECEWISE_FIT_H
#define RT_SHARED_PIECEWISE_FIT_H
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

// Where in an interval, [0,1], the integral of the linear function from a at 0 to b at 1 reaches `part`.
RT_FN float invertLinear(float a, float b, float part) {
    float root = sqrt(max(a * a + 2.0f * (b - a) * part, 0.0f));
    return min(2.0f * part / max(a + root, 1.0e-37f), 1.0f);
}

// What is linear between two places: the mass, or its root.
const uint kFitLinear = 0u;
const uint kFitSquare = 1u;

// A piece of a fit, a function f that is linear from a to b, or its square.
struct FitPiece {
    float a;
    float b;
    float start;
    float width;
    uint form;
};

RT_FN float fitMass(RT_IN(FitPiece) s) {
    return s.width * (s.form == kFitSquare ? (s.a * s.a + s.a * s.b + s.b * s.b) * (1.0f / 3.0f) : 0.5f * (s.a + s.b));
}

RT_FN float fitValue(RT_IN(FitPiece) s, float place) {
    float f = mix(s.a, s.b, place);
    return s.form == kFitSquare ? f * f : f;
}

// Where in the piece, [0,1], `share` of its mass lies before.
RT_FN float fitPlace(RT_IN(FitPiece) s, float share) {
    if (s.form != kFitSquare) return invertLinear(s.a, s.b, share * 0.5f * (s.a + s.b));
    // The integral is (f^3 - a^3) / (3 (b - a)): three of Newton's steps from the root of a quadratic that is close.
    float a2 = s.a * s.a;
    float b2 = s.b * s.b;
    float part = share * (a2 + s.a * s.b + b2) * (1.0f / 3.0f);
    float place = invertLinear(a2, b2, share * 0.5f * (a2 + b2));
    float rise = s.b - s.a;
    for (int i = 0; i < 3; i++) {
        float below = place * (a2 + place * rise * (s.a + place * rise * (1.0f / 3.0f)));
        float f = s.a + place * rise;
        place = clamp(place - (below - part) / max(f * f, 1.0e-37f), 0.0f, 1.0f);
    }
    return place;
}

// The value of the fit's function where a slice has this mass.
RT_FN float fitFunction(uint form, float mass) {
    return form == kFitSquare ? sqrt(mass) : mass;
}

// What a fit of `fit` to slices of mass `mass`, over `width`, adds to the variance, in units of the square of the whole.
RT_FN float misfit(float fit, float mass, float width) {
    return width * (fit - mass) * ((fit - mass) / max(fit, 1.0e-30f));
}

RT_SHARED_END

#endif
