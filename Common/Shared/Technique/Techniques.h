// Where techniques take part in the path of PathStep.h, which knows none of them. Each hook asks which are on; those that
// are off cost nothing (Methods.h). A technique is a file or a folder beside this one, a row of RT_METHODS, its state in
// PathState and TechniqueStep, and its lines in the hooks that it needs:
//
//   beginTechniques          a path begins
//   techniqueEmissionShare   its ray has hit a surface that may emit: how much of it is left to the path
//   techniqueSkyShare        likewise, of the sky that it has left for
//   goOnInMedium, goOnAtSurface   a vertex has been reached; false ends the path there
//   leavesLight              next-event estimation at the vertex is left to a technique
//   techniquesAtLight        next-event estimation has been done
//   techniquesAtScattering   a direction has been sampled, which a technique may replace
//   techniqueRoulette        the path is to go on
//
// What pixels share is dealt with behind their paths, by each engine: SharedPaths.h, PathReuse.glsl.
#ifndef RT_SHARED_TECHNIQUES_H
#define RT_SHARED_TECHNIQUES_H
#include "Common/Shared/Technique/AimedScattering.h"
#include "Common/Shared/Technique/EdgeRayPaths.h"
#include "Common/Shared/Technique/PathReuse.h"
#include "Common/Shared/Technique/SpecularConnection/ConnectionChain.h"

RT_SHARED_BEGIN

RT_FN void beginTechniques(RT_INOUT(PathState) s) {
    s.chain.from = vec3(0.0f, 0.0f, 0.0f);
    s.chain.pdf = 0.0f;
    s.chain.rate = 0.0f;
    s.chain.sphere = kNone;
    s.chain.met = kNone;
    s.chain.state = kChainNone;
    s.reuse = kReuseBefore;
    s.emission = kEmissionWeighed;
}

RT_FN TechniqueStep beginTechniqueStep() {
    TechniqueStep step;
    step.part = nothingShared();
    step.connection = noConnection();
    return step;
}

RT_FN float techniqueEmissionShare(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Hit) hit,
                                   RT_IN(Surface) surface, RT_INOUT(PathState) s) {
    float share = isCountedApart(features, s) ? 0.0f : 1.0f;
    if (has(features, kMethodConnections)) {
        followChain(scene, params, hit, s);
        if (s.chain.state >= kChainBeyond && surface.light != kNone) {
            share *= connectionWeight(features, scene, params, s, surface.light, surface.position, surface.normal);
        }
    }
    return share;
}

RT_FN float techniqueSkyShare(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(PathState) s) {
    float share = isCountedApart(features, s) ? 0.0f : 1.0f;
    if (has(features, kMethodConnections) && has(features, kFeatureSkyImage) && s.chain.state >= kChainBeyond) {
        uint sky = loadGlobals(scene).skyLight;
        if (sky != kNone) share *= connectionWeight(features, scene, params, s, sky, vec3(0.0f), vec3(0.0f));
    }
    return share;
}

RT_FN bool goOnInMedium(Features features, RT_IN(PathState) s) {
    return !isEdgeRay(features, s);
}

RT_FN bool goOnAtSurface(Features features, RT_IN(RenderParams) params, RT_IN(Surface) surface, RT_IN(Vertex) v,
                         RT_INOUT(PathState) s, RT_INOUT(TechniqueStep) step) {
    if (endsEdgeRay(features, params, v, s)) return false;
    if (reusesPaths(features, params)) followReuse(features, surface, v, s, step.part.prefix);
    return true;
}

RT_FN bool leavesLight(Features features, RT_IN(RenderParams) params, RT_IN(Vertex) v, RT_IN(PathState) s) {
    return leavesGlossyHit(features, params, v, s);
}

RT_FN void techniquesAtLight(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Sampler) smp,
                             RT_IN(Vertex) v, RT_IN(VertexSamples) u, RT_INOUT(PathState) s,
                             RT_INOUT(TechniqueStep) step) {
    if (has(features, kMethodConnections)) step.connection = connectLight(features, scene, params, smp, v, u, s);
}

// `b` is what v has sampled; `s` the path that has not gone on yet.
RT_FN void techniquesAtScattering(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Vertex) v,
                                  RT_IN(VertexSamples) u, RT_INOUT(BsdfSample) b, RT_INOUT(PathState) s,
                                  RT_INOUT(TechniqueStep) step) {
    if (aimsPaths(features, params) && s.reuse == kReuseFirst) {
        RT_IN(AimedSphere) sphere = loadGlobals(scene).aimed;
        step.part.throughput = s.throughput * b.weight;
        step.part.aimed = aimedShare(sphere, v.origin, s.last.total);
        if (step.part.aimed > 0.0f) b = aimScattering(sphere, v, u.bsdf, u.roulette.y, step.part.aimed, b);
    }
    if (has(features, kMethodConnections)) continueChain(v, b, s);
}

// What Russian roulette may do to a path that goes on, by chance: `odds` multiplies the probability that it survives.
struct Roulette {
    bool mayEnd;
    float odds;
};

//                         mayEnd                                                   odds
//   plain                 yes                                                      1
//   at its first vertex,  no: what is shared was drawn with the density of         -
//   which is shared         scattering and no other
//   aimed through glass   no: it weighs little, but the light is just behind       -
//   behind the second     yes                                                      kReuseSurvival
//   edge ray              no, where it samples a glossy mirror's light             its weight is one of many: edgeRays
RT_FN Roulette techniqueRoulette(Features features, RT_IN(RenderParams) params, RT_IN(Vertex) v, RT_IN(BsdfSample) b,
                                 RT_INOUT(PathState) s) {
    Roulette roulette;
    roulette.mayEnd = true;
    roulette.odds = 1.0f;
    if (reusesPaths(features, params)) {
        if (s.reuse == kReuseFirst) roulette.mayEnd = false;
        if (s.reuse == kReuseSuffix) roulette.odds = kReuseSurvival;
        if (aimsPaths(features, params) && s.reuse == kReuseEnded && b.delta != 0u) roulette.mayEnd = false;
    }
    if (has(features, kMethodEdgeRays)) {
        bool isSplit = isEdgeRay(features, s) && splitsGlossyHit(features, params, v);
        s.emission = emissionBehind(features, params, v, s);
        if (isSplit) {
            roulette.mayEnd = false;
            s.vertex = params.maxDepth - 1u; // it ends at the next one
        }
        if (isEdgeRay(features, s)) roulette.odds = float(params.edgeRays);
    }
    return roulette;
}

RT_SHARED_END

#endif
