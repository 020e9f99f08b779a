// The sample dimensions that a path uses: of its camera ray, and of each vertex. Those that `features` do without are
// not drawn.
#ifndef RT_SHARED_PATH_SAMPLES_H
#define RT_SHARED_PATH_SAMPLES_H
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/Random.h"

RT_SHARED_BEGIN

// Whether a camera ray uses a dimension, kDimensionPixel to kDimensionTime.
RT_FN bool cameraUses(Features features, uint dimension) {
    if (dimension == kDimensionLens) return has(features, kFeatureThinLens);
    if (dimension == kDimensionTime) return has(features, kFeatureMovingSpheres);
    return true;
}

// Whether a vertex may use a dimension, kDimensionLight to kDimensionSelection.
RT_FN bool vertexUses(Features features, uint dimension) {
    if (dimension == kDimensionLight) return has(features, kFeatureLights | kMethodMixture);
    if (dimension == kDimensionSelection) return has(features, kFeatureManyLights);
    return true;
}

struct CameraSamples {
    vec2 pixel;
    vec2 lens;
    vec2 time;
};

struct VertexSamples {
    vec2 light;
    vec2 bsdf;
    vec2 roulette;
    vec2 selection;
};

RT_FN vec2 cameraSample(Features features, RT_IN(Sampler) s, uint dimension) {
    return cameraUses(features, dimension) ? sample2D(s, dimension) : vec2(0.0f, 0.0f);
}

RT_FN CameraSamples cameraSamples(Features features, RT_IN(Sampler) s) {
    CameraSamples c;
    c.pixel = cameraSample(features, s, kDimensionPixel);
    c.lens = cameraSample(features, s, kDimensionLens);
    c.time = cameraSample(features, s, kDimensionTime);
    return c;
}

RT_FN vec2 vertexSample(Features features, RT_IN(Sampler) s, uint vertex, uint dimension) {
    return vertexUses(features, dimension) ? sample2D(s, vertexDimension(vertex, dimension)) : vec2(0.0f, 0.0f);
}

RT_FN VertexSamples vertexSamples(Features features, RT_IN(Sampler) s, uint vertex) {
    VertexSamples v;
    v.light = vertexSample(features, s, vertex, kDimensionLight);
    v.bsdf = vertexSample(features, s, vertex, kDimensionBsdf);
    v.roulette = vertexSample(features, s, vertex, kDimensionRoulette);
    v.selection = vertexSample(features, s, vertex, kDimensionSelection);
    return v;
}

RT_SHARED_END

#endif
