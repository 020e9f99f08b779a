// The density of a fan's slices over the azimuth, by a walk from slice to slice that takes as many as the fit needs. The
// walk adds up the fit and keeps its pieces, of which a number then picks one; for an azimuth it keeps none.
#ifndef RT_SHARED_PROJECTED_FAN_FIT_H
#define RT_SHARED_PROJECTED_FAN_FIT_H
#include "Common/Shared/Light/Projected/PiecewiseFit.h"
#include "Common/Shared/Light/Projected/ProjectedFan.h"

RT_SHARED_BEGIN

const float kFanStep = 0.3f;         // angle between three slices at most
const float kFanRise = 0.12f;        // and how much the squared sines of their ends' elevations may differ
const float kFanTolerance = 6.0e-4f; // relative variance that the fit between slices may leave before they come closer
const uint kFanSlices = 128u;        // from then on they come no closer
const uint kFanPieces = 160u;        // at most: each sector then adds a last step

// Pieces of the fit, of all sectors, and the one that a number or an azimuth picks.
struct FanPick {
    bool byNumber;
    vec2 azimuth; // any length; otherwise a number in [0,1)
    float least;  // angle between the azimuth and the nearest sector so far
    float total;  // integral of the fit
    uint pieces;
    uint sectors;
    vec4 kept[kFanPieces]; // by number only: a, b, start and width of each piece
    uint form[5];          // of a sector's pieces
    uint end[5];           // behind a sector's last piece
    FanSector keptSector[5];
    FanSector sector; // picked
    FitPiece piece;
    float turn; // from the beginning of the sector
};
RT_LARGE_VARIABLE(FanPick, pick)

// ---- around the zenith ----------------------------------------------------------------------------------------------

// The projected solid angle between an edge and the zenith is in proportion to the angle along the edge: no fit is needed.
RT_FN float fanArc(vec3 p, vec3 q) {
    return arcTan(length(cross(p, q - p)), dot(p, q));
}

RT_FN void pickAround(RT_LARGE_INOUT(FanPick, pick) RT_IN(ProjectedFan) fan, float number) {
    float mass[6];
    for (uint i = 0u; i < fan.edges; i++) {
        vec3 p = fanPoint(fan, fan.uv[i]);
        vec3 q = fanPoint(fan, fan.uv[fanNext(fan, i)]);
        vec3 across = cross(p, q - p);
        mass[i] = fanArc(p, q) * abs(across.z) / max(2.0f * length(across) * fan.height, 1.0e-37f);
        pick.total += mass[i];
    }
    if (!pick.byNumber || !(pick.total > 0.0f)) return;
    float rest = number * pick.total;
    uint picked = 0u;
    while (picked + 1u < fan.edges && rest >= mass[picked]) rest -= mass[picked++];
    uint next = fanNext(fan, picked);
    pick.sector = fanSector(fan, picked, next, uvec2(picked, next), uvec2(picked, next));
    vec3 p = fanPoint(fan, fan.uv[picked]);
    vec3 q = fanPoint(fan, fan.uv[next]);
    float arc = fanArc(p, q) * (0.5f * kInvPi);
    float share = min(rest / max(mass[picked], 1.0e-37f), 1.0f);
    float toP = sinCos2Pi((1.0f - share) * arc).x / max(length(p), 1.0e-37f);
    float toQ = sinCos2Pi(share * arc).x / max(length(q), 1.0e-37f);
    vec2 d = horizontal(p) * toP + horizontal(q) * toQ;
    pick.turn = clamp(arcTan(cross2(pick.sector.start, d), dot(pick.sector.start, d)), 0.0f, pick.sector.angle);
}

// ---- from edge to edge ----------------------------------------------------------------------------------------------

// What the walk remembers of a slice.
struct FanKnot {
    float turn;
    float mass;
    vec2 rise; // squared sines of the elevations of its ends
};

