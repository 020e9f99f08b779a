// Solid angles of light shapes and samplers of directions towards them. A sampler and its density are computed from one
// record, the shape as seen from one point, so that both take every decision from the same numbers. Nothing here
// contains an absolute length: scaling everything by 2^k changes no bit of a direction.
#ifndef RT_SHARED_SPHERICAL_SHAPES_H
#define RT_SHARED_SPHERICAL_SHAPES_H
#include "Common/Shared/Base/Sampling.h"

RT_SHARED_BEGIN

// ---- sphere --------------------------------------------------------------------------------------------------------

// Radius over distance of the centre, beyond which a point counts as on the sphere, or within.
const float kNearestToSphere = 0.999f;

// A sphere seen from outside.
struct SphereCone {
    vec3 axis;            // unit, towards the centre
    float distance;       // to the centre
    float sine;           // of the half angle: radius / distance
    float cosine;         // of the half angle
    float oneMinusCosine; // of the half angle; solid angle / (2 pi)
};

// `toCenter` is longer than `radius`. 1 - cos = sin^2 / (1 + cos) holds for every size: no switch to a series.
RT_FN SphereCone makeSphereCone(vec3 toCenter, float radius) {
    SphereCone s;
    s.distance = length(toCenter);
    float inverse = 1.0f / s.distance;
    s.axis = toCenter * inverse;
    s.sine = radius * inverse;
    s.cosine = sqrt((s.distance - radius) * (s.distance + radius)) * inverse;
    s.oneMinusCosine = s.sine * s.sine / (1.0f + s.cosine);
    return s;
}

RT_FN float sphereConePdf(RT_IN(SphereCone) s) {
    return 1.0f / (2.0f * kPi * s.oneMinusCosine);
}

// A direction uniform in the cone, its distance to the sphere and the outward normal there.
struct ConeSample {
    vec3 direction;
    float distance;
    vec3 normal;
};

// What a direction of the cone meets: `cosine` is that to the axis, `across` the part across it, of the squared length
// sine2 or a little more.
RT_FN ConeSample meetSphere(RT_IN(SphereCone) s, float radius, vec3 direction, float cosine, vec3 across, float sine2) {
    ConeSample result;
    result.direction = direction;
    float w = sqrt(max(0.0f, 1.0f - sine2 / (s.sine * s.sine))); // half chord / radius, 0 at the rim
    result.distance = (s.distance - radius) * (s.distance + radius) / (s.distance * cosine + radius * w);
    result.normal = across * (result.distance / radius) - s.axis * (sine2 / s.sine + cosine * w);
    return result;
}

RT_FN ConeSample sampleSphereCone(RT_IN(SphereCone) s, float radius, vec2 u) {
    float q = u.x * s.oneMinusCosine; // 1 - cos of the angle to the axis
    float cosine = 1.0f - q;
    float sine2 = q * (2.0f - q);
    float sine = sqrt(sine2);
    vec2 sc = sinCos2Pi(u.y);
    Frame f = makeFrame(s.axis);
    vec3 around = f.tangent * sc.y + f.bitangent * sc.x;
    ConeSample result;
    result.direction = around * sine + s.axis * cosine;
    // Half chord / radius, 0 at the rim.
    float w = sqrt(max(0.0f, 1.0f - u.x * (2.0f - q) / (1.0f + s.cosine)));
    result.distance = (s.distance - radius) * (s.distance + radius) / (s.distance * cosine + radius * w);
    // Angle at the centre, between the point and the axis.
    float sinAlpha = result.distance * sine / radius;
    float cosAlpha = sine2 / s.sine + cosine * w;
    result.normal = around * sinAlpha - s.axis * cosAlpha;
    return result;
}

// ---- triangle ------------------------------------------------------------------------------------------------------

// A triangle seen from a point: unit vectors to its vertices and the terms of tan(solid angle / 2) = det / (dots +
// base), where det = a . (b x c), dots = (a + b) . c and base = 1 + a . b. The determinant comes from the plane's
// normal: formed from the unit vectors it would cancel (Van Oosterom & Strackee 1983, made stable for small triangles).
struct SphericalTriangle {
    vec3 a;
    vec3 b;
    vec3 c;
    float det;
    float dots;
    float base;
    float solidAngle; // [0, 2 pi)
};

