#include "tests/image/Harness.h"

#include <cmath>

#include "Common/Bench/Stability.h"

namespace rt::test {

app::RenderSettings smallSettings(std::uint32_t side, std::uint32_t spp) {
    app::RenderSettings settings;
    settings.width = side;
    settings.height = side;
    settings.spp = spp;
    settings.replicates = kReplicates;
    return settings;
}

std::string describe(const app::RenderSettings& settings) {
    static const char* const kSamplings[] = {"bsdf", "mixture", "mis", "mis-balance"};
    static const char* const kSelections[] = {"uniform", "power", "contribution"};
    static const char* const kSamplers[] = {"independent", "stratified", "sobol", "sobol-blue"};
    return std::string(kSamplings[static_cast<std::size_t>(settings.lightSampling)]) + " " +
           kSelections[static_cast<std::size_t>(settings.lightSelection)] + " " +
           kSamplers[static_cast<std::size_t>(settings.sampler)] + " depth " + std::to_string(settings.maxDepth);
}

Estimate render(app::Engine& engine, const scene::CompiledScene& scene, const app::RenderSettings& settings) {
    engine.reset(scene.camera, settings);
    while (!engine.renderSome({std::chrono::seconds(1), nullptr}).finished) {
    }
    Estimate estimate;
    estimate.image = engine.film().resolve();
    estimate.variance = engine.film().varianceOfMean();
    estimate.nonfinite = engine.report().nonfiniteSamples;
    const double pixels = static_cast<double>(settings.width) * settings.height;
    glm::dvec3 variance{0};
    for (std::uint32_t y = 0; y < settings.height; ++y) {
        for (std::uint32_t x = 0; x < settings.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                estimate.mean[c] += static_cast<double>(estimate.image.pixel(x, y)[c]) / pixels;
                variance[c] += static_cast<double>(estimate.variance.pixel(x, y)[c]) / (pixels * pixels);
            }
        }
    }
    for (int c = 0; c < 3; ++c) estimate.standardError[c] = std::sqrt(variance[c]);
    return estimate;
}

Estimate render(const scene::CompiledScene& scene, const app::RenderSettings& settings) {
    const auto engine = cpu::makeCpuEngine({});
    // The scene outlives the engine: no ownership is passed.
    engine->setScene(std::shared_ptr<const scene::CompiledScene>(std::shared_ptr<void>(), &scene), nullptr);
    return render(*engine, scene, settings);
}

Estimate render(const SceneDesc& desc, const app::RenderSettings& settings) {
    return render(*scene::compileScene(desc), settings);
}

::testing::AssertionResult isMean(const Estimate& estimate, const glm::dvec3& truth) {
    if (estimate.nonfinite != 0)
        return ::testing::AssertionFailure() << estimate.nonfinite << " samples are not finite";
    for (int c = 0; c < 3; ++c) {
        const double allowed = 4 * estimate.standardError[c] + 1e-5 * std::abs(truth[c]);
        if (!(std::abs(estimate.mean[c] - truth[c]) <= allowed)) {
            return ::testing::AssertionFailure() << "channel " << c << ": " << estimate.mean[c] << " +- "
                                                 << estimate.standardError[c] << ", the truth is " << truth[c];
        }
    }
    return ::testing::AssertionSuccess();
}

std::vector<app::RenderSettings> allEstimators(const app::RenderSettings& base) {
    std::vector<app::RenderSettings> all;
    for (auto sampler : {app::SamplerKind::Independent, app::SamplerKind::Stratified, app::SamplerKind::Sobol}) {
        app::RenderSettings settings = base;
        settings.sampler = sampler;
        settings.lightSampling = app::LightSampling::Bsdf;
        all.push_back(settings);
        for (auto sampling : {app::LightSampling::Mixture, app::LightSampling::Mis, app::LightSampling::MisBalance}) {
            for (auto selection :
                 {app::LightSelection::Uniform, app::LightSelection::Power, app::LightSelection::Contribution}) {
                settings.lightSampling = sampling;
                settings.lightSelection = selection;
                all.push_back(settings);
            }
        }
    }
    return all;
}

std::vector<image::Image> independentImages(app::Engine& engine, const scene::CompiledScene& scene,
                                            app::LightSampling sampling, std::uint32_t side, std::uint32_t spp,
                                            std::uint32_t firstSeed) {
    constexpr std::uint32_t kImages = 32;
    std::vector<image::Image> images;
    for (std::uint32_t i = 0; i < kImages; ++i) {
        app::RenderSettings settings;
        settings.width = settings.height = side;
        settings.spp = spp;
        settings.sampler = app::SamplerKind::Independent;
        settings.lightSampling = sampling;
        settings.seed = firstSeed + i;
        engine.reset(scene.camera, settings);
        while (!engine.renderSome({std::chrono::seconds(1), nullptr}).finished) {
        }
        images.push_back(engine.film().resolve());
    }
    EXPECT_EQ(engine.report().nonfiniteSamples, 0u) << scene.id;
    return images;
}

void expectStability(app::Engine& engine) {
    const auto rows = bench::measureStability(engine);
    EXPECT_GE(rows.size(), 40u);
    for (const bench::StabilityRow& row : rows)
        EXPECT_TRUE(row.pass) << row.name << ", " << row.engine << ": " << row.value << ", must be " << row.criterion;
}

} // namespace rt::test
