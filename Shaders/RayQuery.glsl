// Traces rays through the acceleration structure by ray queries. Of compute shaders.
#extension GL_EXT_ray_query : require
#include "Instances.glsl"

layout(set = 0, binding = 0) uniform accelerationStructureEXT topLevel;

// See PathLoop.glsl: all lanes of a group shade at a time, then all trace, in one place of the program where there are
// two rays.
const uint kRaysPerStep = 2u;
bool tracesApart() { return !has(kFeatures, kFeatureLights); }

uint hitRecord(rayQueryEXT query) {
    return rayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetEXT(query, true) +
           uint(rayQueryGetIntersectionGeometryIndexEXT(query, true));
}

// Tests the sphere, disk or cylinder in whose box the query has stopped. All else that is there is opaque triangles.
void testCandidate(rayQueryEXT query, Ray ray, float tMax) {
    uint instance = instanceOf(uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, false)));
    Geometry geometry = geometryOf(instance);
    uint place = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
    float nearest = tMax;
    if (rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT) {
        nearest = rayQueryGetIntersectionTEXT(query, true);
    }
    bool isRound = has(kFeatures, kRoundFeatures) &&
                   rayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetEXT(query, false) == kHitRecordRound;
    float t = 0.0f;
    if (isRound) {
        t = roundHit(ray, instance, geometry.firstRound + place, nearest);
    } else if (has(kFeatures, kFeatureSpheres)) {
        t = sphereHit(ray, instance, geometry.firstSphere + place, nearest);
    }
    if (t > 0.0f) rayQueryGenerateIntersectionEXT(query, t);
}

// What the ray meets in (0, tMax): the nearest, or when `anyHit` the first that is found, and then only the sign of t
// tells anything. A negative t if there is nothing.
Hit traceRay(Ray ray, bool anyHit, float tMax) {
    uint flags = gl_RayFlagsOpaqueEXT;
    if (anyHit) flags |= gl_RayFlagsTerminateOnFirstHitEXT;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, topLevel, flags, 0xffu, ray.origin, 0.0f, ray.direction, tMax);
    while (rayQueryProceedEXT(query)) {
        if (has(kFeatures, kFeatureSpheres | kRoundFeatures)) testCandidate(query, ray, tMax);
    }
    Hit hit;
    hit.t = -1.0f;
    hit.kind = kSphere;
    hit.primitive = kNone;
    hit.instance = kNone;
    hit.u = 0.0f;
    hit.v = 0.0f;
    uint type = rayQueryGetIntersectionTypeEXT(query, true);
    if (type == gl_RayQueryCommittedIntersectionNoneEXT) return hit;
    hit.t = rayQueryGetIntersectionTEXT(query, true);
    hit.instance = instanceOf(uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true)));
    Geometry geometry = geometryOf(hit.instance);
    uint primitive = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
    if (type == gl_RayQueryCommittedIntersectionGeneratedEXT) {
        bool isRound = has(kFeatures, kRoundFeatures) && hitRecord(query) == kHitRecordRound;
        hit.kind = isRound ? kRound : kSphere;
        hit.primitive = (isRound ? geometry.firstRound : geometry.firstSphere) + primitive;
        return hit;
    }
    vec2 weights = rayQueryGetIntersectionBarycentricsEXT(query, true);
    bool isQuad = has(kFeatures, kFeatureQuads) && hitRecord(query) == kHitRecordQuad;
    vec2 uv = isQuad ? quadUv(primitive, weights) : weights;
    hit.kind = isQuad ? kQuad : kTriangle;
    hit.primitive = isQuad ? geometry.firstQuad + primitive / 2u : geometry.firstTriangle + primitive;
    hit.u = uv.x;
    hit.v = uv.y;
    return hit;
}
