// The outline of a parallelogram or triangle seen from a point with a normal, and its slices.
//
//         n          A slice is cut by the vertical half plane of an azimuth. Between the azimuths of two neighbouring vertices,
//         |  /|      in a sector, the same two edges bound every slice. If the zenith is on the light, slices reach from an edge
//         | / |      up to it instead.
//         |/  |
//      ---x---+---   Points are held by their coordinates (u, v) on the light, in which small and distant lights lose no digits.
#ifndef RT_SHARED_PROJECTED_OUTLINE_H
#define RT_SHARED_PROJECTED_OUTLINE_H
#include "Common/Shared/Base/Sampling.h"

RT_SHARED_BEGIN

const uint kOutlineVertices = 6u; // of a quad cut by the horizon; rounding may let one in the horizon have a sixth
const uint kOutlineSectors = kOutlineVertices; // at most one begins at each vertex

// The part of a light above the horizon of a receiver.
struct ProjectedOutline {
    vec3 corner; // in the frame of the receiver's normal, lengths scaled to about 1
    vec3 edgeU;
    vec3 edgeV;
    vec3 plane;   // unit normal of the light
    float height; // of the receiver above the light's plane
    bool triangle;
    bool central;              // the zenith is on the light, perhaps as a vertex, which is then left out
    uint vertices;             // 0: nothing is visible
    vec2 uv[kOutlineVertices]; // if central in the sense of growing azimuths
    uint sectors;
    uvec4 sector
        [kOutlineSectors]; // vertices at which it begins and ends, and with which the edges that bound it begin: one
                           // in the order of uv, and another one against it, if the zenith does not bound them
};

RT_FN float cross2(vec2 a, vec2 b) {
    return a.x * b.y - a.y * b.x;
}
RT_FN vec2 horizontal(vec3 v) {
    return vec2(v.x, v.y);
}
RT_FN vec3 inFrame(RT_IN(Frame) f, vec3 v) {
    return vec3(dot(v, f.tangent), dot(v, f.bitangent), dot(v, f.normal));
}
RT_FN vec3 outlinePoint(RT_IN(ProjectedOutline) outline, vec2 uv) {
    return outline.corner + outline.edgeU * uv.x + outline.edgeV * uv.y;
}
RT_FN uint nextVertex(RT_IN(ProjectedOutline) outline, uint i) {
    return i + 1u < outline.vertices ? i + 1u : 0u;
}
RT_FN uint previousVertex(RT_IN(ProjectedOutline) outline, uint i) {
    return i > 0u ? i - 1u : outline.vertices - 1u;
}

// Twice the signed area of the triangle that the horizontal projections of two vertices make with the receiver.
// Positive if the azimuth grows; exact for neighbours in a small light.
RT_FN float azimuthTurn(RT_IN(ProjectedOutline) outline, uint i, uint j) {
    vec2 a = outline.uv[i];
    vec2 b = outline.uv[j];
    vec2 edge = horizontal(outline.edgeU * (b.x - a.x) + outline.edgeV * (b.y - a.y));
    return cross2(horizontal(outlinePoint(outline, a)), edge);
}

// ---- outline -------------------------------------------------------------------------------------------------------

RT_FN void clipToHorizon(RT_INOUT(ProjectedOutline) outline) {
    vec2 whole[4];
    whole[0] = vec2(0.0f, 0.0f);
    whole[1] = vec2(1.0f, 0.0f);
    whole[2] = outline.triangle ? vec2(0.0f, 1.0f) : vec2(1.0f, 1.0f);
    whole[3] = vec2(0.0f, 1.0f);
    uint n = outline.triangle ? 3u : 4u;
    outline.vertices = 0u;
    for (uint i = 0u; i < n; i++) {
        vec2 a = whole[i];
        vec2 b = whole[i + 1u < n ? i + 1u : 0u];
        float za = outlinePoint(outline, a).z;
        float zb = outlinePoint(outline, b).z;
        if (za >= 0.0f) outline.uv[outline.vertices++] = a;
        if ((za >= 0.0f) != (zb >= 0.0f))
            outline.uv[outline.vertices++] = a + (b - a) * clamp(za / (za - zb), 0.0f, 1.0f);
    }
}

RT_FN bool isZenith(RT_IN(ProjectedOutline) outline, uint i) {
    vec2 p = horizontal(outlinePoint(outline, outline.uv[i]));
    return dot(p, p) <= 1.0e-13f;
}

