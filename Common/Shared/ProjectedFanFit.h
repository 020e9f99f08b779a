// Makes the fan of a light: cuts it at the horizon, divides it into sectors between the azimuths of its vertices and
// chooses slices, as many as the fit needs.
#ifndef RT_SHARED_PROJECTED_FAN_FIT_H
#define RT_SHARED_PROJECTED_FAN_FIT_H
#include "ProjectedFan.h"

RT_SHARED_BEGIN

const float kFanStep = 0.6f;         // angle between the first slices, in azimuth and along the edges as they are seen
const float kFanWide = 0.15f;        // angle between slices from which on one middle that fits may be a coincidence
const float kFanTolerance = 4.0e-4f; // relative variance that the fit between two slices may leave before it is halved
const uint kFanHalvings = 12u;       // of the angle between the first slices
const uint kFanFewest = 12u;         // slices that the sectors before leave to each
const float kFanInset = 0.015f;      // of a sector: how far its first and its last slice are from its ends at most

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
    fan.mass[at] = fitFunction(fan.form[j], mass);
    fan.count[j]++;
}

// Slices of sector j behind `left`, which is there already, up to `right`: as many as it takes for the fit to miss no more
// than `tolerance` of the middle of any two, or as the array has room for up to `limit`.
RT_FN void addSlices(RT_INOUT(ProjectedFan) fan, uint j, vec2 left, vec2 right, float tolerance, uint limit) {
    // Turn and mass of slices that are to follow, the next one last.
    vec2 pending[kFanHalvings];
    pending[0] = right;
    uint count = 1u;
    while (count > 0u) {
        vec2 next = pending[count - 1u];
        bool room = fan.first[j] + fan.count[j] + count < limit;
        if (room && count < kFanHalvings) {
            FitPiece s;
            s.a = fitFunction(fan.form[j], left.y);
            s.b = fitFunction(fan.form[j], next.y);
            s.form = fan.form[j];
            float middle = 0.5f * (left.x + next.x);
            float mass = fanSlice(fan, j, middle).mass;
            // Inverses vary too slowly for coincidences.
            bool wide = fan.form[j] != kFitInverse && next.x - left.x > kFanWide;
            if (wide || misfit(fitValue(s, 0.5f), mass, next.x - left.x) > tolerance) {
                pending[count++] = vec2(middle, mass);
                continue;
            }
            addSlice(fan, j, middle, mass);
        }
        addSlice(fan, j, next.x, next.y);
        left = next;
        count--;
    }
}

// How near to its beginning or its end, in fractions of sector j, the first slice must be so that what lies beyond it
// hardly matters.
RT_FN float fanInset(RT_IN(ProjectedFan) fan, uint j, bool atEnd, float tolerance) {
    float inset = kFanInset;
    float first = 0.0f;
    // By turns at the inset, at half and at an eighth of it.
    for (uint i = 0u; i < 18u; i++) {
        float place = inset * (i % 3u == 0u ? 1.0f : (i % 3u == 1u ? 0.5f : 0.125f)) * fan.angle[j];
        float mass = fanSlice(fan, j, atEnd ? fan.angle[j] - place : place).mass;
        if (i % 3u == 0u) {
            first = mass;
        } else if (misfit(first, mass, inset * fan.angle[j]) > tolerance) {
            inset *= 0.125f;
            i += 2u - i % 3u;
        } else if (i % 3u == 2u) {
            break;
        }
    }
    return inset;
}

