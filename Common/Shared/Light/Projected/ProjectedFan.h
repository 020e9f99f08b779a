// A parallelogram or triangle seen from a point with a normal, cut into slices.
//
// Slices are vertical half planes through the normal: the azimuth chooses one, and in it the projected solid angle is
// the difference of the squared sines of two elevations. A slice cuts the light's plane in a straight line, so all of it
// is computed in the light's own coordinates (u, v), where small and distant lights lose no digits, and the place in a
// slice is the root of a quadratic equation. (Peters, "BRDF Importance Sampling for Polygonal Lights", 2021, samples the
// same density by inverting it in azimuth.)
#ifndef RT_SHARED_PROJECTED_FAN_H
#define RT_SHARED_PROJECTED_FAN_H
#include "Common/Shared/Base/Sampling.h"

RT_SHARED_BEGIN

// The outline is that of the part above the horizon. If the zenith is inside, or a vertex, slices reach from an edge up to
// it, and the outline runs in the sense of azimuths. Otherwise they reach from one edge to another one.
struct ProjectedFan {
    vec3 corner; // in the frame of the receiver's normal, lengths scaled to about 1
    vec3 edgeU;
    vec3 edgeV;
    vec3 plane;   // unit normal of the light
    float height; // of the receiver above the light's plane
    bool triangle;
    bool around; // the zenith is inside, or a vertex, which is left out
    uint edges;  // of an outline around the zenith: one less than vertices if the zenith is one of them; 0: invisible
    uint count;  // of vertices
    uint first;  // not around: the vertex at which azimuths begin
    uint last;   // and that at which they end
    vec2 uv[6];  // vertices; rounding may let a quad in the horizon have six
};

