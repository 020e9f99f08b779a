// The compiled shaders, which are part of the program.
#pragma once
#include <cstdint>
#include <span>

namespace rt::gpu {

enum class Shader {
    PathCompute,
    ProjectedPathCompute, // with the code of lights by projected solid angle, as have others named so
    AovCompute,
    CostCompute,
    ProjectedCostCompute,
    TimeCompute,
    ProjectedTimeCompute,
    RayGeneration,
    ProjectedRayGeneration,
    AovGeneration,
    CostGeneration,
    ProjectedCostGeneration,
    TimeGeneration,
    ProjectedTimeGeneration,
    Miss,
    TriangleHit,
    QuadHit,
    SphereHit,
    SphereIntersection,
    FilmReduce,
    FilmResolve,
    PreviewVertex,
    PreviewFragment,
    PreviewFinish,
};

// SPIR-V words, living as long as the program.
std::span<const std::uint32_t> shaderCode(Shader shader);

} // namespace rt::gpu