// Slices of sector j, the next after `first`: at its ends, and evenly in azimuth and along its lower and its upper edge
// as they are seen, since the mass of slices varies as these turn; between them as many as the fit needs.
RT_FN void fillSector(RT_INOUT(ProjectedFan) fan, uint j, uint first, uint limit, bool around, float tolerance) {
    fan.first[j] = first;
    fan.count[j] = 0u;
    // Loops keep the calls few: GPU compilers copy the code into each.
    float at[2];
    FanSlice ends[2];
    for (uint e = 0u; e < 2u; e++) {
        float inset = fanInset(fan, j, e == 1u, tolerance) * fan.angle[j];
        at[e] = e == 1u ? fan.angle[j] - inset : inset;
        ends[e] = fanSlice(fan, j, at[e]);
    }
    float begin = at[0];
    float end = at[1];
    FanSlice a = ends[0];
    FanSlice b = ends[1];
    FanArc low = fanArc(a.p, begin, b.p, end);
    FanArc high = fanArc(a.p + a.span, begin, b.p + b.span, end);
    // From the horizon up, a slice's mass is half the squared sine of its upper end's elevation. Up to the zenith, the
    // inverse of the mass is a function like 1 + c cos^2 of the azimuth.
    bool grounded = a.p.y <= 1.0e-6f * a.p.x && b.p.y <= 1.0e-6f * b.p.x;
    fan.form[j] = around ? kFitInverse : grounded ? kFitSquare : kFitLinear;
    float room = float(limit - first) - 2.0f;
    float scale = min(1.0f / kFanStep, room / (fan.angle[j] + low.angle + high.angle + kFanStep));
    uint evens = max(uint(fan.angle[j] * scale), 1u);
    uint lows = uint(low.angle * scale);
    uint highs = uint(high.angle * scale);
    addSlice(fan, j, begin, a.mass);
    vec2 previous = vec2(begin, a.mass);
    uint h = 1u;
    uint i = 1u;
    uint k = 1u;
    uint all = evens + lows + highs + 1u;
    for (uint n = 0u; n < all; n++) {
        float x = h <= evens ? mix(begin, end, float(h) / float(evens + 1u)) : kInfinity;
        float y = i <= lows ? fanArcTurn(low, float(i) / float(lows + 1u)) : kInfinity;
        float z = k <= highs ? fanArcTurn(high, float(k) / float(highs + 1u)) : kInfinity;
        float turn = min(x, min(y, z));
        if (turn == x) {
            h++;
        } else if (turn == y) {
            i++;
        } else {
            k++;
        }
        vec2 next = vec2(end, b.mass);
        if (n + 1u < all) {
            next.x = clamp(turn, previous.x, end);
            next.y = fanSlice(fan, j, next.x).mass;
        }
        addSlices(fan, j, previous, next, tolerance, limit - (all - 1u - n));
        previous = next;
    }
    // The ends are short; only inverse roots, which may nearly vanish there, go on as they came.
    uint last = first + fan.count[j] - 1u;
    fan.low[j] = fan.mass[first];
    fan.high[j] = fan.mass[last];
    if (around) {
        float before = (fan.mass[first + 1u] - fan.low[j]) * (begin / max(fan.turn[first + 1u] - begin, begin));
        float rest = fan.angle[j] - end;
        float after = (fan.mass[last - 1u] - fan.high[j]) * (rest / max(end - fan.turn[last - 1u], rest));
        fan.low[j] = clamp(fan.low[j] - before, 0.1f * fan.low[j], fan.low[j]);
        fan.high[j] = clamp(fan.high[j] - after, 0.1f * fan.high[j], fan.high[j]);
    }
    for (uint n = 0u; n <= fan.count[j]; n++) fan.total += fitMass(fanPiece(fan, j, n));
}

// Projected solid angle of the outline, by Lambert's formula: not to be relied on for the last digits of a small light.
RT_FN float fanMeasure(RT_IN(ProjectedFan) fan, RT_IN(FanOutline) o) {
    float sum = 0.0f;
    for (uint i = 0u; i < o.count; i++) {
        vec2 next = o.uv[i + 1u < o.count ? i + 1u : 0u];
        vec3 a = fan.corner + fan.edgeU * o.uv[i].x + fan.edgeV * o.uv[i].y;
        vec3 edge = fan.edgeU * (next.x - o.uv[i].x) + fan.edgeV * (next.y - o.uv[i].y);
        vec3 across = cross(a, edge);
        float sine = length(across);
        sum += arcTan(sine, dot(a, a + edge)) * across.z / max(sine, 1.0e-37f);
    }
    return 0.5f * abs(sum);
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
    FanOutline all = clipToHorizon(fan);
    FanOutline o = withoutZenith(fan, all);
    if (o.count < 2u || !(fan.height > 0.0f)) return fan;
    bool around = orderByAzimuth(fan, o);
    uint first = 0u;
    float tolerance = kFanTolerance * fanMeasure(fan, all) / fan.height;
    uint turns = around ? o.count : o.count - 1u;
    for (uint i = 0u; i < turns; i++) {
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
        uint limit = kFanSlices - kFanFewest * (turns - 1u - i); // leaves some to each sector to come
        fillSector(fan, j, first, limit, around, tolerance);
        first += fan.count[j];
        fan.sectors++;
    }
    return fan;
}

RT_SHARED_END

#endif