// Vertices relative to the point; `n` = (v1 - v0) x (v2 - v0), not normalised.
RT_FN SphericalTriangle makeSphericalTriangle(vec3 v0, vec3 v1, vec3 v2, vec3 n) {
    SphericalTriangle t;
    float i0 = 1.0f / length(v0);
    float i1 = 1.0f / length(v1);
    float i2 = 1.0f / length(v2);
    t.a = v0 * i0;
    t.b = v1 * i1;
    t.c = v2 * i2;
    t.det = abs(dot(n, t.a)) * i1 * i2;
    t.dots = dot(t.a + t.b, t.c);
    t.base = 1.0f + dot(t.a, t.b);
    t.solidAngle = 2.0f * arcTan(t.det, t.dots + t.base);
    return t;
}

// Unit vector on the arc from a to b at 1 - cos = u (1 - cos of the whole arc), without cancellation for short arcs.
RT_FN vec3 sampleArc(vec3 a, vec3 b, float u) {
    vec3 chord = b - a;
    float whole = 0.5f * dot(chord, chord);
    float q = u * whole;
    vec3 t = chord + a * whole; // along the arc's tangent at a
    float l2 = dot(t, t);
    return a * (1.0f - q) + t * sqrt(q * (2.0f - q) / max(l2, 1.0e-37f));
}

// Direction uniform in solid angle. Arvo, "Stratified Sampling of Spherical Triangles", 1995, with the bisector h of a
// and the split point c': the solid angle of (a, b, c') has tangent of the half det(a, b, h) / ((a + b) . h), linear in
// h, so h is found without an inverse cosine and without loss for small triangles (after Peters 2021).
RT_FN vec3 sampleSphericalTriangle(RT_IN(SphericalTriangle) t, vec2 u) {
    vec2 sc = sinCos2Pi(u.x * t.solidAngle * (0.25f * kInvPi));
    vec3 h = t.a * (t.det * sc.y - t.dots * sc.x) + t.c * (t.base * sc.x);
    vec3 split = h * (2.0f * dot(t.a, h) / max(dot(h, h), 1.0e-37f)) - t.a;
    return normalize(sampleArc(t.b, split, u.y));
}

// ---- rectangle -----------------------------------------------------------------------------------------------------

// A rectangle seen from a point at height h above its plane: points x xAxis + y yAxis + h zAxis with x in [x0, x0 +
// width] and y in [y0, y0 + height].
struct SphericalRectangle {
    vec3 xAxis;
    vec3 yAxis;
    vec3 zAxis; // unit normal of the plane, towards it
    float x0;
    float y0;
    float width;
    float height;
    float h;
    float solidAngle; // [0, 2 pi]
};

// Sums of angles below are arguments of products of complex numbers, so that one arc tangent serves.
RT_FN vec2 complexProduct(vec2 a, vec2 b) {
    return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
}

// 1 / distance of the corners (x0, y0), (x1, y0), (x0, y1), (x1, y1) of a rectangle at height h.
RT_FN vec4 cornerReciprocals(float x0, float x1, float y0, float y1, float h) {
    float h2 = h * h;
    return vec4(1.0f / sqrt(x0 * x0 + y0 * y0 + h2), 1.0f / sqrt(x1 * x1 + y0 * y0 + h2),
                1.0f / sqrt(x0 * x0 + y1 * y1 + h2), 1.0f / sqrt(x1 * x1 + y1 * y1 + h2));
}

// Solid angle of a rectangle that no coordinate axis through the foot (0, 0) crosses, or that is small as seen from
// there: two triangles, without cancellation however small they are.
RT_FN float smallRectangleSolidAngle(float x0, float width, float y0, float height, float h) {
    float x1 = x0 + width;
    float y1 = y0 + height;
    float h2 = h * h;
    vec4 i = cornerReciprocals(x0, x1, y0, y1, h);
    float diagonal = (x0 * x1 + y0 * y1 + h2) * i.x * i.w;
    float det = width * i.x * (height * i.w) * h;
    float d1 = 1.0f + diagonal + (x0 * x1 + y0 * y0 + h2) * i.x * i.y + (x1 * x1 + y0 * y1 + h2) * i.y * i.w;
    float d2 = 1.0f + diagonal + (x0 * x1 + y1 * y1 + h2) * i.w * i.z + (x0 * x0 + y0 * y1 + h2) * i.z * i.x;
    vec2 z = complexProduct(vec2(d1, det * i.y), vec2(d2, det * i.z));
    return 2.0f * arcTan(z.y, z.x);
}