RT_FN FanKnot fanKnot(RT_IN(FanSlice) slice, float turn) {
    vec2 q = slice.p + slice.span;
    FanKnot k;
    k.turn = turn;
    k.mass = slice.mass;
    k.rise.x = slice.p.y * slice.p.y / max(dot(slice.p, slice.p), 1.0e-37f);
    k.rise.y = q.y * q.y / max(dot(q, q), 1.0e-37f);
    return k;
}

RT_FN FitPiece fanPiece(uint form, RT_IN(FanKnot) a, RT_IN(FanKnot) b) {
    FitPiece s;
    s.a = fitFunction(form, a.mass);
    s.b = fitFunction(form, b.mass);
    s.start = a.turn;
    s.width = b.turn - a.turn;
    s.form = form;
    return s;
}

// `turn`: the azimuth's in this sector, if it is picked by that, or less than 0.
RT_FN void walkPiece(RT_LARGE_INOUT(FanPick, pick) RT_IN(FanSector) sector, RT_IN(FitPiece) piece, float turn) {
    pick.total += fitMass(piece);
    if (pick.byNumber) {
        pick.kept[pick.pieces] = vec4(piece.a, piece.b, piece.start, piece.width);
    } else if (turn >= piece.start) {
        pick.sector = sector;
        pick.piece = piece;
    }
    pick.pieces++;
}

// Turn of the azimuth in this sector, -1 if another one is nearer.
RT_FN float azimuthTurn(RT_LARGE_INOUT(FanPick, pick) RT_IN(FanSector) sector) {
    float angle = arcTan(cross2(sector.start, pick.azimuth), dot(sector.start, pick.azimuth));
    float beyond = max(-angle, angle - sector.angle);
    if (beyond >= pick.least) return -1.0f;
    pick.least = beyond;
    pick.turn = clamp(angle, 0.0f, sector.angle);
    return pick.turn;
}

RT_FN bool isOnHorizon(RT_IN(ProjectedFan) fan, RT_IN(FanSector) sector, vec4 edge) {
    float a = sector.z + fan.edgeU.z * edge.x + fan.edgeV.z * edge.y;
    float b = sector.z + fan.edgeU.z * edge.z + fan.edgeV.z * edge.w;
    return max(a, b) <= 1.0e-6f;
}

// Slices of a sector: two next to each other and the one in their middle by turns, ever closer until the fit of the outer two
// misses little of the third. `slices` counts those of all sectors, `tolerance` is absolute.
RT_FN void walkSector(RT_LARGE_INOUT(FanPick, pick) RT_IN(ProjectedFan) fan, RT_IN(FanSector) sector,
                      RT_INOUT(uint) slices, float tolerance) {
    // From the horizon up a slice's mass is half the squared sine of its upper end's elevation.
    uint form =
        isOnHorizon(fan, sector, sector.edgeA) || isOnHorizon(fan, sector, sector.edgeB) ? kFitSquare : kFitLinear;
    float azimuth = pick.byNumber ? -1.0f : azimuthTurn(RT_LARGE(pick) sector);
    float turn = 0.0f;
    float stride = min(kFanStep, (sector.angle > 0.03f ? 0.5f : 1.0f) * sector.angle);
    FanKnot left;
    FanKnot right;
    left.turn = -1.0f;
    right.turn = -1.0f;
    // The only call of fanSlice in the walk: GPU compilers copy it into each.
    while (left.turn < sector.angle) {
        FanKnot knot = fanKnot(fanSlice(fan, sector, turn), turn);
        slices++;
        if (left.turn < 0.0f) {
            left = knot;
            turn = stride;
        } else if (right.turn < 0.0f) {
            right = knot;
            turn = 0.5f * (left.turn + right.turn);
        } else {
            FitPiece whole = fanPiece(form, left, right);
            vec2 rise = max(abs(knot.rise - left.rise), abs(knot.rise - right.rise));
            float missed = misfit(fitValue(whole, 0.5f), knot.mass, whole.width);
            bool steep = max(rise.x, rise.y) > kFanRise && whole.width > tolerance * fan.height;
            if ((steep || missed > tolerance) && slices < kFanSlices) {
                right = knot;
                stride = 0.5f * whole.width;
                turn = 0.5f * (left.turn + right.turn);
            } else {
                walkPiece(RT_LARGE(pick) sector, fanPiece(form, left, knot), azimuth);
                walkPiece(RT_LARGE(pick) sector, fanPiece(form, knot, right), azimuth);
                if (missed < 0.03f * tolerance) stride = min(2.0f * stride, kFanStep);
                if (slices >= kFanSlices) stride = sector.angle;
                left = right;
                right.turn = -1.0f;
                turn = left.turn + 1.25f * stride < sector.angle ? left.turn + stride : sector.angle;
            }
        }
    }
    if (pick.byNumber) {
        pick.keptSector[pick.sectors] = sector;
        pick.form[pick.sectors] = form;
        pick.end[pick.sectors] = pick.pieces;
    }
    pick.sectors++;
}

