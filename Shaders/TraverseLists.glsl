// Traces rays through the lists of GpuBvh, which scenes of few primitives have in place of a tree: every primitive is
// tested, by all lanes together; and those near spheres that nearly all rays meet, which are listed beside a tree.
layout(constant_id = kListedNearSpheresId) const uint kListedNearSpheres = 0u;
layout(constant_id = kListedSpheresId) const uint kListedSpheres = 0u; // all others
const uint kAllListedSpheres = kListedNearSpheres + kListedSpheres;
layout(constant_id = kListedXQuadsId) const uint kListedXQuads = 0u; // along axes, perpendicular to x
layout(constant_id = kListedYQuadsId) const uint kListedYQuads = 0u;
layout(constant_id = kListedZQuadsId) const uint kListedZQuads = 0u;
layout(constant_id = kListedCuboidsId) const uint kListedCuboids = 0u;
layout(constant_id = kListedQuadsId) const uint kListedQuads = 0u;
layout(constant_id = kListedTrianglesId) const uint kListedTriangles = 0u;
layout(constant_id = kListedRoundsId) const uint kListedRounds = 0u;

layout(set = 0, binding = 2, scalar) uniform LinearLists { vec4 listVectors[kListVectors]; };

// Hits beyond this do not matter. When any will do there is no order to keep: tests do not wait for each other.
float searchEnd(Nearest nearest, bool anyHit, float tMax) {
    return anyHit ? tMax : nearest.t;
}

// Marks the place of a rectangle, whose u and v are not known yet.
const uint kOnRectangle = 0x80000000u;

// The quads perpendicular to an axis, from a vector of the lists on.
void traceAxisQuads(TracedRay r, uint axis, uint first, uint count, bool anyHit, float tMax, inout Nearest nearest) {
    vec3 origin = axisLast(r.ray.origin, axis);
    vec3 direction = axisLast(r.ray.direction, axis);
    float inverse = 1.0f / direction.z;
    for (uint at = first; at < first + 2u * count; at += 2u) {
        vec4 center = listVectors[at];
        vec2 halfExtent = listVectors[at + 1u].xy;
        vec3 toCenter = axisLast(center.xyz, axis) - origin;
        float end = searchEnd(nearest, anyHit, tMax);
        float t = intersectAxisQuad(toCenter, halfExtent, direction, inverse, r.rayLength, end);
        if (t > 0.0f) {
            nearest.t = t;
            nearest.place = floatBitsToUint(center.w) | kOnRectangle;
        }
    }
}

// The face, one of a cuboid's six; kNoFace: it has none there.
uint listedFace(vec4 center, vec4 alongX, uint face) {
    uint faces = floatBitsToUint(face < 3u ? center.w : alongX.w);
    return faces >> (face < 3u ? 8u * face : 8u * face - 24u) & 255u;
}

// The cuboid that begins with this vector of the lists.
void traceCuboid(TracedRay r, uint at, bool anyHit, float tMax, inout Nearest nearest) {
    vec4 center = listVectors[at];
    vec4 alongX = listVectors[at + 1u];
    vec3 alongY = listVectors[at + 2u].xyz;
    vec3 alongZ = listVectors[at + 3u].xyz;
    vec3 f = center.xyz - r.ray.origin;
    vec3 d = r.ray.direction;
    CuboidHit hit = intersectCuboid(vec3(dot(alongX.xyz, f), dot(alongY, f), dot(alongZ, f)),
                                    vec3(dot(alongX.xyz, d), dot(alongY, d), dot(alongZ, d)));
    if (!(hit.enter <= hit.leave)) return;
    uint face = listedFace(center, alongX, hit.enterFace);
    float t = hit.enter;
    if (!(t > 0.0f) || face == kNoFace) {
        face = listedFace(center, alongX, hit.leaveFace);
        t = hit.leave;
    }
    if (t > 0.0f && t < searchEnd(nearest, anyHit, tMax) && face != kNoFace) {
        nearest.t = t;
        nearest.place = face | kOnRectangle;
    }
}