// The same for any rectangle, within 3e-7 absolutely: the angles atan(x y / (h R)) of the rectangles between the foot
// and each corner, added with signs.
RT_FN float wideRectangleSolidAngle(float x0, float width, float y0, float height, float h) {
    float x1 = x0 + width;
    float y1 = y0 + height;
    vec4 i = cornerReciprocals(x0, x1, y0, y1, h);
    vec2 z =
        complexProduct(complexProduct(vec2(h * i.x, x0 * i.x * (y0 * i.x)), vec2(h * i.y, -x1 * i.y * (y0 * i.y))),
                       complexProduct(vec2(h * i.w, x1 * i.w * (y1 * i.w)), vec2(h * i.z, -x0 * i.z * (y1 * i.z))));
    float angle = arcTan(z.y, z.x);
    // Small negative angles are the noise of small rectangles.
    return angle < -4.0e-6f ? angle + 2.0f * kPi : angle;
}

const float kSmallRectangle = 0.05f; // solid angle below which absolute accuracy does not suffice

// Solid angle of [x0, x0 + width] x [y0, y0 + height] at height h: relative error below 1e-5.
RT_FN float rectangleSolidAngle(float x0, float width, float y0, float height, float h) {
    float omega = wideRectangleSolidAngle(x0, width, y0, height, h);
    if (omega >= kSmallRectangle) return omega;
    // Corners on both sides of the foot may lie almost opposite each other: cut the long side there.
    bool cutY = y0 < 0.0f && y0 + height > 0.0f;
    bool cutX = x0 < 0.0f && x0 + width > 0.0f && !(cutY && height > width);
    cutY = cutY && !cutX;
    omega = smallRectangleSolidAngle(x0, cutX ? -x0 : width, y0, cutY ? -y0 : height, h);
    if (cutX || cutY) {
        omega += smallRectangleSolidAngle(cutX ? 0.0f : x0, cutX ? x0 + width : width, cutY ? 0.0f : y0,
                                          cutY ? y0 + height : height, h);
    }
    return omega;
}

// `corner` relative to the point; edgeU and edgeV at right angles; `normal` unit, either side.
RT_FN SphericalRectangle makeSphericalRectangle(vec3 corner, vec3 edgeU, vec3 edgeV, vec3 normal) {
    SphericalRectangle r;
    r.width = length(edgeU);
    r.height = length(edgeV);
    r.xAxis = edgeU * (1.0f / r.width);
    r.yAxis = edgeV * (1.0f / r.height);
    r.x0 = dot(corner, r.xAxis);
    r.y0 = dot(corner, r.yAxis);
    float z = dot(corner, normal);
    r.zAxis = normal * signOf(z);
    r.h = abs(z);
    r.solidAngle = rectangleSolidAngle(r.x0, r.width, r.y0, r.height, r.h);
    return r;
}