// Projected solid angle of the outline, by Lambert's formula: not to be relied on for the last digits of a small light.
RT_FN float fanMeasure(RT_IN(ProjectedFan) fan) {
    float sum = 0.0f;
    for (uint i = 0u; i < fan.count; i++) {
        vec2 uv = fan.uv[i];
        vec2 next = fan.uv[fanNext(fan, i)];
        vec3 a = fanPoint(fan, uv);
        vec3 edge = fan.edgeU * (next.x - uv.x) + fan.edgeV * (next.y - uv.y);
        vec3 across = cross(a, edge);
        float sine = length(across);
        sum += arcTan(sine, dot(a, a + edge)) * across.z / max(sine, 1.0e-37f);
    }
    return 0.5f * abs(sum);
}

// Two chains of edges lead from the first vertex to the last one; a sector ends at the next vertex of either.
RT_FN void pickSlice(RT_LARGE_INOUT(FanPick, pick) RT_IN(ProjectedFan) fan, float number) {
    float tolerance = kFanTolerance * fanMeasure(fan) / fan.height;
    uint slices = 0u;
    uint a = fan.first;
    uint b = fan.first;
    uint from = fan.first;
    for (uint n = 0u; n < fan.count && from != fan.last; n++) {
        uint nextA = fanNext(fan, a);
        uint nextB = fanPrevious(fan, b);
        bool byA = nextA != fan.last && (nextB == fan.last || fanTurn(fan, fan.uv[nextA], fan.uv[nextB]) > 0.0f);
        uint to = byA ? nextA : nextB;
        FanSector sector = fanSector(fan, from, to, uvec2(a, nextA), uvec2(b, nextB));
        if (sector.angle > 0.0f) walkSector(RT_LARGE(pick) fan, sector, slices, tolerance);
        from = to;
        if (byA) {
            a = nextA;
        } else {
            b = nextB;
        }
    }
    if (!pick.byNumber || !(pick.total > 0.0f)) return;
    float rest = number * pick.total;
    float mass = 0.0f;
    uint j = 0u;
    for (uint k = 0u; k < pick.pieces; k++) {
        if (k == pick.end[j]) j++;
        vec4 kept = pick.kept[k];
        pick.piece.a = kept.x;
        pick.piece.b = kept.y;
        pick.piece.start = kept.z;
        pick.piece.width = kept.w;
        pick.piece.form = pick.form[j];
        mass = fitMass(pick.piece);
        if (rest < mass) break;
        rest -= mass;
    }
    pick.sector = pick.keptSector[j];
    pick.turn = pick.piece.start + fitPlace(pick.piece, min(rest / max(mass, 1.0e-37f), 1.0f)) * pick.piece.width;
}

RT_SHARED_END

#endif
