// How fast the error of a smooth picture falls with the number of samples: a floor under one light, no edges in sight.
#include <algorithm>
#include <cmath>

#include "tests/image/AnalyticScenes.h"
#include "tests/image/Harness.h"

namespace rt::test {
namespace {

using namespace rt::scene;
using glm::dvec3;

// A sphere, or a quad so far behind the middle of what is seen of the floor.
SceneDesc litFloor(bool sphere, double quadDistance = 2) {
    SceneDesc desc = emptyScene({3, 2, 4}, {1.5, 0, 2}, 8);
    MaterialDesc floor;
    floor.albedo = dvec3(0.6);
    desc.materials["floor"] = floor;
    MaterialDesc light;
    light.kind = MaterialKind::Emitter;
    light.emission = dvec3(3);
    light.sides = Sides::Both;
    desc.materials["light"] = light;
    desc.objects.push_back({QuadDesc{{-6, 0, 6}, {12, 0, 0}, {0, 0, -12}, "floor"}});
    if (sphere) {
        desc.objects.push_back({SphereDesc{{0, 0.6, 0}, 0.6, {}, "light"}});
    } else {
        desc.objects.push_back({QuadDesc{{-1, 0.1, 2 - quadDistance}, {2, 0, 0}, {0, 1.5, 0.3}, "light"}});
    }
    return desc;
}

image::Image renderOnce(app::Engine& engine, const CompiledScene& scene, app::SamplerKind sampler, std::uint32_t spp,
                        std::uint32_t seed) {
    app::RenderSettings settings;
    settings.width = settings.height = 16;
    settings.spp = spp;
    settings.maxDepth = 2;
    settings.sampler = sampler;
    settings.seed = seed;
    engine.reset(scene.camera, settings);
    while (!engine.renderSome({std::chrono::seconds(1), nullptr}).finished) {
    }
    return engine.film().resolve();
}

// Root of the mean squared error over pixels and eight scramblings.
double error(app::Engine& engine, const CompiledScene& scene, app::SamplerKind sampler, std::uint32_t spp,
             const image::Image& reference) {
    double sum = 0;
    for (std::uint32_t seed = 1; seed <= 8; ++seed) {
        const image::Image image = renderOnce(engine, scene, sampler, spp, seed);
        for (std::size_t i = 0; i < image.data.size(); ++i)
            sum += std::pow(static_cast<double>(image.data[i]) - static_cast<double>(reference.data[i]), 2);
    }
    return std::sqrt(sum / 8 / static_cast<double>(reference.data.size()));
}

// Independent numbers: -1/2. Sobol's over position in the pixel and on the light, four dimensions: at least -0.7; a
// scrambling that is not nested, or one for several dimensions, makes it -1/2. At a distance of 3 the way in which the
// quad is sampled changes within many pixels; where equal numbers then led to other points, it was -0.66.
TEST(Convergence, SobolIsSteeperThanIndependentAndNeverWorse) {
    for (const SceneDesc& desc : {litFloor(true), litFloor(false), litFloor(false, 3)}) {
        const auto scene = compileScene(desc);
        const auto engine = cpu::makeCpuEngine({});
        engine->setScene(scene, nullptr);
        const image::Image reference = renderOnce(*engine, *scene, app::SamplerKind::Sobol, 1u << 14, 77);
        const double few = error(*engine, *scene, app::SamplerKind::Sobol, 16, reference);
        const double many = error(*engine, *scene, app::SamplerKind::Sobol, 1024, reference);
        EXPECT_GE(std::log(few / many) / std::log(64.0), 0.7) << few << " to " << many;
        for (const std::uint32_t spp : {1u, 4u, 16u, 64u, 256u}) {
            EXPECT_LE(error(*engine, *scene, app::SamplerKind::Sobol, spp, reference),
                      1.05 * error(*engine, *scene, app::SamplerKind::Independent, spp, reference))
                << spp;
        }
    }
}

constexpr std::uint32_t kScramblings = 32;

// Root of the mean square of means of errors over blocks of pixels, and kScramblings scramblings.
double blockError(app::Engine& engine, const CompiledScene& scene, app::SamplerKind sampler, std::uint32_t spp,
                  const image::Image& reference, std::size_t block) {
    constexpr std::size_t kSide = 16;
    double squares = 0;
    for (std::uint32_t seed = 1; seed <= kScramblings; ++seed) {
        const image::Image image = renderOnce(engine, scene, sampler, spp, seed);
        for (std::size_t y = 0; y < kSide; y += block)
            for (std::size_t x = 0; x < kSide; x += block) {
                double sum = 0;
                for (std::size_t k = 0; k < block * block; ++k) {
                    const std::size_t i = 3 * ((y + k / block) * kSide + x + k % block);
                    sum += static_cast<double>(image.data[i]) - static_cast<double>(reference.data[i]);
                }
                squares += std::pow(sum / static_cast<double>(block * block), 2);
            }
    }
    return std::sqrt(squares * static_cast<double>(block * block) / (kScramblings * kSide * kSide));
}

// Errors as blue noise: pixels are as good as ever, means of 4 x 4 of them have less than 0.7 of the error. The errors
// of independent pixels would leave the ratio at 1, within a twentieth by the number of blocks (one sigma).
TEST(Convergence, BlueNoiseMovesErrorsToHighFrequencies) {
    for (const bool sphere : {false, true}) {
        const auto scene = compileScene(litFloor(sphere));
        const auto engine = cpu::makeCpuEngine({});
        engine->setScene(scene, nullptr);
        const image::Image reference = renderOnce(*engine, *scene, app::SamplerKind::Sobol, 1u << 14, 77);
        const auto ratio = [&](std::uint32_t spp, std::size_t block) {
            return blockError(*engine, *scene, app::SamplerKind::SobolBlue, spp, reference, block) /
                   blockError(*engine, *scene, app::SamplerKind::Sobol, spp, reference, block);
        };
        EXPECT_LT(ratio(16, 1), 1.2);
        EXPECT_LT(ratio(16, 4), 0.7);
        EXPECT_LT(ratio(20, 1), 1.2); // no power of two
        EXPECT_LT(ratio(20, 4), 1.1);
    }
}

} // namespace
} // namespace rt::test