// Leaves out vertices at the zenith, which have no azimuth; the outline then begins behind them.
RT_FN void removeZenith(RT_INOUT(ProjectedOutline) outline) {
    uint at = outline.vertices;
    for (uint i = 0u; i < outline.vertices; i++)
        if (isZenith(outline, i) && !isZenith(outline, nextVertex(outline, i))) at = i;
    if (at == outline.vertices) return;
    vec2 rest[kOutlineVertices];
    uint n = 0u;
    for (uint i = 1u; i < outline.vertices; i++) {
        uint k = (at + i) % outline.vertices;
        if (!isZenith(outline, k)) rest[n++] = outline.uv[k];
    }
    for (uint i = 0u; i < n; i++) outline.uv[i] = rest[i];
    outline.vertices = n;
    outline.central = true;
}

// Sectors around the zenith, one an edge; `edges` is one less than vertices if the zenith is one of them.
RT_FN void addCentralSectors(RT_INOUT(ProjectedOutline) outline, uint edges, bool reversed) {
    for (uint i = 0u; reversed && i < outline.vertices / 2u; i++) {
        vec2 other = outline.uv[outline.vertices - 1u - i];
        outline.uv[outline.vertices - 1u - i] = outline.uv[i];
        outline.uv[i] = other;
    }
    outline.sectors = edges;
    for (uint i = 0u; i < edges; i++) outline.sector[i] = uvec4(i, nextVertex(outline, i), i, i);
}

// Sectors between two chains of edges that lead from the vertex of the first azimuth to that of the last one: each ends
// at the next vertex of either chain.
RT_FN void addSectors(RT_INOUT(ProjectedOutline) outline, uint first, uint last) {
    uint a = first;
    uint b = first;
    uint from = first;
    for (uint n = 0u; n < outline.vertices && from != last; n++) {
        uint nextA = nextVertex(outline, a);
        uint nextB = previousVertex(outline, b);
        bool byA = nextA != last && (nextB == last || azimuthTurn(outline, nextA, nextB) > 0.0f);
        uint to = byA ? nextA : nextB;
        outline.sector[outline.sectors++] = uvec4(from, to, a, b);
        from = to;
        if (byA) {
            a = nextA;
        } else {
            b = nextB;
        }
    }
}

// Sorts the vertices by azimuth.
RT_FN void findSectors(RT_INOUT(ProjectedOutline) outline) {
    bool isOpen = outline.central; // at a vertex at the zenith, which was left out
    uint edges = isOpen ? outline.vertices - 1u : outline.vertices;
    uint onwards = 0u;
    uint first = 0u;
    uint last = 0u;
    bool before = azimuthTurn(outline, outline.vertices - 1u, 0u) > 0.0f;
    for (uint i = 0u; i < edges; i++) {
        bool onward = azimuthTurn(outline, i, nextVertex(outline, i)) > 0.0f;
        onwards += onward ? 1u : 0u;
        if (onward && !before) first = i;
        if (!onward && before) last = i;
        before = onward;
    }
    outline.central = isOpen || onwards == 0u || onwards == edges;
    if (outline.central) {
        addCentralSectors(outline, edges, 2u * onwards < edges);
    } else {
        addSectors(outline, first, last);
    }
}

// `corner` relative to the receiver, edges of the light (a triangle is half of the parallelogram), unit normals of the
// light's plane and of the receiver.
RT_FN ProjectedOutline makeProjectedOutline(vec3 corner, vec3 edgeU, vec3 edgeV, vec3 plane, bool triangle,
                                            vec3 normal) {
    ProjectedOutline outline;
    Frame f = makeFrame(normal);
    float scale = 1.0f / (length(corner) + length(edgeU) + length(edgeV));
    corner = corner * scale;
    edgeU = edgeU * scale;
    edgeV = edgeV * scale;
    outline.corner = inFrame(f, corner);
    outline.edgeU = inFrame(f, edgeU);
    outline.edgeV = inFrame(f, edgeV);
    outline.plane = inFrame(f, plane);
    outline.height = abs(dot(corner, plane));
    outline.triangle = triangle;
    outline.central = false;
    outline.sectors = 0u;
    clipToHorizon(outline);
    removeZenith(outline);
    if (outline.height > 0.0f && outline.vertices > 1u) findSectors(outline);
    return outline;
}

