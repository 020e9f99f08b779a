// The part of a sphere that is above the horizon of a surface, nearly by projected solid angle. Seen along the
// surface's normal the cap of directions to the sphere is an ellipse (all of it above the horizon), an ellipse and a
// lune between it and the unit circle (its middle above), or a lune alone (its middle below). Urena & Georgiev,
// "Stratified Sampling of Projected Spherical Caps", 2018, cut them into slices parallel to the symmetry axis; so do
// we, at y = sine * sin(psi), with widths that need no difference of nearly equal numbers.
//
// Slices are drawn as if they were those of an ellipse, and places uniformly within them. An unoccluded diffuse
// receiver then sees no variance of a whole cap, little of one that is cut (a fifth of the square of the mean where
// least of it is left), at the price of uniform solid angle. ProjectedCap.h draws slices by their widths.
#ifndef RT_SHARED_VISIBLE_CAP_H
#define RT_SHARED_VISIBLE_CAP_H
#include "Common/Shared/Shape/SphericalShapes.h"

RT_SHARED_BEGIN

// Square of the sine of the cone below which the cosine hardly varies within it, and directions from its axis lose
// digits.
const float kMinCapSine2 = 1.0e-3f;

// The cosine of an angle of this sine, up to rounding beyond 1.
RT_FN float cosineOf(float sine) {
    return sqrt(max((1.0f - sine) * (1.0f + sine), 0.0f));
}

// A cap of directions as seen along the normal of a surface.
struct CapView {
    vec3 forward; // unit, across the normal, towards the axis
    vec3 side;    // unit, across both
    float rise;   // cosine between normal and axis
    float lean;   // sine
    float cut;    // |y| up to which slices end at the horizon; 2: all do
    float end;    // |y| of the last slice; 0: all is below the horizon
};

// `normal` unit.
RT_FN CapView viewCap(RT_IN(SphereCone) cone, vec3 normal) {
    CapView view;
    Frame f = makeFrame(normal);
    vec2 axis = vec2(dot(cone.axis, f.tangent), dot(cone.axis, f.bitangent));
    view.rise = dot(normal, cone.axis);
    view.lean = sqrt(dot(axis, axis));
    // Straight overhead any direction serves.
    float scale = 1.0f / max(view.lean, 1.0e-12f);
    float x = view.lean > 1.0e-12f ? axis.x * scale : 1.0f;
    float y = axis.y * scale;
    view.forward = f.tangent * x + f.bitangent * y;
    view.side = f.bitangent * x - f.tangent * y;
    float across2 = max((cone.sine - view.rise) * (cone.sine + view.rise), 0.0f);
    float edge = sqrt(across2) * scale; // |y| where the cap meets the horizon
    view.cut = view.rise > 0.0f ? edge : 2.0f;
    view.end = view.rise > 0.0f ? cone.sine : edge;
    return view;
}

// A slice: x, along the axis as seen along the normal, from right - width to right; at its right end the height above
// the tangent plane is `height`.
struct CapSlice {
    float width;
    float right;
    float height;
};

// Whether a slice is one of the ellipse, above the horizon from end to end.
RT_FN bool isEllipse(RT_IN(CapView) view, float y) {
    return y >= view.cut;
}

// At y = sine * sinPsi >= 0.
RT_FN CapSlice capSlice(RT_IN(SphereCone) cone, RT_IN(CapView) view, float sinPsi, float cosPsi) {
    float s = cone.sine;
    float c = cone.cosine;
    float y = s * sinPsi;
    float circle = cosineOf(y);
    float top = max(c * view.rise + s * view.lean * cosPsi, 0.0f);
    float beyond = circle + (c * view.lean - s * view.rise * cosPsi);
    float cutWidth = top * top / max(beyond, 1.0e-37f);
    float right = c * view.lean + s * view.rise * cosPsi;
    float height = max(c * view.rise - s * view.lean * cosPsi, 0.0f);
    bool whole = isEllipse(view, y);
    CapSlice slice;
    slice.width = whole ? 2.0f * s * view.rise * cosPsi : cutWidth;
    slice.right = whole ? right : circle;
    slice.height = whole ? height : 0.0f;
    return slice;
}

// Height above the tangent plane at the distance `inward` from the right end of a slice.
RT_FN float sliceHeight(RT_IN(CapSlice) slice, float inward) {
    return sqrt(slice.height * slice.height + inward * (2.0f * slice.right - inward));
}

// Density on the unit disk of the tangent plane of places that are uniform in the ellipse of a whole cap.
RT_FN float wholeCapDensity(RT_IN(SphereCone) cone, float rise) {
    return kInvPi / (cone.sine * cone.sine * rise);
}

// Density on the unit disk of the tangent plane, given the slice at y; `ellipse` is sqrt(1 - (y / end)^2). 0: nothing
// is visible.
RT_FN float visibleCapDensity(RT_IN(SphereCone) cone, RT_IN(CapView) view, RT_IN(CapSlice) slice, float y,
                              float ellipse) {
    bool whole = isEllipse(view, y);
    float drawn = whole ? kInvPi : 2.0f * kInvPi * ellipse;
    float area = whole ? cone.sine * cone.sine * view.rise : view.end * slice.width;
    return area > 0.0f ? drawn / area : 0.0f;
}

// Density on the unit disk of the tangent plane of wi, a direction to the sphere. Without a branch, for loops over
// lanes.
RT_FN float capDensityAlong(RT_IN(SphereCone) cone, vec3 normal, vec3 wi) {
    CapView view = viewCap(cone, normal);
    float y = min(abs(dot(view.side, wi)), view.end);
    float sinPsi = min(y / cone.sine, 1.0f);
    CapSlice slice = capSlice(cone, view, sinPsi, cosineOf(sinPsi));
    return visibleCapDensity(cone, view, slice, y, cosineOf(y / max(view.end, 1.0e-37f)));
}

// Per steradian.
RT_FN float visibleCapPdf(RT_IN(SphereCone) cone, vec3 normal, vec3 wi) {
    float cosine = max(dot(normal, wi), 0.0f);
    float rise = dot(normal, cone.axis);
    if (rise >= cone.sine) return cosine * wholeCapDensity(cone, rise);
    return cosine * capDensityAlong(cone, normal, wi);
}

// A direction with its density per steradian, 0 if nothing is visible. Without a branch, for loops over lights.
struct VisibleCapSample {
    ConeSample place;
    float pdf;
};

RT_FN VisibleCapSample sampleVisibleCap(RT_IN(SphereCone) cone, float radius, vec3 normal, vec2 u) {
    CapView view = viewCap(cone, normal);
    vec2 e = sampleDisk(u);
    float y = min(abs(e.y), 1.0f) * view.end;
    float ellipse = cosineOf(min(abs(e.y), 1.0f));
    float sinPsi = min(y / cone.sine, 1.0f);
    CapSlice slice = capSlice(cone, view, sinPsi, cosineOf(sinPsi));
    float inward = slice.width * clamp(0.5f - 0.5f * e.x / max(ellipse, 1.0e-6f), 0.0f, 1.0f);
    float height = sliceHeight(slice, inward);
    vec3 direction = view.forward * (slice.right - inward) + view.side * (e.y < 0.0f ? -y : y) + normal * height;
    VisibleCapSample result;
    float cosine = dot(direction, cone.axis);
    vec3 across = direction - cone.axis * cosine;
    result.place = meetSphere(cone, radius, direction, cosine, across, min(dot(across, across), cone.sine * cone.sine));
    result.pdf = height * visibleCapDensity(cone, view, slice, y, ellipse);
    return result;
}

RT_SHARED_END

#endif
