// One ray of a path. The includer provides traceRay() and Common/Shared/Path/PathStep.h.
#include "Common/Shared/Path/Opacity.h"

// Vulkan leaves undefined what becomes of rays that are not finite or that end before they begin; a device may never
// return.
bool isTraceable(Ray ray, float tMax) {
    float squared = dot(ray.direction, ray.direction); // 1 but for rounding
    return squared > 0.5f && squared < 2.0f && dot(ray.origin, ray.origin) < 1.0e30f && tMax > 0.0f;
}

// As traceRay(), but for layers that the ray goes through; `number` as for goesThrough().
Hit traceLayers(Sampler smp, uint number, Ray ray, bool anyHit, float tMax) {
    if (!has(kFeatures, kFeatureOpacity)) return traceRay(ray, anyHit, tMax);
    SceneRef scene;
    scene.unused = 0u;
    LayeredRay r = beforeLayers(ray);
    Hit hit;
    do {
        hit = traceRay(r.ray, false, tMax - r.from);
    } while (goesThrough(kFeatures, scene, smp, number, hit, r));
    if (hit.t >= 0.0f) hit.t += r.from;
    return hit;
}

// What is found of the light at a vertex before the path goes on: segments of a connection first, then the shadow ray.
bool isChecking(DirectLight direct, TechniqueStep step) {
    return direct.distance > 0.0f || step.connection.segments != 0u;
}

// The next of them.
Ray checkedRay(PathState path, DirectLight direct, TechniqueStep step, out float tMax) {
    if (has(kFeatures, kMethodConnections) && step.connection.segments != 0u) return connectionRay(step.connection, path.ray.time, tMax);
    tMax = direct.distance;
    return shadowRay(path, direct);
}

// What becomes of its light, and of the ray.
void endChecked(SceneRef scene, Hit hit, inout PathState path, inout DirectLight direct, inout TechniqueStep step) {
    if (has(kFeatures, kMethodConnections) && step.connection.segments != 0u) {
        float tMax;
        Ray ray = connectionRay(step.connection, path.ray.time, tMax);
        endSegment(kFeatures, scene, hit.t < 0.0f, ray, tMax, step.connection, path.radiance);
        return;
    }
    if (hit.t < 0.0f) addDirectLight(kFeatures, scene, direct, path);
    direct.distance = 0.0f;
}

// What the path's next ray hits; when `checking`, whether the next ray of the light at its vertex hits anything. A ray
// that cannot be traced is counted; it ends the path, or lets no light through.
Hit traceStep(Sampler smp, PathState path, DirectLight direct, TechniqueStep step, bool checking, inout uint nonfinite) {
    Ray ray = path.ray;
    float tMax = kInfinity;
    if (checking) ray = checkedRay(path, direct, step, tMax);
    // Traced all the same, somewhere: a branch around the trace would cost all rays more.
    bool traceable = isTraceable(ray, tMax);
    if (!traceable) {
        nonfinite++;
        ray.origin = vec3(0.0f, 0.0f, 0.0f);
        ray.direction = vec3(0.0f, 0.0f, 1.0f);
        tMax = 1.0f;
    }
    Hit hit = traceLayers(smp, 2u * path.vertex + (checking ? 1u : 0u), ray, checking, tMax);
    if (!traceable) hit.t = checking ? 0.0f : -1.0f;
    return hit;
}
