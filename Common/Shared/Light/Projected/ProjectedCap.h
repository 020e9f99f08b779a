// Spheres by projected solid angle, whatever the horizon cuts off: the slices of VisibleCap.h, drawn by a fit to their
// widths, and whole caps in a form for small ones too.
#ifndef RT_SHARED_PROJECTED_CAP_H
#define RT_SHARED_PROJECTED_CAP_H
#include "Common/Shared/Light/Projected/VisibleCap.h"

RT_SHARED_BEGIN

const uint kCapIntervals = 10u; // of psi, from 0 to the end

const uint kCapWhole = 0u;  // no part below the horizon
const uint kCapHigh = 1u;   // cut, its middle above the horizon
const uint kCapLow = 2u;    // cut, its middle at or below the horizon
const uint kCapHidden = 3u; // wholly below

struct ProjectedCap {
    SphereCone cone;
    CapView view;
    uint kind;
    vec3 up;                        // unit, across cone.axis towards the normal
    float end;                      // psi of the last slice
    float total;                    // integral of the fit over psi, half of the projected solid angle
    float mass[kCapIntervals + 1u]; // of slices, per psi
};

// `normal` is the receiver's, unit.
RT_FN ProjectedCap makeProjectedCap(RT_IN(SphereCone) cone, vec3 normal) {
    ProjectedCap cap;
    cap.cone = cone;
    cap.view = viewCap(cone, normal);
    cap.up = cross(cone.axis, cap.view.side);
    float s = cone.sine;
    float rise = cap.view.rise;
    cap.kind = rise >= s ? kCapWhole : rise > 0.0f ? kCapHigh : rise > -s ? kCapLow : kCapHidden;
    cap.end = 0.5f * kPi;
    cap.total = 0.0f;
    if (cap.kind == kCapWhole || cap.kind == kCapHidden) return cap;
    if (cap.kind == kCapLow) cap.end = arcTan(sqrt((s - rise) * (s + rise)), -rise * cone.cosine);
    float stepSize = cap.end / float(kCapIntervals);
    for (uint i = 0u; i <= kCapIntervals; i++) {
        vec2 sc = sinCos2Pi(float(i) * stepSize * (0.5f * kInvPi));
        float cosPsi = max(sc.y, 0.0f);
        cap.mass[i] = capSlice(cone, cap.view, sc.x, cosPsi).width * s * cosPsi;
        if (i > 0u) cap.total += 0.5f * stepSize * (cap.mass[i - 1u] + cap.mass[i]);
    }
    return cap;
}

// Density on the tangent plane's unit disk at psi, given the slice there; 0 where nothing is visible.
RT_FN float capDensity(RT_IN(ProjectedCap) cap, float psi, RT_IN(CapSlice) slice, float cosPsi) {
    float at = clamp(psi / cap.end, 0.0f, 1.0f) * float(kCapIntervals);
    uint i = min(uint(at), kCapIntervals - 1u);
    float fit = mix(cap.mass[i], cap.mass[i + 1u], at - float(i));
    float own = slice.width * cap.cone.sine * cosPsi;
    return own > 0.0f ? fit / (2.0f * cap.total * own) : 0.0f;
}

// A point on the sphere, seen along cone.axis * cosine + across, |across|^2 = sine2.
RT_FN ConeSample placeOnSphere(RT_IN(SphereCone) cone, float radius, vec3 across, float sine2) {
    float cosine = sqrt(max(1.0f - sine2, 0.0f));
    return meetSphere(cone, radius, normalize(across + cone.axis * cosine), cosine, across, sine2);
}

// A direction with its density on the unit disk of the tangent plane: density per steradian is that times the cosine.
struct ProjectedDirection {
    ConeSample place;
    float density; // 0: nothing is visible
};

RT_FN ProjectedDirection sampleProjectedCap(RT_IN(ProjectedCap) cap, float radius, vec2 u) {
    ProjectedDirection result;
    result.density = 0.0f;
    if (cap.kind == kCapHidden) {
        result.place = placeOnSphere(cap.cone, radius, vec3(0.0f), 0.0f);
        return result;
    }
    float s = cap.cone.sine;
    float c = cap.cone.cosine;
    float y = 0.0f;
    float lift = 0.0f; // of the direction along `up`
    if (cap.kind == kCapWhole) {
        // Uniform in the ellipse. Height above that of its middle, c * rise, without cancellation for small caps.
        vec2 e = sampleDisk(u);
        float cosPsi = cosineOf(e.y);
        float a = cap.view.rise;
        float low = max(c * a - s * cap.view.lean * cosPsi, 0.0f);
        float x = c * cap.view.lean + s * a * e.x;
        float z = sqrt(low * low + s * a * max(cosPsi - e.x, 0.0f) * (c * cap.view.lean + s * a * cosPsi + x));
        float above =
            s * (-2.0f * c * a * cap.view.lean * e.x + s * (cosPsi * cosPsi - a * a * e.x * e.x)) / (z + c * a);
        y = s * e.y;
        lift = cap.view.lean * above - s * a * a * e.x;
        result.density = wholeCapDensity(cap.cone, a);
    } else {
        float t = abs(2.0f * u.y - 1.0f);
        float rest = t * cap.total;
        float stepSize = cap.end / float(kCapIntervals);
        uint i = 0u;
        float part = 0.5f * stepSize * (cap.mass[0] + cap.mass[1]);
        while (i + 1u < kCapIntervals && rest > part) {
            rest -= part;
            i++;
            part = 0.5f * stepSize * (cap.mass[i] + cap.mass[i + 1u]);
        }
        float psi = (float(i) + invertLinear(cap.mass[i], cap.mass[i + 1u], rest / stepSize)) * stepSize;
        vec2 sc = sinCos2Pi(min(psi, cap.end) * (0.5f * kInvPi));
        float cosPsi = max(sc.y, 0.0f);
        CapSlice slice = capSlice(cap.cone, cap.view, sc.x, cosPsi);
        float inward = (1.0f - u.x) * slice.width;
        float x = slice.right - inward;
        float z = sliceHeight(slice, inward);
        y = s * sc.x * signOf(u.y - 0.5f);
        lift = cap.view.lean * z - cap.view.rise * x;
        result.density = capDensity(cap, psi, slice, cosPsi);
    }
    // Rounding must not lead out of the cone.
    float sine2 = lift * lift + y * y;
    float shrink = sine2 > s * s ? s / sqrt(sine2) : 1.0f;
    result.place =
        placeOnSphere(cap.cone, radius, cap.up * (lift * shrink) + cap.view.side * (y * shrink), min(sine2, s * s));
    return result;
}

// Density on the unit disk at a direction that meets the sphere.
RT_FN float projectedCapDensity(RT_IN(ProjectedCap) cap, vec3 wi) {
    if (cap.kind == kCapWhole) return wholeCapDensity(cap.cone, cap.view.rise);
    if (cap.kind == kCapHidden) return 0.0f;
    float sinPsi = min(abs(dot(cap.view.side, wi)) / cap.cone.sine, 1.0f);
    float cosPsi = cosineOf(sinPsi);
    return capDensity(cap, arcTan(sinPsi, cosPsi), capSlice(cap.cone, cap.view, sinPsi, cosPsi), cosPsi);
}

RT_SHARED_END

#endif
