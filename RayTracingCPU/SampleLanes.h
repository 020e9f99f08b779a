// Sample dimensions of sixteen samples at a time. Included by one translation unit per instruction set; all it defines
// has internal linkage.
#pragma once
#include "RayTracingCPU/PathLanes.h"

namespace rt::cpu {
namespace {

using namespace rt::shared;

// Draws dimension `dimensions` of each sample. The samplers are of one kind.
RT_CALL void drawDimension(const RecordLanes<Sampler>& samplers, const UintLanes& dimensions, Vec2Lanes& u) {
    if (lanesOf<&Sampler::kind>(samplers).at[0] != kSamplerSobol) {
        for (uint i = 0u; i < kLanes; ++i) set(u, i, sample2D(get(samplers, i), dimensions.at[i]));
        return;
    }
    for (uint i = 0u; i < kLanes; ++i) {
        const Sampler s = get(samplers, i);
        set(u, i, toUniform2(sobolSample(s.key, s.base + s.index, dimensions.at[i])));
    }
}

// cameraSamples() of each sample; what the features do not use stays as it is.
RT_FN void drawCameraSamples(Features features, const RecordLanes<Sampler>& samplers, RecordLanes<CameraSamples>& u) {
    const auto draw = [&](uint dimension, Vec2Lanes& lanes) {
        if (!cameraUses(features, dimension)) return;
        UintLanes dimensions;
        for (uint i = 0u; i < kLanes; ++i) dimensions.at[i] = dimension;
        drawDimension(samplers, dimensions, lanes);
    };
    draw(kDimensionPixel, lanesOf<&CameraSamples::pixel>(u));
    draw(kDimensionLens, lanesOf<&CameraSamples::lens>(u));
    draw(kDimensionTime, lanesOf<&CameraSamples::time>(u));
}

// vertexSamples() of each path; those for lights only where some path samples one.
template <Features kFeatures>
RT_FN void drawVertexSamples(bool samplesLights, PathLanes& lanes) {
    const auto draw = [&](uint dimension, Vec2Lanes& u) {
        if (!vertexUses(kFeatures, dimension)) return;
        UintLanes dimensions;
        for (uint i = 0u; i < kLanes; ++i) {
            dimensions.at[i] = vertexDimension(lanesOf<&Vertex::index>(lanes.vertices).at[i], dimension);
        }
        drawDimension(lanes.samplers, dimensions, u);
    };
    draw(kDimensionBsdf, lanesOf<&VertexSamples::bsdf>(lanes.u));
    draw(kDimensionRoulette, lanesOf<&VertexSamples::roulette>(lanes.u));
    if (!samplesLights) return;
    draw(kDimensionLight, lanesOf<&VertexSamples::light>(lanes.u));
    draw(kDimensionSelection, lanesOf<&VertexSamples::selection>(lanes.u));
}

} // namespace
} // namespace rt::cpu
