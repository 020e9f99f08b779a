// The side of scattering: a path that finds a light by way of a smooth sphere, as a connection from where it scattered
// might have, and the weight of what it finds there. PathState::chain carries along what that takes.
#ifndef RT_SHARED_CONNECTION_CHAIN_H
#define RT_SHARED_CONNECTION_CHAIN_H
#include "Common/Shared/Technique/SpecularConnection/Connection.h"

RT_SHARED_BEGIN

// Which of the spheres a path has hit.
RT_FN uint connectedSphere(SceneRef scene, RT_IN(RenderParams) params, RT_IN(Hit) hit) {
    if (hit.kind != kSphere) return kNone;
    for (uint k = 0u; k < params.connectedSpheres; k++) {
        RT_IN(SpecularCaster) sphere = loadSpecularCaster(scene, k);
        if (sphere.primitive == hit.primitive && sphere.instance == hit.instance) return k;
    }
    return kNone;
}

// A path arrives at a surface, or in a medium, where hit.t < 0.
RT_FN void followChain(SceneRef scene, RT_IN(RenderParams) params, RT_IN(Hit) hit, RT_INOUT(PathState) s) {
    bool isSought = s.chain.state >= kChainScattered && s.chain.state < kChainBeyond;
    s.chain.sphere = isSought ? connectedSphere(scene, params, hit) : kNone;
}

// And goes on from there.
RT_FN void continueChain(RT_IN(Vertex) v, RT_IN(BsdfSample) b, RT_INOUT(PathState) s) {
    uint state = kChainNone;
    if (b.delta == 0u) {
        if (b.transmitted == 0u && s.chain.rate > 0.0f) state = kChainScattered;
        s.chain.from = v.origin;
        s.chain.pdf = b.pdf;
    } else if (s.chain.sphere != kNone) {
        if (s.chain.state == kChainScattered && v.front != 0u) {
            state = b.transmitted != 0u ? kChainInside : kChainBeyond + kReflectedOutside;
            s.chain.met = s.chain.sphere;
        } else if (s.chain.state != kChainScattered && v.front == 0u && s.chain.met == s.chain.sphere) {
            bool isAgain = s.chain.state == kChainInsideAgain;
            if (b.transmitted != 0u)
                state = kChainBeyond + (isAgain ? kReflectedInside : kRefracted);
            else if (!isAgain)
                state = kChainInsideAgain;
        }
    }
    s.chain.state = state;
}

// The element of specularCasters for what the path's chain has met, and how; kNone: there is none.
RT_FN uint passedSphere(SceneRef scene, RT_IN(RenderParams) params, RT_IN(SpecularChain) chain) {
    RT_IN(SpecularCaster) met = loadSpecularCaster(scene, chain.met);
    uint crossings = chain.state - kChainBeyond;
    for (uint k = chain.met; k < params.connectedSpheres; k++) {
        RT_IN(SpecularCaster) sphere = loadSpecularCaster(scene, k);
        bool isMet = sphere.primitive == met.primitive && sphere.instance == met.instance;
        if (isMet && sphere.crossings == crossings) return k;
    }
    return kNone;
}

// The element of casterLights for a light by way of the sphere, for the sky that of the patch which holds this texel;
// kNone: it is not connected to.
RT_FN uint reachOf(Features features, SceneRef scene, RT_IN(SpecularCaster) sphere, uint light, uvec2 texel) {
    for (uint i = sphere.firstLight; i < sphere.firstLight + sphere.lightCount; i++) {
        RT_IN(CasterLight) reach = loadCasterLight(scene, i);
        if (reach.light != light) continue;
        if (!has(features, kFeatureSkyImage) || reach.skyPatch == kNone) return i;
        if (isInPatch(loadSkyPatch(scene, reach.skyPatch), texel)) return i;
    }
    return kNone;
}

// What the path of s hit beyond a sphere: emission of the light `index`, at this point and with this normal; or the
// sky, of which the direction is known.
struct LightMet {
    uint index;
    vec3 point;
    vec3 normal;
};

// Density over area with which a connection to `met`, where the chain scattered, would end there; 0: none would.
// Completes the point and the normal of the sky as sampleEnd() has them.
RT_FN float connectingDensity(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(PathState) s,
                              RT_IN(SpecularCaster) sphere, RT_IN(SphereView) view, RT_INOUT(LightMet) met) {
    RT_IN(SceneGlobals) globals = loadGlobals(scene);
    bool isSky = has(features, kFeatureSkyImage) && met.index == globals.skyLight;
    uvec2 texel = uvec2(0u, 0u);
    if (isSky) {
        texel = skyTexel(loadImage(scene, globals.skyImage), skyUv(toSkyImage(globals, s.ray.direction)));
        met.point = view.center + s.ray.direction * skyDistance(scene, sphere.radius);
        met.normal = -s.ray.direction;
    }
    uint i = reachOf(features, scene, sphere, met.index, texel);
    if (i == kNone) return 0.0f;
    RT_IN(CasterLight) reach = loadCasterLight(scene, i);
    float weight = reachWeight(reach, view);
    if (!(weight > 0.0f)) return 0.0f;
    float density = s.chain.rate * weight;
    vec3 toPoint = met.point - view.center;
    float distance = length(toPoint);
    if (isSky) {
        RT_IN(SkyPatch) skyPatch = loadSkyPatch(scene, reach.skyPatch);
        float pdf = skyPatchPdf(scene, loadImage(scene, globals.skyImage), skyPatch, texel);
        return density * skyEndDensity(distance, pdf);
    }
    RT_IN(Light) light = loadLight(scene, met.index);
    vec3 wi = toPoint / distance;
    float pdf = lightPdf(features, params, light, view.center, vec3(0.0f), s.ray.time, wi, distance, met.normal);
    return density * endDensity(light, view.center, wi, distance, met.normal, pdf);
}

// Weight of what the path of s hit beyond a sphere, against connections. Rarely asked for, and long.
RT_CALL float connectionWeight(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(PathState) s,
                               uint index, vec3 y, vec3 normal) {
    uint k = passedSphere(scene, params, s.chain);
    if (k == kNone) return 1.0f;
    RT_IN(SpecularCaster) sphere = loadSpecularCaster(scene, k);
    SphereView view = viewSphere(sphere, s.chain.from, s.ray.time);
    LightMet met;
    met.index = index;
    met.point = y;
    met.normal = normal;
    float density = connectingDensity(features, scene, params, s, sphere, view, met);
    ConnectionPair c = connectionPair(sphere, view, met.point);
    if (!(density > 0.0f) || !isConnectable(c)) return 1.0f;
    vec3 moment = cross(s.ray.origin - view.center, s.ray.direction);
    float sine = min(sqrt(dot(moment, moment)) / sphere.radius, 1.0f);
    Refraction r = refractionAt(c.angles, angleOfSine(sine));
    // The path turns about the moment, which the axis is along where both pass the centre on the side away from y.
    float side = sideAfter(c.angles.crossings);
    bool isOpposite = c.angles.crossings == kReflectedOutside || side * dot(moment, c.axis) > 0.0f;
    uint kind = isOpposite ? kOppositePath : r.slope < 0.0f ? kBeforePath : kBeyondPath;
    if (!hasPath(refractionRoots(c.angles, minTurn(c.angles)), kind)) return 1.0f;
    float spread = pathSpread(c.angles, r, sphere.radius, abs(dot(met.normal, s.ray.direction)));
    float scattering = s.chain.pdf * lightFraction(c.angles, r);
    return emissionWeight(params, scattering, density / max(spread, 1.0e-37f));
}

RT_SHARED_END

#endif
