// The colour of what a pixel's ray meets first. Surfaces are those of the ray tracer: the same formulas find position,
// normal, texture and material.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "Preview.glsl"

layout(location = 0) in vec2 weights;
layout(location = 1) flat in uvec2 place;
layout(location = 0) out vec4 color; // radiance, distance

// The ray's parameter where it meets the sphere, disk or cylinder; negative: nowhere.
float shapeDistance(SceneRef scene, Ray ray) {
    Ray local = ray;
    if (has(kFeatures, kFeatureInstances) && place.y != kNone) {
        Instance instance = loadInstance(scene, place.y);
        local.origin = transformPoint(instance.toObject[0], instance.toObject[1], instance.toObject[2], ray.origin);
        local.direction = transformVector(instance.toObject[0], instance.toObject[1], instance.toObject[2], ray.direction);
    }
    if (kShape == kRound) {
        Round r = loadRound(scene, place.x);
        return intersectRound(local, r.origin, roundFrame(r.edgeU, r.edgeV, r.axis), r.hole, kInfinity);
    }
    Sphere sphere = loadSphere(scene, place.x);
    return intersectSphere(local, sphere.center, sphere.radius, kInfinity);
}

// What scatters diffusely as it is; all else half as if it did, half as a mirror of the sky.
vec3 surfaceRadiance(SceneRef scene, Surface surface, vec3 wo) {
    Material material = loadMaterial(scene, surface.material);
    bool isFront = dot(wo, surface.normal) > 0.0f;
    vec3 normal = isFront ? surface.shading : -surface.shading;
    vec3 radiance = vec3(0.0f);
    if (has(kFeatures, kFeatureEmissive) && (isFront || material.emissionSides == kSidesBoth)) {
        radiance = surfaceEmission(kFeatures, scene, material, surface);
    }
    if (material.kind == kMaterialEmitter) return radiance;
    vec3 albedo = surfaceAlbedo(kFeatures, scene, material, surface);
    vec3 incident = incidentLight(scene, surface.position, normal, wo);
    if (!scattersDiffusely(kFeatures, makeBsdf(material, albedo))) {
        incident = 0.5f * (incident + skyRadiance(kFeatures, scene, reflect(-wo, normal)));
    }
    return radiance + albedo * incident;
}

// Of what is partly there the preview draws what is mostly there.
bool isClear(SceneRef scene, Surface surface) {
    if (!isPrincipled(kFeatures, loadMaterial(scene, surface.material))) return false;
    return surfaceOpacity(kFeatures, scene, loadPrincipled(scene, surface.material), surface) < 0.5f;
}

void main() {
    SceneRef scene;
    scene.unused = 0u;
    // The place of the sample where single ones are shaded, else the pixel's middle.
    Ray ray = previewRay(gl_FragCoord.xy + vec2(0.0f, float(launch.firstRow)));
    Hit hit;
    hit.t = 0.0f;
    hit.kind = kShape;
    hit.primitive = place.x;
    hit.instance = place.y;
    hit.u = weights.x;
    hit.v = weights.y;
    bool isInBox = kShape == kSphere || kShape == kRound;
    if (isInBox) {
        hit.t = shapeDistance(scene, ray);
        if (hit.t < 0.0f) discard;
    }
    Surface surface = makeSurface(kFeatures, scene, ray, hit);
    if (has(kFeatures, kFeatureOpacity) && isClear(scene, surface)) discard;
    float t = isInBox ? hit.t : dot(surface.position - ray.origin, ray.direction);
    gl_FragDepth = launch.near / dot(launch.clipW, vec4(ray.origin + t * ray.direction, 1.0f));
    color = vec4(surfaceRadiance(scene, surface, -ray.direction), t);
}