// Slices between two vertices.
struct FanSector {
    vec2 start;  // azimuth at which it begins, unit
    vec2 uv;     // the vertex there
    float reach; // its horizontal distance
    float z;     // its height
    float angle;
    vec4 edgeA; // (u, v) of both ends, relative to the vertex, of an edge that bounds all of these slices
    vec4 edgeB; // and of another one, if the zenith does not bound them
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
RT_FN vec3 fanPoint(RT_IN(ProjectedFan) fan, vec2 uv) {
    return fan.corner + fan.edgeU * uv.x + fan.edgeV * uv.y;
}

// Twice the signed area between the horizontal projections of two vertices, exact for neighbours in a small light.
RT_FN float fanTurn(RT_IN(ProjectedFan) fan, vec2 a, vec2 b) {
    vec2 p = horizontal(fanPoint(fan, a));
    vec2 q = horizontal(fan.edgeU * (b.x - a.x) + fan.edgeV * (b.y - a.y));
    return cross2(p, q);
}

RT_FN uint fanNext(RT_IN(ProjectedFan) fan, uint i) {
    return i + 1u < fan.count ? i + 1u : 0u;
}
RT_FN uint fanPrevious(RT_IN(ProjectedFan) fan, uint i) {
    return i > 0u ? i - 1u : fan.count - 1u;
}

// ---- outline --------------------------------------------------------------------------------------------------------

// Replaces the outline by the part of it above the horizon.
RT_FN void clipToHorizon(RT_INOUT(ProjectedFan) fan) {
    vec2 whole[4];
    whole[0] = vec2(0.0f, 0.0f);
    whole[1] = vec2(1.0f, 0.0f);
    whole[2] = fan.triangle ? vec2(0.0f, 1.0f) : vec2(1.0f, 1.0f);
    whole[3] = vec2(0.0f, 1.0f);
    uint n = fan.triangle ? 3u : 4u;
    fan.count = 0u;
    for (uint i = 0u; i < n; i++) {
        vec2 a = whole[i];
        vec2 b = whole[i + 1u < n ? i + 1u : 0u];
        float za = fanPoint(fan, a).z;
        float zb = fanPoint(fan, b).z;
        if (za >= 0.0f) fan.uv[fan.count++] = a;
        if ((za >= 0.0f) != (zb >= 0.0f)) fan.uv[fan.count++] = a + (b - a) * clamp(za / (za - zb), 0.0f, 1.0f);
    }
}

RT_FN bool isZenith(RT_IN(ProjectedFan) fan, vec2 uv) {
    vec2 p = horizontal(fanPoint(fan, uv));
    return dot(p, p) <= 1.0e-13f;
}

// Leaves out vertices at the zenith, which have no azimuth; the outline then begins behind them.
RT_FN void removeZenith(RT_INOUT(ProjectedFan) fan) {
    uint at = fan.count;
    for (uint i = 0u; i < fan.count; i++)
        if (isZenith(fan, fan.uv[i]) && !isZenith(fan, fan.uv[fanNext(fan, i)])) at = i;
    if (at == fan.count) return;
    vec2 rest[6];
    uint n = 0u;
    for (uint i = 1u; i < fan.count; i++) {
        vec2 uv = fan.uv[(at + i) % fan.count];
        if (!isZenith(fan, uv)) rest[n++] = uv;
    }
    for (uint i = 0u; i < n; i++) fan.uv[i] = rest[i];
    fan.count = n;
    fan.edges = max(n, 1u) - 1u;
    fan.around = true;
}

// Finds out whether the outline is around the zenith, and where its azimuths begin and end.
RT_FN void orient(RT_INOUT(ProjectedFan) fan) {
    uint n = fan.around ? fan.edges : fan.count;
    uint left = 0u;
    bool before = fan.count > 1u && fanTurn(fan, fan.uv[fan.count - 1u], fan.uv[0]) > 0.0f;
    for (uint i = 0u; i < n; i++) {
        bool onward = fanTurn(fan, fan.uv[i], fan.uv[fanNext(fan, i)]) > 0.0f;
        left += onward ? 1u : 0u;
        if (onward && !before) fan.first = i;
        if (!onward && before) fan.last = i;
        before = onward;
    }
    if (!fan.around && left != 0u && left != n) return;
    fan.around = true;
    fan.edges = n;
    if (2u * left >= n) return;
    for (uint i = 0u; i < fan.count / 2u; i++) {
        vec2 other = fan.uv[fan.count - 1u - i];
        fan.uv[fan.count - 1u - i] = fan.uv[i];
        fan.uv[i] = other;
    }
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
    fan.around = false;
    fan.edges = 0u;
    fan.first = 0u;
    fan.last = 0u;
    clipToHorizon(fan);
    removeZenith(fan);
    if (fan.height > 0.0f && fan.count > 1u) {
        orient(fan);
    } else {
        fan.count = 0u;
    }
    return fan;
}

// ---- slices ---------------------------------------------------------------------------------------------------------

// From vertex `from` to `to`, bounded by the edges a to a2 and b to b2: all of them indices.
RT_FN FanSector fanSector(RT_IN(ProjectedFan) fan, uint from, uint to, uvec2 a, uvec2 b) {
    FanSector s;
    s.uv = fan.uv[from];
    vec3 start = fanPoint(fan, s.uv);
    vec2 p = horizontal(start);
    vec2 q = horizontal(fanPoint(fan, fan.uv[to]));
    s.reach = length(p);
    s.start = p * (1.0f / s.reach);
    s.z = max(start.z, 0.0f);
    s.angle = max(arcTan(fanTurn(fan, s.uv, fan.uv[to]), dot(p, q)), 0.0f);
    s.edgeA = vec4(fan.uv[a.x] - s.uv, fan.uv[a.y] - s.uv);
    s.edgeB = vec4(fan.uv[b.x] - s.uv, fan.uv[b.y] - s.uv);
    return s;
}

// Where an edge meets the line dot(off, across) = level.
RT_FN vec2 fanCrossing(vec4 edge, vec2 across, float level) {
    vec2 a = vec2(edge.x, edge.y);
    vec2 b = vec2(edge.z, edge.w);
    float beyondA = dot(across, a) - level;
    float beyondB = dot(across, b) - level;
    float whole = beyondA - beyondB;
    return a + (b - a) * clamp(beyondA / (whole != 0.0f ? whole : 1.0f), 0.0f, 1.0f);
}

// The slice at `turn` from the beginning of a sector.
RT_FN FanSlice fanSlice(RT_IN(ProjectedFan) fan, RT_IN(FanSector) sector, float turn) {
    vec2 sc = sinCos2Pi(clamp(turn * (0.5f * kInvPi), 0.0f, 1.0f));
    vec2 d = vec2(sector.start.x * sc.y - sector.start.y * sc.x, sector.start.x * sc.x + sector.start.y * sc.y);
    FanSlice slice;
    slice.mass = 0.0f;
    // (u, v) relative to the sector's vertex, which keeps the digits of small lights.
    vec2 across = vec2(cross2(d, horizontal(fan.edgeU)), cross2(d, horizontal(fan.edgeV)));
    vec2 onward = vec2(dot(d, horizontal(fan.edgeU)), dot(d, horizontal(fan.edgeV)));
    vec2 upward = vec2(fan.edgeU.z, fan.edgeV.z);
    float begin = sector.reach * sc.y;
    vec2 from = fanCrossing(sector.edgeA, across, sector.reach * sc.x);
    vec2 a = vec2(max(begin + dot(onward, from), 0.0f), max(sector.z + dot(upward, from), 0.0f));
    vec2 to = fanCrossing(sector.edgeB, across, sector.reach * sc.x);
    if (fan.around) {
        vec2 along = vec2(-across.y, across.x);
        float slope = dot(onward, along);
        to = from - along * (a.x / (slope != 0.0f ? slope : 1.0f));
    }
    vec2 b = vec2(max(begin + dot(onward, to), 0.0f), max(sector.z + dot(upward, to), 0.0f));
    bool swapped = a.y * b.x > b.y * a.x;
    slice.uv = sector.uv + (swapped ? to : from);
    slice.uvSpan = swapped ? from - to : to - from;
    slice.p = swapped ? b : a;
    slice.span = vec2(dot(onward, slice.uvSpan), dot(upward, slice.uvSpan));
    // Twice the triangle between the receiver and the slice, over the receiver's height above the light's plane.
    // The sine is that of the angle between light and slice, which is small where a light is seen edge-on, upright.
    float along = fan.plane.x * d.x + fan.plane.y * d.y;
    float sine2 = fan.plane.z * fan.plane.z + along * along;
    if (!(sine2 > 0.0f)) return slice;
    vec3 chord = fan.edgeU * slice.uvSpan.x + fan.edgeV * slice.uvSpan.y;
    slice.mass =
        0.5f * sqrt(dot(chord, chord) / sine2) * (a.x * b.y + a.y * b.x) / max(dot(a, a) * dot(b, b), 1.0e-37f);
    return slice;
}

RT_SHARED_END

#endif
