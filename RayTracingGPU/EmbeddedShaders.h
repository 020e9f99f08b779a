// The compiled shaders, which are part of the program.
#pragma once
#include <cstdint>
#include <span>

namespace rt::gpu {

enum class Shader {
    PathCompute,
    PathQuery,
    HeavyPathCompute, // with all code of shared headers, as have others named so, see Shim.h
    HeavyPathQuery,
    ReuseCompute,
    ReuseQuery,
    AovCompute,
    AovQuery,
    CostCompute,
    CostQuery,
    HeavyCostCompute,
    HeavyCostQuery,
    TimeCompute,
    TimeQuery,
    HeavyTimeCompute,
    HeavyTimeQuery,
    RayGeneration,
    HeavyRayGeneration,
    ReuseGeneration,
    AovGeneration,
    CostGeneration,
    HeavyCostGeneration,
    TimeGeneration,
    HeavyTimeGeneration,
    Miss,
    TriangleHit,
    QuadHit,
    SphereHit,
    SphereIntersection,
    FilmReduce,
    SampleList,
    FilmResolve,
    PreviewVertex,
    PreviewFragment,
    PreviewFinish,
};

// SPIR-V words, living as long as the program.
std::span<const std::uint32_t> shaderCode(Shader shader);

} // namespace rt::gpu