// Width w of the column [x0, x0 + w] that has the share u of the solid angle, in closed form. Urena, Fajardo & King,
// "An Area-Preserving Parametrization for Spherical Rectangles", 2013; the angle k = 2 pi - g2 - g3 enters by its sine
// and cosine only. Good while the solid angle is well above a float's resolution of 2 pi.
RT_FN float rectangleColumn(RT_IN(SphericalRectangle) r, float u) {
    float y1 = r.y0 + r.height;
    float i0 = 1.0f / sqrt(r.h * r.h + r.y0 * r.y0);
    float i2 = 1.0f / sqrt(r.h * r.h + y1 * y1);
    float i3 = 1.0f / sqrt(r.h * r.h + r.x0 * r.x0);
    // Heights of the unit normals of the planes through the point and three of the edges, and 1 - their squares.
    float b0 = -r.y0 * i0;
    float b1 = y1 * i2;
    float b3 = -r.x0 * i3;
    float a0 = square(r.h * i0);
    float a2 = square(r.h * i2);
    float a3 = square(r.h * i3);
    float c2 = -b1 * b3;
    float c3 = -b3 * b0;
    float s2 = sqrt(a2 + a3 - a2 * a3);
    float s3 = sqrt(a3 + a0 - a3 * a0);
    vec2 k = vec2(-(s2 * c3 + c2 * s3), c2 * c3 - s2 * s3);
    vec2 p = sinCos2Pi(u * r.solidAngle * (0.5f * kInvPi));
    float sine = p.x * k.y + p.y * k.x;
    float cosine = p.y * k.y - p.x * k.x;
    float q = b0 * cosine - b1;
    float x = r.h * signOf(q) * sine / sqrt(max(q * q - a0 * sine * sine, 1.0e-37f));
    return x - r.x0;
}

// The same by Newton's method in w, for any solid angle: seeded by the exact answer for thin strips, guarded by
// bisection.
RT_FN float rectangleColumnNewton(RT_IN(SphericalRectangle) r, float u) {
    float y1 = r.y0 + r.height;
    float h2 = r.h * r.h;
    float target = u * r.solidAngle;
    float mid = r.y0 < 0.0f && y1 > 0.0f ? 0.0f : 0.5f * (r.y0 + y1);
    float d2 = h2 + mid * mid;
    float x1 = r.x0 + r.width;
    float e0 = r.x0 / sqrt(r.x0 * r.x0 + d2);
    float e1 = x1 / sqrt(x1 * x1 + d2);
    float e = e0 + u * (e1 - e0);
    float w = e * sqrt(d2 / max((1.0f - e) * (1.0f + e), 1.0e-37f)) - r.x0;
    float low = 0.0f;
    float high = r.width;
    for (int i = 0; i < 8; ++i) {
        w = clamp(w, low, high);
        float error = rectangleSolidAngle(r.x0, w, r.y0, r.height, r.h) - target;
        if (abs(error) <= 3.0e-7f * r.solidAngle) break;
        float x = r.x0 + w;
        float d = x * x + h2;
        float r0 = sqrt(d + r.y0 * r.y0);
        float r1 = sqrt(d + y1 * y1);
        // Difference of y / R at y1 and y0, without cancellation where they have the same sign.
        float span =
            mid == 0.0f ? y1 / r1 - r.y0 / r0 : d * r.height * (y1 + r.y0) / ((y1 * r0 + r.y0 * r1) * (r0 * r1));
        float next = w - error * d / (r.h * span);
        // Far from the root the bracket is safe to use; near it the sign of the error is noise.
        if (abs(error) > 2.0e-3f * r.solidAngle) {
            if (error > 0.0f) {
                high = w;
            } else {
                low = w;
            }
            if (!(next > low && next < high)) next = 0.5f * (low + high);
        }
        w = next;
    }
    return w;
}

// Position on the rectangle, (a, b) in [0, width] x [0, height], such that the direction is uniform in solid angle:
// first a column, then y in the column.
RT_FN vec2 sampleSphericalRectangle(RT_IN(SphericalRectangle) r, vec2 u) {
    float a = r.solidAngle >= kSmallRectangle ? rectangleColumn(r, u.x) : rectangleColumnNewton(r, u.x);
    a = clamp(a, 0.0f, r.width);
    float d2 = square(r.x0 + a) + r.h * r.h;
    float y1 = r.y0 + r.height;
    float e0 = r.y0 / sqrt(d2 + r.y0 * r.y0);
    float e1 = y1 / sqrt(d2 + y1 * y1);
    float e = e0 + u.y * (e1 - e0);
    float y = e * sqrt(d2 / max((1.0f - e) * (1.0f + e), 1.0e-37f));
    return vec2(a, clamp(y - r.y0, 0.0f, r.height));
}

