// Which light a vertex connects to, and by way of which smooth sphere: in proportion to an estimate of the irradiance
// that it brings, and with a probability that says how much that can matter.
#ifndef RT_SHARED_CONNECTION_CHOICE_H
#define RT_SHARED_CONNECTION_CHOICE_H
#include "Common/Shared/Path/Vertex.h"
#include "Common/Shared/Shape/SphericalShapes.h"

RT_SHARED_BEGIN

// A sphere as a point sees it.
struct SphereView {
    vec3 center;
    vec3 along; // unit, to the centre
    float near; // radius over distance
    vec2 reach; // of SpecularCaster
    bool isNear;
};

// All but the reach.
RT_FN SphereView seeSphere(RT_IN(SpecularCaster) sphere, vec3 x, float time) {
    SphereView view;
    view.center = sphere.center + sphere.motion * time;
    vec3 toCenter = view.center - x;
    float inverse = 1.0f / sqrt(max(dot(toCenter, toCenter), 1.0e-30f));
    view.along = toCenter * inverse;
    view.near = sphere.radius * inverse;
    view.isNear = view.near > sphere.nearest && view.near < kNearestToSphere;
    view.reach = vec2(0.0f);
    return view;
}

RT_FN vec2 reachAt(RT_IN(SpecularCaster) sphere, float near) {
    return sphere.reach[uint(min(near * float(kReachSteps), float(kReachSteps - 1u)))];
}

RT_FN SphereView viewSphere(RT_IN(SpecularCaster) sphere, vec3 x, float time) {
    SphereView view = seeSphere(sphere, x, time);
    view.reach = reachAt(sphere, view.near);
    return view;
}

// What the choice of a light by way of the sphere is proportional to: an estimate of the irradiance that it brings.
RT_FN float reachWeight(RT_IN(CasterLight) light, RT_IN(SphereView) view) {
    float sine = sqrt(max((1.0f - view.reach.x) * (1.0f + view.reach.x), 0.0f));
    float limit = view.reach.x * light.extent.x - sine * light.extent.y;
    return view.isNear && dot(light.axis, view.along) > limit ? light.weight * view.reach.y : 0.0f;
}

// Sum of the weights of all lights by way of one sphere.
RT_FN float sphereWeight(SceneRef scene, RT_IN(SpecularCaster) sphere, RT_IN(SphereView) view) {
    float sum = 0.0f;
    for (uint i = 0u; i < sphere.lightCount; i++) {
        sum += reachWeight(loadCasterLight(scene, sphere.firstLight + i), view);
    }
    return sum;
}

RT_FN float totalWeight(SceneRef scene, RT_IN(RenderParams) params, vec3 x, float time) {
    float sum = 0.0f;
    for (uint k = 0u; k < params.connectedSpheres; k++) {
        RT_IN(SpecularCaster) sphere = loadSpecularCaster(scene, k);
        SphereView view = viewSphere(sphere, x, time);
        if (view.isNear) sum += sphereWeight(scene, sphere, view);
    }
    return sum;
}

// Connections leave from media and from surfaces that scatter into all directions, by one of their lobes at least.
RT_FN bool connects(Features features, RT_IN(Vertex) v) {
    return v.inMedium != 0u || hasDiffuseLobe(features, v.bsdf);
}

// Whether a path may be long enough for a connection from v: where it enters, is reflected and leaves, and the light.
RT_FN bool isInTime(RT_IN(RenderParams) params, RT_IN(SpecularCaster) sphere, RT_IN(Vertex) v) {
    return v.index + sphere.crossings + 3u <= params.maxDepth;
}

// Probability with which a connection is attempted where the lights through spheres weigh `total` and those seen
// directly contribute `direct`, by a path of this throughput: as much as it can matter. Elsewhere in the picture there
// is light of about `typical`, which noise in shadow is small beside.
const float kConnectionGain = 4.0f;

RT_FN float connectionChance(float total, float direct, float typical, vec3 throughput) {
    return min(kConnectionGain * maxComponent(throughput) * (total / (total + direct + typical)), 1.0f);
}

struct ConnectionChoice {
    uint sphere;
    uint light;
    uint skyPatch; // CasterLight::skyPatch
    float weight;  // 0: none
    float u;       // what is left of the number that chose, for further use
};

// The light at this place along the weights, less than their sum.
RT_FN ConnectionChoice chooseConnection(SceneRef scene, RT_IN(RenderParams) params, vec3 x, float time, float target) {
    ConnectionChoice choice;
    choice.sphere = 0u;
    choice.light = 0u;
    choice.skyPatch = kNone;
    choice.weight = 0.0f;
    choice.u = 0.0f;
    float left = target;
    for (uint k = 0u; k < params.connectedSpheres; k++) {
        RT_IN(SpecularCaster) sphere = loadSpecularCaster(scene, k);
        SphereView view = viewSphere(sphere, x, time);
        if (!view.isNear) continue;
        for (uint i = 0u; i < sphere.lightCount; i++) {
            RT_IN(CasterLight) reach = loadCasterLight(scene, sphere.firstLight + i);
            float weight = reachWeight(reach, view);
            if (!(weight > 0.0f)) continue;
            choice.sphere = k;
            choice.light = reach.light;
            choice.skyPatch = reach.skyPatch;
            choice.weight = weight;
            choice.u = clamp(left / weight, 0.0f, 0.999999940395355f);
            left -= weight;
            if (left < 0.0f) return choice;
        }
    }
    return choice;
}

RT_SHARED_END

#endif
