// Renders small images for tests and states how far their mean may lie from the truth.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Render/Engine.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "RayTracingCPU/CpuEngine.h"

namespace rt::test {

using scene::SceneDesc;

// Replicates are independent scramblings, so the spread across them is the honest error of any sampler.
inline constexpr std::uint32_t kReplicates = 32;

struct Estimate {
    glm::dvec3 mean{0};          // over all pixels
    glm::dvec3 standardError{0}; // of mean
    std::uint64_t nonfinite = 0;
    double cutOffShare = 0; // of throughput, by max depth
    image::Image image;
    image::Image variance; // of each pixel's mean
};

app::RenderSettings smallSettings(std::uint32_t side, std::uint32_t spp);

std::string describe(const app::RenderSettings& settings);

// Renders on an engine that has the scene.
Estimate render(app::Engine& engine, const scene::CompiledScene& scene, const app::RenderSettings& settings);
// Renders on the CPU engine.
Estimate render(const scene::CompiledScene& scene, const app::RenderSettings& settings);
Estimate render(const SceneDesc& desc, const app::RenderSettings& settings);

// |mean - truth| <= 4 standard errors + 1e-5 |truth| in each channel: a false alarm in 16 000 (numerics: form Z).
::testing::AssertionResult isMean(const Estimate& estimate, const glm::dvec3& truth);

// The same numbers in the same bits; else how many differ, and by how much.
::testing::AssertionResult sameBits(const std::vector<float>& expected, const std::vector<float>& actual);

// Every way of sampling lights and pixels.
std::vector<app::RenderSettings> allEstimators(const app::RenderSettings& base);
// A third of allEstimators(), where sampler, way to sample lights and choice among them do not meet all three in one
// formula: each with each of the others.
std::vector<app::RenderSettings> estimatorsInPairs(const app::RenderSettings& base);

// Asserts the rows of the stability suite that ray-tracing-bench prints. What they can detect is in their criteria.
void expectStability(app::Engine& engine);

// Asserts that the depth of a pixel is the mean over the samples that hit something: of a square before the sky, whose
// edges go through pixels; and that rows alone are those of the image.
void expectDepthOfWhatIsHit(app::Engine& engine);

// Asserts that a mirror shows the albedo, normal, distance and emission of what is in it, times its own colour.
void expectSurfacesInMirrors(app::Engine& engine);

// Asserts that the noise of features is not that of the picture: of how much of a pixel a bright square covers.
void expectFeaturesOfTheirOwnSamples(app::Engine& engine);

// Asserts that an adaptive request's features are means over few samples where those of pixels beside one another agree,
// elsewhere over all.
void expectFewerSamplesWhereTheyAgree(app::Engine& engine);

// Asserts that every sample is finite.
image::Image renderImage(app::Engine& engine, const scene::CompiledScene& scene, const app::RenderSettings& settings);

// 32 images of independent seeds and independent samples, for tests that compare images tile by tile; square ones with
// this estimator, or as the settings say.
std::vector<image::Image> independentImages(app::Engine& engine, const scene::CompiledScene& scene,
                                            app::RenderSettings settings, std::uint32_t firstSeed);
std::vector<image::Image> independentImages(app::Engine& engine, const scene::CompiledScene& scene,
                                            app::LightSampling sampling, std::uint32_t side, std::uint32_t spp,
                                            std::uint32_t firstSeed);

} // namespace rt::test