// The numbers u for which sampleSphericalRectangle gives this position, to 1e-5 where the solid angle is at least
// kSmallRectangle.
RT_FN vec2 wideRectangleNumbers(RT_IN(SphericalRectangle) r, vec2 position) {
    vec2 p = clamp(position, vec2(0.0f), vec2(r.width, r.height));
    float d2 = square(r.x0 + p.x) + r.h * r.h;
    float y1 = r.y0 + r.height;
    float y = r.y0 + p.y;
    float e0 = r.y0 / sqrt(d2 + r.y0 * r.y0);
    float e1 = y1 / sqrt(d2 + y1 * y1);
    float e = y / sqrt(d2 + y * y);
    vec2 u = vec2(wideRectangleSolidAngle(r.x0, p.x, r.y0, r.height, r.h) / r.solidAngle, (e - e0) / (e1 - e0));
    return clamp(u, vec2(0.0f), vec2(1.0f));
}

// ---- thin rectangle ------------------------------------------------------------------------------------------------

// A thin rectangle as a line light along its long edge. A line at distance sqrt(d) is seen at d / (p^2 + d)^(3/2) per
// unit of p, the coordinate along it from the foot of the perpendicular, all in units of the edge. That is only nearly
// uniform in solid angle, but the density is exactly that of the samples.
struct Strip {
    float start; // p of the edge's beginning; its end is at start + 1
    float d;
    // 1 - p / sqrt(p^2 + d) at the beginning and the end, p counted towards the side where most of the edge is
    float rest0;
    float rest1;
    float mirror;  // that side: 1 or -1
    float inverse; // 1 / length^2 of the edge
};

struct StripSample {
    float a;   // along the edge, [0,1]
    float pdf; // over [0,1]
};

// 1 - p / sqrt(p^2 + d) without cancellation.
RT_FN float stripRest(float p, float d) {
    float r2 = p * p + d;
    float pr = p * sqrt(r2);
    return (p > 0.0f ? d : r2 - pr) / (p > 0.0f ? r2 + pr : r2);
}

// `middle`: from the point to the middle of the short edge at the beginning; `edge` the long edge; `width2` the short
// one squared.
RT_FN Strip makeStrip(vec3 middle, vec3 edge, float width2) {
    Strip c;
    c.inverse = 1.0f / dot(edge, edge);
    c.start = dot(middle, edge) * c.inverse;
    vec3 across = middle - edge * c.start;
    c.d = (dot(across, across) + width2 * (1.0f / 12.0f)) * c.inverse; // mean over the width
    c.mirror = signOf(c.start + 0.5f);
    c.rest0 = stripRest(c.mirror * c.start, c.d);
    c.rest1 = stripRest(c.mirror * (c.start + 1.0f), c.d);
    return c;
}

// Distance squared from the point to the segment, in units of its length.
RT_FN float stripDistance2(RT_IN(Strip) c) {
    return c.d + square(max(max(c.start, -1.0f - c.start), 0.0f));
}

RT_FN StripSample sampleStrip(RT_IN(Strip) c, float u) {
    float rest = mix(c.rest0, c.rest1, u);
    float cosine2 = rest * (2.0f - rest);
    float r = sqrt(c.d / max(cosine2, 1.0e-37f));
    StripSample s;
    s.a = clamp((1.0f - rest) * r * c.mirror - c.start, 0.0f, 1.0f);
    s.pdf = cosine2 / (r * abs(c.rest0 - c.rest1));
    return s;
}

// The same density at the coordinate p.
RT_FN float stripPdf(RT_IN(Strip) c, float p) {
    float r2 = p * p + c.d;
    return c.d / (r2 * sqrt(r2) * abs(c.rest0 - c.rest1));
}

// ---- points uniform in area ----------------------------------------------------------------------------------------

// Density per steradian of a point drawn uniformly from `area`, seen at `distance` under the cosine `cosine` of its
// normal.
RT_FN float areaPdf(float area, float distance, float cosine) {
    float denominator = area * abs(cosine);
    return denominator > 0.0f ? distance * distance / denominator : 0.0f;
}

// Weights of the triangle's edges v1 - v0 and v2 - v0.
RT_FN vec2 sampleTriangleArea(vec2 u) {
    float s = sqrt(u.x);
    return vec2(s * (1.0f - u.y), s * u.y);
}

RT_SHARED_END

#endif