// ---- slices --------------------------------------------------------------------------------------------------------

// Slices between two vertices.
struct OutlineSector {
    vec2 start;  // azimuth at which it begins, unit
    vec2 uv;     // the vertex there
    float reach; // its horizontal distance
    float z;     // its height
    float angle; // between the azimuths
    vec4 edgeA;  // (u, v) of both ends, relative to the vertex, of an edge that bounds all of these slices
    vec4 edgeB;  // and of another one, if the zenith does not bound them
};

// The part of a slice that is on the light.
struct OutlineSlice {
    vec2 uv;     // of the lower end
    vec2 uvSpan; // to the upper end
    vec2 p;      // horizontal distance and height of the lower end
    vec2 span;   // to the upper end
    float rise; // difference of the squared sines of both ends' elevations: twice the projected solid angle per azimuth
};

RT_FN OutlineSector outlineSector(RT_IN(ProjectedOutline) outline, uint i) {
    uvec4 vertex = outline.sector[i];
    OutlineSector s;
    s.uv = outline.uv[vertex.x];
    vec3 start = outlinePoint(outline, s.uv);
    vec2 p = horizontal(start);
    vec2 q = horizontal(outlinePoint(outline, outline.uv[vertex.y]));
    s.reach = length(p);
    s.start = p * (1.0f / s.reach);
    s.z = max(start.z, 0.0f);
    s.angle = max(arcTan(azimuthTurn(outline, vertex.x, vertex.y), dot(p, q)), 0.0f);
    s.edgeA = vec4(outline.uv[vertex.z] - s.uv, outline.uv[nextVertex(outline, vertex.z)] - s.uv);
    s.edgeB = vec4(outline.uv[vertex.w] - s.uv, outline.uv[previousVertex(outline, vertex.w)] - s.uv);
    return s;
}

// Where an edge meets the line dot(off, across) = level.
RT_FN vec2 sliceEnd(vec4 edge, vec2 across, float level) {
    vec2 a = vec2(edge.x, edge.y);
    vec2 b = vec2(edge.z, edge.w);
    float beyondA = dot(across, a) - level;
    float beyondB = dot(across, b) - level;
    float whole = beyondA - beyondB;
    return a + (b - a) * clamp(beyondA / (whole != 0.0f ? whole : 1.0f), 0.0f, 1.0f);
}

// The slice at the sine and cosine of the angle from the beginning of the sector.
RT_FN OutlineSlice outlineSlice(RT_IN(ProjectedOutline) outline, RT_IN(OutlineSector) sector, vec2 turn) {
    vec2 d = vec2(sector.start.x * turn.y - sector.start.y * turn.x, sector.start.x * turn.x + sector.start.y * turn.y);
    OutlineSlice slice;
    slice.rise = 0.0f;
    // (u, v) relative to the sector's vertex, which keeps the digits of small lights.
    vec2 across = vec2(cross2(d, horizontal(outline.edgeU)), cross2(d, horizontal(outline.edgeV)));
    vec2 onward = vec2(dot(d, horizontal(outline.edgeU)), dot(d, horizontal(outline.edgeV)));
    vec2 upward = vec2(outline.edgeU.z, outline.edgeV.z);
    float begin = sector.reach * turn.y;
    vec2 from = sliceEnd(sector.edgeA, across, sector.reach * turn.x);
    vec2 a = vec2(max(begin + dot(onward, from), 0.0f), max(sector.z + dot(upward, from), 0.0f));
    vec2 to = sliceEnd(sector.edgeB, across, sector.reach * turn.x);
    if (outline.central) {
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
    // Twice the triangle between the receiver and the slice is the slice's length times the distance of its line. That
    // is the height above the light's plane over the sine of the angle between plane and slice, which is small where a
    // light is seen edge-on, upright. The sine of the angle between both ends times that of their sum is the difference
    // of squares.
    float along = outline.plane.x * d.x + outline.plane.y * d.y;
    float sine2 = outline.plane.z * outline.plane.z + along * along;
    if (!(sine2 > 0.0f)) return slice;
    vec3 chord = outline.edgeU * slice.uvSpan.x + outline.edgeV * slice.uvSpan.y;
    slice.rise = outline.height * sqrt(dot(chord, chord) / sine2) * (a.x * b.y + a.y * b.x) /
                 max(dot(a, a) * dot(b, b), 1.0e-37f);
    return slice;
}

RT_SHARED_END

#endif
