// Traces rays through the acceleration structure. Of a ray generation shader.
#include "RayTracing.glsl"

layout(set = 0, binding = 0) uniform accelerationStructureEXT topLevel;

// See PathLoop.glsl: lanes with a shadow ray do not hold up those without, and little is kept across a trace.
const uint kRaysPerStep = 1u;
bool tracesApart() { return false; }

layout(location = 0) rayPayloadEXT HitPayload hitPayload;

float rayTMin(Ray ray) {
    return has(kFeatures, kFeatureMovingSpheres) ? ray.time * kTimeToTMin : 0.0f;
}

// What the ray meets in (0, tMax): the nearest, or when `anyHit` the first that is found, and then only the sign of t
// tells anything. A negative t if there is nothing.
Hit traceRay(Ray ray, bool anyHit, float tMax) {
    uint flags = gl_RayFlagsOpaqueEXT;
    if (anyHit) flags |= gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT;
    hitPayload.t = 0.0f;
    traceRayEXT(topLevel, flags, 0xffu, 0u, 1u, 0u, ray.origin, rayTMin(ray), ray.direction, tMax, 0);
    Hit hit;
    hit.t = hitPayload.t;
    hit.kind = hitPayload.kind;
    hit.primitive = hitPayload.primitive;
    hit.instance = hitPayload.instance;
    hit.u = hitPayload.uv.x;
    hit.v = hitPayload.uv.y;
    return hit;
}
