// Samplers of light shapes by projected solid angle, the solid angle weighed by the cosine to the receiver's normal: an
// unoccluded diffuse receiver then sees no variance. Shapes are clipped to the horizon. Each maps the unit square to
// slices of the shape: the marginal over slices is a piecewise linear fit of their exact masses, the place in a slice is
// exact, and the density is that of the fit, not of the ideal. So no equation is solved by iteration and no sample is
// off: what the fit misses appears as weights near 1.
#ifndef RT_SHARED_PROJECTED_SHAPES_H
#define RT_SHARED_PROJECTED_SHAPES_H
#include "SphericalShapes.h"

RT_SHARED_BEGIN

// Where in an interval, [0,1], the integral of the linear function from a at 0 to b at 1 reaches `part`.
RT_FN float invertLinear(float a, float b, float part) {
    float root = sqrt(max(a * a + 2.0f * (b - a) * part, 0.0f));
    return min(2.0f * part / max(a + root, 1.0e-37f), 1.0f);
}

// ---- sphere ---------------------------------------------------------------------------------------------------------
//
// Seen from the tangent plane the cap of directions to a sphere is an ellipse (all of it above the horizon), an ellipse
// and a lune between it and the unit circle (its middle above), or a lune alone (its middle below). Urena & Georgiev,
// "Stratified Sampling of Projected Spherical Caps", 2018, cut them into slices parallel to the symmetry axis; so do we,
// at y = sine * sin(psi), with widths that need no difference of nearly equal numbers.

const uint kCapIntervals = 10u; // of psi, from 0 to the end

const uint kCapWhole = 0u;  // no part below the horizon
const uint kCapHigh = 1u;   // cut, its middle above the horizon
const uint kCapLow = 2u;    // cut, its middle at or below the horizon
const uint kCapHidden = 3u; // wholly below

struct ProjectedCap {
    SphereCone cone;
    uint kind;
    vec3 up;                        // unit, across cone.axis towards the normal
    vec3 side;                      // unit, across cone.axis and the normal
    float rise;                     // cosine between axis and normal
    float lean;                     // sine
    float cut;                      // y beyond which the ellipse is wholly above the horizon (kCapHigh)
    float end;                      // psi of the last slice
    float total;                    // integral of the fit over psi, half of the projected solid angle
    float mass[kCapIntervals + 1u]; // of slices, per psi
};

// A slice: x from right - width to right; at its right end the height above the tangent plane is `height`.
struct CapSlice {
    float width;
    float right;
    float height;
};

RT_FN CapSlice capSlice(RT_IN(ProjectedCap) cap, float sinPsi, float cosPsi) {
    float s = cap.cone.sine;
    float c = cap.cone.cosine;
    float a = abs(cap.rise);
    float y = s * sinPsi;
    float circle = sqrt(max((1.0f - y) * (1.0f + y), 0.0f));
    CapSlice slice;
    slice.right = circle;
    slice.height = 0.0f;
    if (cap.kind == kCapLow) {
        float z = max(s * cap.lean * cosPsi - a * c, 0.0f);
        slice.width = z * z / max(circle + (c * cap.lean + s * a * cosPsi), 1.0e-37f);
    } else if (cap.kind == kCapHigh && y <= cap.cut) {
        float z = c * cap.rise + s * cap.lean * cosPsi;
        slice.width = z * z / max(circle + (c * cap.lean - s * a * cosPsi), 1.0e-37f);
    } else {
        slice.width = 2.0f * s * a * cosPsi;
        slice.right = c * cap.lean + s * a * cosPsi;
        slice.height = max(c * cap.rise - s * cap.lean * cosPsi, 0.0f);
    }
    return slice;
}