// To follow: where a rectangle was hit, if it was.
void placeOnRectangle(Ray ray, inout Nearest nearest) {
    if (nearest.place == kNone || (nearest.place & kOnRectangle) == 0u) return;
    nearest.kind = kQuad;
    nearest.place &= ~kOnRectangle;
    Quad quad = constants.arrays.quads.at[nearest.place];
    vec2 uv = rectanglePlace(ray, nearest.t, quad.corner, quad.edgeU, quad.edgeV);
    nearest.u = uv.x;
    nearest.v = uv.y;
}

void traceListedNearSpheres(TracedRay r, bool anyHit, float tMax, inout Nearest nearest) {
    // Never so, but the block's address is known to all invocations before the loops by this. Mesa 25.2 on processors
    // goes once more through a loop that all have left, and loads from an address first met in a loop, which is null
    // for who was not in it.
    if (isnan(listVectors[0].x)) nearest.t = 0.0f;
    for (uint i = 0u; i < kListedNearSpheres; i++) {
        uint index = floatBitsToUint(listVectors[2u * i + 1u].w);
        float t = testNearSphere(r, listVectors[2u * i], index, searchEnd(nearest, anyHit, tMax));
        acceptSphere(nearest, t, index);
    }
}

Hit traceLinear(Ray ray, bool anyHit, float tMax) {
    TracedRay r = makeTracedRay(ray, true);
    Nearest nearest = nothingWithin(tMax);
    traceListedNearSpheres(r, anyHit, tMax, nearest);
    if (has(kFeatures, kFeatureSpheres)) {
        for (uint i = kListedNearSpheres; i < kAllListedSpheres; i++) {
            vec4 motion = listVectors[2u * i + 1u];
            float t = testSphere(r, listVectors[2u * i], motion.xyz, searchEnd(nearest, anyHit, tMax));
            acceptSphere(nearest, t, floatBitsToUint(motion.w));
        }
    }
    uint first = 2u * kAllListedSpheres;
    if (has(kFeatures, kFeatureQuads)) {
        traceAxisQuads(r, 0u, first, kListedXQuads, anyHit, tMax, nearest);
        first += 2u * kListedXQuads;
        traceAxisQuads(r, 1u, first, kListedYQuads, anyHit, tMax, nearest);
        first += 2u * kListedYQuads;
        traceAxisQuads(r, 2u, first, kListedZQuads, anyHit, tMax, nearest);
        first += 2u * kListedZQuads;
        for (uint i = 0u; i < kListedCuboids; i++) traceCuboid(r, first + 4u * i, anyHit, tMax, nearest);
        first += 4u * kListedCuboids;
        if (!anyHit) placeOnRectangle(ray, nearest);
        for (uint i = 0u; i < kListedQuads; i++) {
            uint at = first + 4u * i;
            vec4 normal = listVectors[at + 1u];
            ShapeHit hit = testQuad(r, listVectors[at], normal, listVectors[at + 2u], listVectors[at + 3u], nearest.t);
            accept(nearest, hit, kQuad, floatBitsToUint(normal.w));
        }
    }
    if (has(kFeatures, kFeatureTriangles)) {
        for (uint i = 0u; i < kListedTriangles; i++) {
            uint at = first + 4u * kListedQuads + 3u * i;
            vec4 vertex = listVectors[at];
            ShapeHit hit = testTriangle(r, vertex, listVectors[at + 1u], listVectors[at + 2u], nearest.t);
            accept(nearest, hit, kTriangle, floatBitsToUint(vertex.w));
        }
    }
    if (has(kFeatures, kRoundFeatures)) {
        first += 4u * kListedQuads + 3u * kListedTriangles;
        for (uint i = 0u; i < kListedRounds; i++) {
            uint at = first + 4u * i;
            vec4 dualU = listVectors[at + 1u];
            float t = testRound(r, listVectors[at], dualU, listVectors[at + 2u], listVectors[at + 3u], nearest.t);
            acceptRound(nearest, t, floatBitsToUint(dualU.w));
        }
    }
    Hit hit;
    hit.t = nearest.place == kNone ? -1.0f : (anyHit ? 0.0f : nearest.t);
    hit.kind = nearest.kind;
    hit.primitive = nearest.place;
    hit.instance = kNone;
    hit.u = nearest.u;
    hit.v = nearest.v;
    return hit;
}
