// The compiled shaders, which are part of the program.
#pragma once
#include <cstdint>
#include <span>

namespace rt::gpu {

enum class Shader {
    PathCompute,
    PathQuery,
    FullPathCompute, // with all code of shared headers, as have others named so, see Shim.h
    FullPathQuery,
    ReuseCompute,
    ReuseQuery,
    AovCompute,
    AovQuery,
    CostCompute,
    CostQuery,
    FullCostCompute,
    FullCostQuery,
    TimeCompute,
    TimeQuery,
    FullTimeCompute,
    FullTimeQuery,
    RayGeneration,
    FullRayGeneration,
    ReuseGeneration,
    AovGeneration,
    CostGeneration,
    FullCostGeneration,
    TimeGeneration,
    FullTimeGeneration,
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