// `normal` is the receiver's, unit.
RT_FN ProjectedCap makeProjectedCap(RT_IN(SphereCone) cone, vec3 normal) {
    ProjectedCap cap;
    cap.cone = cone;
    vec3 across = cross(normal, cone.axis);
    cap.lean = length(across);
    cap.rise = dot(normal, cone.axis);
    // Straight overhead any direction serves.
    cap.side = cap.lean > 1.0e-4f ? across * (1.0f / cap.lean) : makeFrame(cone.axis).bitangent;
    cap.up = cross(cone.axis, cap.side);
    float s = cone.sine;
    cap.kind = cap.rise >= s ? kCapWhole : cap.rise > 0.0f ? kCapHigh : cap.rise > -s ? kCapLow : kCapHidden;
    cap.cut = 0.0f;
    cap.end = 0.5f * kPi;
    cap.total = 0.0f;
    if (cap.kind == kCapWhole || cap.kind == kCapHidden) return cap;
    float g = sqrt((s - cap.rise) * (s + cap.rise));
    cap.cut = g / cap.lean;
    if (cap.kind == kCapLow) cap.end = arcTan(g, -cap.rise * cone.cosine);
    float stepSize = cap.end / float(kCapIntervals);
    for (uint i = 0u; i <= kCapIntervals; i++) {
        vec2 sc = sinCos2Pi(float(i) * stepSize * (0.5f * kInvPi));
        float cosPsi = max(sc.y, 0.0f);
        cap.mass[i] = capSlice(cap, sc.x, cosPsi).width * s * cosPsi;
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
    ConeSample result;
    float cosine = sqrt(max(1.0f - sine2, 0.0f));
    result.direction = normalize(across + cone.axis * cosine);
    float w = sqrt(max(0.0f, 1.0f - sine2 / (cone.sine * cone.sine)));
    result.distance = (cone.distance - radius) * (cone.distance + radius) / (cone.distance * cosine + radius * w);
    result.normal = across * (result.distance / radius) - cone.axis * (sine2 / cone.sine + cosine * w);
    return result;
}

// A direction with its density on the unit disk of the tangent plane: density per steradian is that times the cosine.
struct ProjectedDirection {
    ConeSample place;
    float density; // 0: nothing is visible
};

RT_FN ProjectedDirection sampleProjectedCap(RT_IN(ProjectedCap) cap, float radius, vec2 u) {
    ProjectedDirection result;
    float s = cap.cone.sine;
    float c = cap.cone.cosine;
    float y = 0.0f;
    float lift = 0.0f; // of the direction along `up`
    if (cap.kind == kCapWhole) {
        // Uniform in the ellipse. Height above that of its middle, c * rise, without cancellation for small caps.
        vec2 e = sampleDisk(u);
        float cosPsi = sqrt(max(0.0f, (1.0f - e.y) * (1.0f + e.y)));
        float a = cap.rise;
        float low = max(c * a - s * cap.lean * cosPsi, 0.0f);
        float x = c * cap.lean + s * a * e.x;
        float z = sqrt(low * low + s * a * max(cosPsi - e.x, 0.0f) * (c * cap.lean + s * a * cosPsi + x));
        float above = s * (-2.0f * c * a * cap.lean * e.x + s * (cosPsi * cosPsi - a * a * e.x * e.x)) / (z + c * a);
        y = s * e.y;
        lift = cap.lean * above - s * a * a * e.x;
        result.density = kInvPi / (s * s * a);
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
        CapSlice slice = capSlice(cap, sc.x, cosPsi);
        float inward = (1.0f - u.x) * slice.width;
        float x = slice.right - inward;
        float z = sqrt(slice.height * slice.height + inward * (slice.right + x));
        y = s * sc.x * signOf(u.y - 0.5f);
        lift = cap.lean * z - cap.rise * x;
        result.density = capDensity(cap, psi, slice, cosPsi);
    }
    // Rounding must not lead out of the cone.
    float sine2 = lift * lift + y * y;
    float shrink = sine2 > s * s ? s / sqrt(sine2) : 1.0f;
    result.place =
        placeOnSphere(cap.cone, radius, cap.up * (lift * shrink) + cap.side * (y * shrink), min(sine2, s * s));
    return result;
}

// Density on the unit disk at a direction that meets the sphere.
RT_FN float projectedCapDensity(RT_IN(ProjectedCap) cap, vec3 wi) {
    if (cap.kind == kCapWhole) return kInvPi / (cap.cone.sine * cap.cone.sine * cap.rise);
    if (cap.kind == kCapHidden) return 0.0f;
    float sinPsi = min(abs(dot(cap.side, wi)) / cap.cone.sine, 1.0f);
    float cosPsi = sqrt((1.0f - sinPsi) * (1.0f + sinPsi));
    return capDensity(cap, arcTan(sinPsi, cosPsi), capSlice(cap, sinPsi, cosPsi), cosPsi);
}

// ---- parallelogram and triangle -------------------------------------------------------------------------------------
//
// Slices are vertical half planes through the normal: the azimuth chooses one, and in it the projected solid angle is
// the difference of the squared sines of two elevations. A slice cuts the light's plane in a straight line, so all of it
// is computed in the light's own coordinates (u, v), where small and distant lights lose no digits, and the place in a
// slice is the root of a quadratic equation. The marginal over the azimuth is smooth between the vertices; each sector
// from one vertex to the next has its own fit. (Peters, "BRDF Importance Sampling for Polygonal Lights", 2021, samples the
// same density by inverting it in azimuth.)

const uint kFitLinear = 0u;
const uint kFitSquare = 1u;
const uint kFitInverse = 2u;

const uint kFanSectors = 5u;
const uint kFanSlices = 64u;
const float kFanStep = 0.2f;    // angle between slices, in azimuth and along the edges as the receiver sees them
const float kFanInset = 0.015f; // of a sector: how far its first and its last slice are from its ends

struct ProjectedFan {
    vec3 corner; // in the frame of the receiver's normal, lengths scaled to about 1
    vec3 edgeU;
    vec3 edgeV;
    vec3 plane;   // unit normal of the light
    float height; // of the receiver above the light's plane
    bool triangle;
    uint sectors;
    vec2 start[kFanSectors];  // azimuth at which a sector begins, unit
    vec2 uv[kFanSectors];     // the vertex there
    float reach[kFanSectors]; // its horizontal distance
    float angle[kFanSectors]; // of the sector
    uint first[kFanSectors];  // its slices
    uint count[kFanSectors];
    float turn[kFanSlices];  // angle of a slice from the beginning of its sector
    uint form[kFanSectors];  // of the fit
    float low[kFanSectors];  // at the sector's beginning
    float high[kFanSectors]; // at its end
    float mass[kFanSlices];  // of slices, per angle, without the factor `height`; kFitSquare: root of it, kFitInverse:
                             // inverse root
    float total;             // integral of the fit
};

// Ends of a slice on the light, the lower one first.
struct FanSlice {
    vec2 uv;
    vec2 uvSpan; // to the upper end
    vec2 p;      // horizontal distance and height of the lower end
    vec2 span;
    float mass; // per angle, without the factor `height`; 0: empty
};

RT_FN float cross2(vec2 a, vec2 b) {
    return a.x * b.y - a.y * b.x;
}
RT_FN vec2 horizontal(vec3 v) {
    return vec2(v.x, v.y);
}

// Narrows [range.x, range.y] to where f + slope * t >= 0.
RT_FN vec2 clipRange(vec2 range, float f, float slope) {
    float t = -f / (abs(slope) > 1.0e-37f ? slope : 1.0e-37f);
    if (slope > 0.0f) return vec2(max(range.x, t), range.y);
    if (slope < 0.0f) return vec2(range.x, min(range.y, t));
    return f < 0.0f ? vec2(1.0f, 0.0f) : range;
}

// The slice at `turn` from the beginning of sector j.
RT_FN FanSlice fanSlice(RT_IN(ProjectedFan) fan, uint j, float turn) {
    vec2 sc = sinCos2Pi(clamp(turn * (0.5f * kInvPi), 0.0f, 1.0f));
    vec2 d = vec2(fan.start[j].x * sc.y - fan.start[j].y * sc.x, fan.start[j].x * sc.x + fan.start[j].y * sc.y);
    FanSlice slice;
    slice.mass = 0.0f;
    // The line off.u * across.x + off.v * across.y = reach sin(turn), off = (u, v) - that of the vertex.
    vec2 across = vec2(cross2(d, horizontal(fan.edgeU)), cross2(d, horizontal(fan.edgeV)));
    float length2 = dot(across, across);
    if (!(length2 > 0.0f)) return slice;
    float inverse = 1.0f / sqrt(length2);
    vec2 along = vec2(-across.y, across.x) * inverse;
    vec2 uv = fan.uv[j] + across * (fan.reach[j] * sc.x * inverse * inverse);
    vec2 off = uv - fan.uv[j];
    vec3 vertex = fan.corner + fan.edgeU * fan.uv[j].x + fan.edgeV * fan.uv[j].y;
    float h = fan.reach[j] * sc.y + dot(d, horizontal(fan.edgeU)) * off.x + dot(d, horizontal(fan.edgeV)) * off.y;
    float z = max(vertex.z, 0.0f) + fan.edgeU.z * off.x + fan.edgeV.z * off.y;
    float slopeH = dot(d, horizontal(fan.edgeU)) * along.x + dot(d, horizontal(fan.edgeV)) * along.y;
    float slopeZ = fan.edgeU.z * along.x + fan.edgeV.z * along.y;
    vec2 range = vec2(-1.0e30f, 1.0e30f);
    range = clipRange(range, uv.x, along.x);
    range = clipRange(range, uv.y, along.y);
    if (fan.triangle) {
        range = clipRange(range, 1.0f - uv.x - uv.y, -along.x - along.y);
    } else {
        range = clipRange(range, 1.0f - uv.x, -along.x);
        range = clipRange(range, 1.0f - uv.y, -along.y);
    }
    range = clipRange(range, z, slopeZ);
    range = clipRange(range, h, slopeH);
    if (!(range.x < range.y)) return slice;
    vec2 a = vec2(max(h + slopeH * range.x, 0.0f), max(z + slopeZ * range.x, 0.0f));
    vec2 b = vec2(max(h + slopeH * range.y, 0.0f), max(z + slopeZ * range.y, 0.0f));
    bool swapped = a.y * b.x > b.y * a.x;
    float from = swapped ? range.y : range.x;
    float extent = swapped ? range.x - range.y : range.y - range.x;
    slice.uv = uv + along * from;
    slice.uvSpan = along * extent;
    slice.p = swapped ? b : a;
    slice.span = vec2(slopeH, slopeZ) * extent;
    // Twice the triangle between the receiver and the slice, over the receiver's height above the light's plane.
    float lean = fan.plane.y * d.x - fan.plane.x * d.y;
    float sine = sqrt(max((1.0f - lean) * (1.0f + lean), 0.0f));
    if (!(sine > 0.0f)) return slice;
    vec3 chord = fan.edgeU * slice.uvSpan.x + fan.edgeV * slice.uvSpan.y;
    float sum = a.x * b.y + a.y * b.x;
    slice.mass = 0.5f * length(chord) / sine * sum / max(dot(a, a) * dot(b, b), 1.0e-37f);
    return slice;
}

// A piece of the fit between two angles, a function f that is linear from a to b, or its square or inverse square.
struct FanSegment {
    float a;
    float b;
    float start;
    float width;
    uint form;
};

RT_FN float fitMass(RT_IN(FanSegment) s) {
    if (s.form == kFitInverse) return s.width / max(s.a * s.b, 1.0e-37f);
    return s.width * (s.form == kFitSquare ? (s.a * s.a + s.a * s.b + s.b * s.b) * (1.0f / 3.0f) : 0.5f * (s.a + s.b));
}

RT_FN float fitValue(RT_IN(FanSegment) s, float place) {
    float f = mix(s.a, s.b, place);
    if (s.form == kFitInverse) return 1.0f / max(f * f, 1.0e-37f);
    return s.form == kFitSquare ? f * f : f;
}

// Where in the piece, [0,1], its integral from the beginning reaches `part`.
RT_FN float fitPlace(RT_IN(FanSegment) s, float part) {
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

// Segment k of the n + 1 of a sector of n slices: from the beginning to the first slice, between slices, from the last
// to the end.
RT_FN FanSegment fanSegment(RT_IN(ProjectedFan) fan, uint j, uint k) {
    uint low = fan.first[j] + max(k, 1u) - 1u;
    uint high = fan.first[j] + min(k, fan.count[j] - 1u);
    FanSegment s;
    s.a = k == 0u ? fan.low[j] : fan.mass[low];
    s.b = k == fan.count[j] ? fan.high[j] : fan.mass[high];
    s.start = k == 0u ? 0.0f : fan.turn[low];
    s.width = (k == fan.count[j] ? fan.angle[j] : fan.turn[high]) - s.start;
    s.form = fan.form[j];
    return s;
}

// The polygon's vertices above the horizon, in order.
struct FanOutline {
    uint count;
    vec2 uv[5];
};

RT_FN float fanHeight(RT_IN(ProjectedFan) fan, vec2 uv) {
    return fan.corner.z + fan.edgeU.z * uv.x + fan.edgeV.z * uv.y;
}

RT_FN FanOutline clipToHorizon(RT_IN(ProjectedFan) fan) {
    vec2 whole[4];
    whole[0] = vec2(0.0f, 0.0f);
    whole[1] = vec2(1.0f, 0.0f);
    whole[2] = fan.triangle ? vec2(0.0f, 1.0f) : vec2(1.0f, 1.0f);
    whole[3] = vec2(0.0f, 1.0f);
    uint n = fan.triangle ? 3u : 4u;
    FanOutline o;
    o.count = 0u;
    for (uint i = 0u; i < n; i++) {
        vec2 a = whole[i];
        vec2 b = whole[i + 1u < n ? i + 1u : 0u];
        float za = fanHeight(fan, a);
        float zb = fanHeight(fan, b);
        if (za >= 0.0f) o.uv[o.count++] = a;
        if ((za >= 0.0f) != (zb >= 0.0f)) o.uv[o.count++] = a + (b - a) * clamp(za / (za - zb), 0.0f, 1.0f);
    }
    return o;
}

// Removes vertices at the zenith, which have no azimuth and whose neighbours bound the same slices.
RT_FN FanOutline withoutZenith(RT_IN(ProjectedFan) fan, RT_IN(FanOutline) all) {
    FanOutline o;
    o.count = 0u;
    for (uint i = 0u; i < all.count; i++) {
        vec2 p = horizontal(fan.corner + fan.edgeU * all.uv[i].x + fan.edgeV * all.uv[i].y);
        if (dot(p, p) > 1.0e-13f) o.uv[o.count++] = all.uv[i];
    }
    return o;
}

// Twice the signed area between the horizontal projections of two vertices, exact for neighbours in a small light.
RT_FN float fanTurn(RT_IN(ProjectedFan) fan, vec2 a, vec2 b) {
    vec2 p = horizontal(fan.corner + fan.edgeU * a.x + fan.edgeV * a.y);
    vec2 q = horizontal(fan.edgeU * (b.x - a.x) + fan.edgeV * (b.y - a.y));
    return cross2(p, q);
}

// Whether the zenith is inside; the vertices are then brought into the order of azimuths, else they are sorted by them.
RT_FN bool orderByAzimuth(RT_IN(ProjectedFan) fan, RT_INOUT(FanOutline) o) {
    uint left = 0u;
    for (uint i = 0u; i < o.count; i++)
        left += fanTurn(fan, o.uv[i], o.uv[i + 1u < o.count ? i + 1u : 0u]) > 0.0f ? 1u : 0u;
    if (left == o.count) return true;
    if (left == 0u) {
        for (uint i = 0u; i < o.count / 2u; i++) {
            vec2 other = o.uv[o.count - 1u - i];
            o.uv[o.count - 1u - i] = o.uv[i];
            o.uv[i] = other;
        }
        return true;
    }
    for (uint i = 1u; i < o.count; i++) {
        for (uint k = i; k > 0u && fanTurn(fan, o.uv[k - 1u], o.uv[k]) < 0.0f; k--) {
            vec2 other = o.uv[k];
            o.uv[k] = o.uv[k - 1u];
            o.uv[k - 1u] = other;
        }
    }
    return false;
}

// Part of an edge as the receiver sees it, in a frame about the beginning of a sector.
struct FanArc {
    vec3 from; // unit
    vec3 to;
    float angle;
};

RT_FN FanArc fanArc(vec2 p, float turnP, vec2 q, float turnQ) {
    vec2 a = sinCos2Pi(turnP * (0.5f * kInvPi));
    vec2 b = sinCos2Pi(turnQ * (0.5f * kInvPi));
    FanArc arc;
    arc.from = vec3(p.x * a.y, p.x * a.x, p.y) * (1.0f / max(length(p), 1.0e-30f));
    arc.to = vec3(q.x * b.y, q.x * b.x, q.y) * (1.0f / max(length(q), 1.0e-30f));
    arc.angle = 2.0f * arcTan(length(arc.to - arc.from), length(arc.to + arc.from));
    return arc;
}

// Azimuth at a fraction of the arc.
RT_FN float fanArcTurn(RT_IN(FanArc) arc, float fraction) {
    vec2 a = sinCos2Pi((1.0f - fraction) * arc.angle * (0.5f * kInvPi));
    vec2 b = sinCos2Pi(fraction * arc.angle * (0.5f * kInvPi));
    vec3 p = arc.from * a.x + arc.to * b.x;
    return arcTan(p.y, p.x);
}

RT_FN void addSlice(RT_INOUT(ProjectedFan) fan, uint j, float turn, float mass) {
    uint at = fan.first[j] + fan.count[j];
    fan.turn[at] = turn;
    float root = sqrt(mass);
    fan.mass[at] = fan.form[j] == kFitSquare ? root : fan.form[j] == kFitInverse ? 1.0f / max(root, 1.0e-15f) : mass;
    fan.count[j]++;
}

// Slices of sector j, the next after `first`: at its ends, and evenly in azimuth and along its lower and its upper edge
// as they are seen, since the mass of slices varies as these turn.
RT_FN void fillSector(RT_INOUT(ProjectedFan) fan, uint j, uint first, bool around) {
    fan.first[j] = first;
    fan.count[j] = 0u;
    float room = float(kFanSlices - 5u * (kFanSectors - 1u - j) - first) - 2.0f; // leaves five to each sector to come
    float begin = kFanInset * fan.angle[j];
    float end = fan.angle[j] - begin;
    FanSlice a = fanSlice(fan, j, begin);
    FanSlice b = fanSlice(fan, j, end);
    FanArc low = fanArc(a.p, begin, b.p, end);
    FanArc high = fanArc(a.p + a.span, begin, b.p + b.span, end);
    // From the horizon up, a slice's mass is half the squared sine of its upper end's elevation. Up to the zenith, the
    // inverse of the mass is a function like 1 + c cos^2 of the azimuth.
    bool grounded = a.p.y <= 1.0e-6f * a.p.x && b.p.y <= 1.0e-6f * b.p.x;
    fan.form[j] = around ? kFitInverse : grounded ? kFitSquare : kFitLinear;
    float scale = min(1.0f / kFanStep, room / (fan.angle[j] + low.angle + high.angle + kFanStep));
    uint evens = uint(fan.angle[j] * scale);
    uint lows = uint(low.angle * scale);
    uint highs = uint(high.angle * scale);
    if (evens + lows + highs < 3u) evens = 3u - lows - highs;
    addSlice(fan, j, begin, a.mass);
    uint h = 1u;
    uint i = 1u;
    uint k = 1u;
    float previous = begin;
    while (h <= evens || i <= lows || k <= highs) {
        float x = h <= evens ? mix(begin, end, float(h) / float(evens + 1u)) : kInfinity;
        float y = i <= lows ? fanArcTurn(low, float(i) / float(lows + 1u)) : kInfinity;
        float z = k <= highs ? fanArcTurn(high, float(k) / float(highs + 1u)) : kInfinity;
        float next = min(x, min(y, z));
        if (next == x) {
            h++;
        } else if (next == y) {
            i++;
        } else {
            k++;
        }
        next = clamp(next, previous, end);
        addSlice(fan, j, next, fanSlice(fan, j, next).mass);
        previous = next;
    }
    addSlice(fan, j, end, b.mass);
    // The ends are short; only inverse roots, which may nearly vanish there, go on as they came.
    uint last = first + fan.count[j] - 1u;
    fan.low[j] = fan.mass[first];
    fan.high[j] = fan.mass[last];
    if (around) {
        float before = (fan.mass[first + 1u] - fan.low[j]) * (begin / max(fan.turn[first + 1u] - begin, begin));
        float after = (fan.mass[last - 1u] - fan.high[j]) * (begin / max(end - fan.turn[last - 1u], begin));
        fan.low[j] = clamp(fan.low[j] - before, 0.1f * fan.low[j], fan.low[j]);
        fan.high[j] = clamp(fan.high[j] - after, 0.1f * fan.high[j], fan.high[j]);
    }
    for (uint n = 0u; n <= fan.count[j]; n++) fan.total += fitMass(fanSegment(fan, j, n));
}

// `corner` relative to the receiver, edges of the light (a triangle is half of the parallelogram), unit normals of the
// light's plane and of the receiver.
RT_FN ProjectedFan makeProjectedFan(vec3 corner, vec3 edgeU, vec3 edgeV, vec3 plane, bool triangle, vec3 normal) {
    ProjectedFan fan;
    Frame f = makeFrame(normal);
    float scale = 1.0f / (length(corner) + length(edgeU) + length(edgeV));
    corner = corner * scale;
    edgeU = edgeU * scale;
    edgeV = edgeV * scale;
    fan.corner = vec3(dot(corner, f.tangent), dot(corner, f.bitangent), dot(corner, normal));
    fan.edgeU = vec3(dot(edgeU, f.tangent), dot(edgeU, f.bitangent), dot(edgeU, normal));
    fan.edgeV = vec3(dot(edgeV, f.tangent), dot(edgeV, f.bitangent), dot(edgeV, normal));
    fan.plane = vec3(dot(plane, f.tangent), dot(plane, f.bitangent), dot(plane, normal));
    fan.height = abs(dot(corner, plane));
    fan.triangle = triangle;
    fan.sectors = 0u;
    fan.total = 0.0f;
    FanOutline o = withoutZenith(fan, clipToHorizon(fan));
    if (o.count < 2u || !(fan.height > 0.0f)) return fan;
    bool around = orderByAzimuth(fan, o);
    uint first = 0u;
    uint all = around ? o.count : o.count - 1u;
    for (uint i = 0u; i < all; i++) {
        vec2 next = o.uv[i + 1u < o.count ? i + 1u : 0u];
        vec2 p = horizontal(fan.corner + fan.edgeU * o.uv[i].x + fan.edgeV * o.uv[i].y);
        vec2 q = horizontal(fan.corner + fan.edgeU * next.x + fan.edgeV * next.y);
        float angle = arcTan(fanTurn(fan, o.uv[i], next), dot(p, q));
        if (!(angle > 0.0f)) continue;
        uint j = fan.sectors;
        fan.uv[j] = o.uv[i];
        fan.reach[j] = length(p);
        fan.start[j] = p * (1.0f / fan.reach[j]);
        fan.angle[j] = angle;
        fillSector(fan, j, first, around);
        first += fan.count[j];
        fan.sectors++;
    }
    return fan;
}

// A point of the light with the density of its direction on the unit disk of the tangent plane.
struct FanSample {
    vec2 uv;
    float density; // 0: nothing is visible
};

// Fraction of the slice's way up at which `part` of its projected solid angle lies below.
RT_FN float fanPlace(RT_IN(FanSlice) s, float part) {
    vec2 q = s.p + s.span;
    float p0 = dot(s.p, s.p);
    float p1 = dot(s.p, s.span);
    float p2 = dot(s.span, s.span);
    float sum0 = 2.0f * s.p.x * s.p.y;
    float sum1 = s.p.x * s.span.y + s.p.y * s.span.x;
    float whole = sum0 + sum1;
    float top = dot(q, q);
    float a = sum1 * top - part * whole * p2;
    float b = sum0 * top - 2.0f * part * whole * p1;
    float c = part * whole * p0;
    float root = sqrt(max(b * b + 4.0f * a * c, 0.0f));
    float place = b >= 0.0f ? 2.0f * c / max(b + root, 1.0e-37f) : (root - b) / (2.0f * max(a, 1.0e-37f));
    return clamp(place, 0.0f, 1.0f);
}

// Density on the unit disk where the fit has the value `fit` and the slice the mass `mass`. What fills less than 1e-30 of
// the disk counts as invisible.
RT_FN float fanDensity(RT_IN(ProjectedFan) fan, float fit, float mass) {
    float own = mass * fan.height;
    float density = fit / max(fan.total, 1.0e-37f) / max(own, 1.0e-37f);
    return own > 1.0e-37f && density < 1.0e30f ? density : 0.0f;
}

RT_FN FanSample sampleProjectedFan(RT_IN(ProjectedFan) fan, vec2 u) {
    FanSample result;
    result.density = 0.0f;
    result.uv = vec2(0.0f, 0.0f);
    if (!(fan.total > 0.0f)) return result;
    float rest = u.x * fan.total;
    uint j = 0u;
    uint k = 0u;
    FanSegment s = fanSegment(fan, 0u, 0u);
    float part = fitMass(s);
    while (rest >= part && !(j + 1u == fan.sectors && k == fan.count[j])) {
        rest -= part;
        k++;
        if (k > fan.count[j]) {
            k = 0u;
            j++;
        }
        s = fanSegment(fan, j, k);
        part = fitMass(s);
    }
    float place = fitPlace(s, min(rest, part));
    FanSlice slice = fanSlice(fan, j, s.start + place * s.width);
    if (!(slice.mass > 0.0f)) return result;
    vec2 uv = slice.uv + slice.uvSpan * fanPlace(slice, u.y);
    uv = vec2(clamp(uv.x, 0.0f, 1.0f), clamp(uv.y, 0.0f, 1.0f));
    if (fan.triangle) uv.y = min(uv.y, 1.0f - uv.x);
    result.uv = uv;
    result.density = fanDensity(fan, fitValue(s, place), slice.mass);
    return result;
}

// Density on the unit disk at a direction that meets the light; `local` in any frame about the normal is not enough:
// `normal` must be that of makeProjectedFan.
RT_FN float projectedFanDensity(RT_IN(ProjectedFan) fan, vec3 wi, vec3 normal) {
    if (!(fan.total > 0.0f)) return 0.0f;
    Frame f = makeFrame(normal);
    vec2 d = vec2(dot(wi, f.tangent), dot(wi, f.bitangent));
    // The sector that the azimuth is in, or is out of by the least.
    uint j = 0u;
    float turn = 0.0f;
    float least = 1.0e30f;
    for (uint i = 0u; i < fan.sectors; i++) {
        float angle = arcTan(cross2(fan.start[i], d), dot(fan.start[i], d));
        float beyond = max(-angle, angle - fan.angle[i]);
        if (beyond < least) {
            least = beyond;
            j = i;
            turn = clamp(angle, 0.0f, fan.angle[i]);
        }
    }
    uint k = 0u;
    while (k < fan.count[j] && fan.turn[fan.first[j] + k] < turn) k++;
    FanSegment s = fanSegment(fan, j, k);
    float place = clamp((turn - s.start) / max(s.width, 1.0e-37f), 0.0f, 1.0f);
    float mass = fanSlice(fan, j, turn).mass;
    return fanDensity(fan, fitValue(s, place), mass);
}

RT_SHARED_END

#endif
