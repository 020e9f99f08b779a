// Densities that are fitted piece by piece to masses known at some places. A sampler draws from the fit, which is inverted
// exactly, and states the density of the fit, not of what it is fitted to. So no equation is solved by iteration and no
// sample is off: what the fit misses appears as weights near 1.
#ifndef RT_SHARED_PIECEWISE_FIT_H
#define RT_SHARED_PIECEWISE_FIT_H
#include "Types.h"

RT_SHARED_BEGIN

// Where in an interval, [0,1], the integral of the linear function from a at 0 to b at 1 reaches `part`.
RT_FN float invertLinear(float a, float b, float part) {
    float root = sqrt(max(a * a + 2.0f * (b - a) * part, 0.0f));
    return min(2.0f * part / max(a + root, 1.0e-37f), 1.0f);
}

// What is linear between two places: the mass, its root, or its inverse root.
const uint kFitLinear = 0u;
const uint kFitSquare = 1u;
const uint kFitInverse = 2u;

// A piece of a fit, a function f that is linear from a to b, or its square or inverse square.
struct FitPiece {
    float a;
    float b;
    float start;
    float width;
    uint form;
};

RT_FN float fitMass(RT_IN(FitPiece) s) {
    if (s.form == kFitInverse) return s.width / max(s.a * s.b, 1.0e-37f);
    return s.width * (s.form == kFitSquare ? (s.a * s.a + s.a * s.b + s.b * s.b) * (1.0f / 3.0f) : 0.5f * (s.a + s.b));
}

RT_FN float fitValue(RT_IN(FitPiece) s, float place) {
    float f = mix(s.a, s.b, place);
    if (s.form == kFitInverse) return 1.0f / max(f * f, 1.0e-37f);
    return s.form == kFitSquare ? f * f : f;
}

// Where in the piece, [0,1], its integral from the beginning reaches `part`.
RT_FN float fitPlace(RT_IN(FitPiece) s, float part) {
    float share = part / max(s.width, 1.0e-37f);
    if (s.form == kFitInverse) {
        // The integral is place / (a f(place)).
        float rise = share * s.a;
        return clamp(rise * s.a / max(1.0f - rise * (s.b - s.a), 1.0e-37f), 0.0f, 1.0f);
    }
    if (s.form != kFitSquare) return invertLinear(s.a, s.b, share);
    // The integral is (f^3 - a^3) / (3 (b - a)): three of Newton's steps from the root of a quadratic that is close.
    float a2 = s.a * s.a;
    float b2 = s.b * s.b;
    float place = invertLinear(a2, b2, share * 1.5f * (a2 + b2) / max(a2 + s.a * s.b + b2, 1.0e-37f));
    float rise = s.b - s.a;
    for (int i = 0; i < 3; i++) {
        float below = place * (a2 + place * rise * (s.a + place * rise * (1.0f / 3.0f)));
        float f = s.a + place * rise;
        place = clamp(place - (below - share) / max(f * f, 1.0e-37f), 0.0f, 1.0f);
    }
    return place;
}

// The value of the fit's function where a slice has this mass.
RT_FN float fitFunction(uint form, float mass) {
    float root = sqrt(mass);
    return form == kFitSquare ? root : form == kFitInverse ? 1.0f / max(root, 1.0e-15f) : mass;
}

// What a fit of `fit` to slices of mass `mass`, over `width`, adds to the variance, in units of the square of the whole.
RT_FN float misfit(float fit, float mass, float width) {
    return width * (fit - mass) * ((fit - mass) / max(fit, 1.0e-30f));
}

RT_SHARED_END

#endif
