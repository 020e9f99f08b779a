// A parallelogram or triangle seen from a point with a normal, cut into slices.
//
// Slices are vertical half planes through the normal: the azimuth chooses one, and in it the projected solid angle is
// the difference of the squared sines of two elevations. A slice cuts the light's plane in a straight line, so all of it
// is computed in the light's own coordinates (u, v), where small and distant lights lose no digits, and the place in a
// slice is the root of a quadratic equation. The marginal over the azimuth is smooth between the vertices; each sector
// from one vertex to the next has its own fit. (Peters, "BRDF Importance Sampling for Polygonal Lights", 2021, samples the
// same density by inverting it in azimuth.)
#ifndef RT_SHARED_PROJECTED_FAN_H
#define RT_SHARED_PROJECTED_FAN_H
#include "PiecewiseFit.h"
#include "Sampling.h"

RT_SHARED_BEGIN

const uint kFanSectors = 5u;  // at most: between the vertices of a quad cut by the horizon
const uint kFanSlices = 128u; // of all sectors

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

// Piece k of the n + 1 of a sector of n slices: from the beginning to the first slice, between slices, from the last
// to the end.
RT_FN FitPiece fanPiece(RT_IN(ProjectedFan) fan, uint j, uint k) {
    uint low = fan.first[j] + max(k, 1u) - 1u;
    uint high = fan.first[j] + min(k, fan.count[j] - 1u);
    FitPiece s;
    s.a = k == 0u ? fan.low[j] : fan.mass[low];
    s.b = k == fan.count[j] ? fan.high[j] : fan.mass[high];
    s.start = k == 0u ? 0.0f : fan.turn[low];
    s.width = (k == fan.count[j] ? fan.angle[j] : fan.turn[high]) - s.start;
    s.form = fan.form[j];
    return s;
}

RT_SHARED_END

#endif
