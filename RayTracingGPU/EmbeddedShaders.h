// The compiled shaders, which are part of the program.
#pragma once
#include <cstdint>
#include <span>

// Each with the array that cmake/Shaders.cmake makes of it. Kernels by what they are for and how they trace: through
// the pipeline, compute shaders through our own tree, or by ray queries.
#define RT_GPU_KERNELS(X, purpose, array) \
    X(purpose##Pipeline, array##_rgen)    \
    X(purpose##Compute, array##_comp)     \
    X(purpose##Query, array##_Query_comp)

#define RT_GPU_SHADERS(X)                             \
    RT_GPU_KERNELS(X, Paths, PathTrace)               \
    RT_GPU_KERNELS(X, Rays, PathTrace_Rays)           \
    RT_GPU_KERNELS(X, Time, PathTrace_Time)           \
    RT_GPU_KERNELS(X, Reuse, PathReuse)               \
    RT_GPU_KERNELS(X, FirstHits, Aov)                 \
    X(Miss, RayTracing_rmiss)                         \
    X(TriangleHit, RayTracing_rchit)                  \
    X(QuadHit, RayTracing_Quad_rchit)                 \
    X(SphereHit, RayTracing_Procedural_rchit)         \
    X(SphereIntersection, RayTracing_Procedural_rint) \
    X(RoundHit, RayTracing_Round_rchit)               \
    X(RoundIntersection, RayTracing_Round_rint)       \
    X(FilmReduce, FilmReduce_comp)                    \
    X(FilmResolve, FilmResolve_comp)                  \
    X(SampleList, SampleList_comp)                    \
    X(DenoisePrepare, DenoisePrepare_comp)            \
    X(DenoiseMean, DenoiseMean_comp)                  \
    X(DenoiseGuide, DenoiseGuide_comp)                \
    X(DenoiseFeatures, DenoiseFeatures_comp)          \
    X(DenoiseFit, DenoiseFit_comp)                    \
    X(DenoiseErrors, DenoiseErrors_comp)              \
    X(DenoiseChoice, DenoiseChoice_comp)              \
    X(DenoiseMix, DenoiseMix_comp)                    \
    X(DenoiseBlend, DenoiseBlend_comp)                \
    X(DenoiseCoarse, DenoiseCoarse_comp)              \
    X(DenoiseGiveBack, DenoiseGiveBack_comp)          \
    X(DenoiseDepths, DenoiseDepths_comp)              \
    X(DenoiseHistory, DenoiseHistory_comp)            \
    X(DenoiseHistoryMerge, DenoiseHistoryMerge_comp)  \
    X(DenoiseLivePrepare, DenoiseLivePrepare_comp)    \
    X(DenoiseLive, DenoiseLive_comp)                  \
    X(PreviewVertex, Preview_vert)                    \
    X(PreviewFragment, Preview_frag)                  \
    X(PreviewFinish, Preview_comp)

namespace rt::gpu {

enum class Shader {
#define RT_SHADER(shader, array) shader,
    RT_GPU_SHADERS(RT_SHADER)
#undef RT_SHADER
};

// SPIR-V words, living as long as the program.
std::span<const std::uint32_t> shaderCode(Shader shader);

} // namespace rt::gpu
