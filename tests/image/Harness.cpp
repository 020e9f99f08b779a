#include "tests/image/Harness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "Common/Bench/Stability.h"
#include "Common/Render/Names.h"
#include "Common/Render/RenderParams.h"
#include "Common/Shared/Path/SeenSurfaces.h"
#include "tests/image/AnalyticScenes.h"

namespace rt::test {
namespace {

constexpr std::array kEverySampler = {app::SamplerKind::Independent, app::SamplerKind::Stratified,
                                      app::SamplerKind::Sobol};
constexpr std::array kEverySampling = {app::LightSampling::Mixture, app::LightSampling::Mis,
                                       app::LightSampling::MisBalance};
constexpr std::array kEverySelection = {app::LightSelection::Uniform, app::LightSelection::Power,
                                        app::LightSelection::Contribution};

// Settings of each estimator for which isWanted(sampler, way to sample lights, choice among lights) holds, given as
// indices into the lists above; those of the bsdf alone, which choose no light, in any case.
template <class IsWanted>
std::vector<app::RenderSettings> estimators(const app::RenderSettings& base, const IsWanted& isWanted) {
    std::vector<app::RenderSettings> wanted;
    for (std::size_t i = 0; i < kEverySampler.size(); ++i) {
        app::RenderSettings settings = base;
        settings.sampler = kEverySampler[i];
        settings.lightSampling = app::LightSampling::Bsdf;
        wanted.push_back(settings);
        for (std::size_t j = 0; j < kEverySampling.size(); ++j)
            for (std::size_t k = 0; k < kEverySelection.size(); ++k) {
                settings.lightSampling = kEverySampling[j];
                settings.lightSelection = kEverySelection[k];
                if (isWanted(i, j, k)) wanted.push_back(settings);
            }
    }
    return wanted;
}

} // namespace

app::RenderSettings smallSettings(std::uint32_t side, std::uint32_t spp) {
    app::RenderSettings settings;
    settings.width = side;
    settings.height = side;
    settings.spp = spp;
    settings.replicates = kReplicates;
    return settings;
}

std::string describe(const app::RenderSettings& settings) {
    return app::nameOf(app::kLightSamplings, settings.lightSampling) + " " +
           app::nameOf(app::kLightSelections, settings.lightSelection) + " " +
           app::nameOf(app::kSamplers, settings.sampler) + " depth " + std::to_string(settings.maxDepth);
}

Estimate render(app::Engine& engine, const scene::CompiledScene& scene, const app::RenderSettings& settings) {
    engine.reset(scene.camera, settings);
    while (!engine.renderSome({std::chrono::seconds(1), nullptr}).finished) {
    }
    Estimate estimate;
    estimate.image = engine.film().resolve();
    estimate.variance = engine.film().varianceOfMean();
    estimate.nonfinite = engine.report().nonfiniteSamples;
    estimate.cutOffShare = engine.report().cutOffShare();
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
    const double side = app::dependentSide(engine.report().features);
    for (int c = 0; c < 3; ++c) estimate.standardError[c] = side * std::sqrt(variance[c]);
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

::testing::AssertionResult sameBits(const std::vector<float>& expected, const std::vector<float>& actual) {
    if (actual.size() != expected.size())
        return ::testing::AssertionFailure() << actual.size() << " values instead of " << expected.size();
    std::size_t differing = 0;
    std::size_t first = 0;
    float largest = 0;
    for (std::size_t i = 0; i < actual.size(); ++i) {
        const bool isEqual = actual[i] == expected[i]; // not so what is not a number, whose bits may be the same
        if (isEqual && std::signbit(actual[i]) == std::signbit(expected[i])) continue; // not so 0 and -0
        if (differing++ == 0) first = i;
        largest = std::max(largest, std::abs(actual[i] - expected[i]) / std::abs(expected[i]));
    }
    if (differing == 0) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << differing << " of " << actual.size() << " values differ, first number "
                                         << first << ": " << actual[first] << " instead of " << expected[first]
                                         << ", by up to " << largest << " of the value";
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
    return estimators(base, [](std::size_t, std::size_t, std::size_t) { return true; });
}

// A Latin square: no two ways to sample lights meet a choice among lights with the same sampler.
std::vector<app::RenderSettings> estimatorsInPairs(const app::RenderSettings& base) {
    return estimators(base, [](std::size_t i, std::size_t j, std::size_t k) { return k == (i + j) % 3; });
}

image::Image renderImage(app::Engine& engine, const scene::CompiledScene& scene, const app::RenderSettings& settings) {
    engine.reset(scene.camera, settings);
    while (!engine.renderSome({std::chrono::seconds(1), nullptr}).finished) {
    }
    EXPECT_EQ(engine.report().nonfiniteSamples, 0u) << scene.id;
    return engine.film().resolve();
}

std::vector<image::Image> independentImages(app::Engine& engine, const scene::CompiledScene& scene,
                                            app::RenderSettings settings, std::uint32_t firstSeed) {
    constexpr std::uint32_t kImages = 32;
    settings.sampler = app::SamplerKind::Independent;
    std::vector<image::Image> images;
    for (std::uint32_t i = 0; i < kImages; ++i) {
        settings.seed = firstSeed + i;
        images.push_back(renderImage(engine, scene, settings));
    }
    return images;
}

std::vector<image::Image> independentImages(app::Engine& engine, const scene::CompiledScene& scene,
                                            app::LightSampling sampling, std::uint32_t side, std::uint32_t spp,
                                            std::uint32_t firstSeed) {
    app::RenderSettings settings;
    settings.width = settings.height = side;
    settings.spp = spp;
    settings.lightSampling = sampling;
    return independentImages(engine, scene, settings, firstSeed);
}

void expectStability(app::Engine& engine) {
    const auto rows = bench::measureStability(engine);
    EXPECT_GE(rows.size(), 40u);
    for (const bench::StabilityRow& row : rows)
        EXPECT_TRUE(row.pass) << row.name << ", " << row.engine << ": " << row.value << ", must be " << row.criterion;
}

//      camera            a ray through the point (x, y) of the plane at distance 1
//        o ------|------ | square     meets the square's at 4 sqrt(1 + x^2 + y^2),
//                1       4            if |x|, |y| < 1.03 / 4
void expectDepthOfWhatIsHit(app::Engine& engine) {
    constexpr std::uint32_t kSide = 16;
    constexpr double kDistance = 4, kHalf = 1.03;
    SceneDesc desc = emptyScene({0, 0, 0}, {0, 0, -1}, 60);
    desc.materials["grey"] = lambertian(0.5);
    desc.objects.push_back(
        {scene::QuadDesc{{-kHalf, -kHalf, -kDistance}, {2 * kHalf, 0, 0}, {0, 2 * kHalf, 0}, "grey"}});
    const auto compiled = scene::compileScene(desc);
    engine.setScene(compiled, nullptr);
    engine.reset(compiled->camera, smallSettings(kSide, kReplicates));
    const app::AovImages images = engine.renderAovs({{true, false, true}}, 64);
    const app::AovImages rows = engine.renderAovs({{false, false, true}, 5, 3}, 64);
    EXPECT_EQ(rows.depth.data, std::vector<float>(images.depth.pixel(0, 5), images.depth.pixel(0, 8)));

    const double pixel = 2 * std::tan(std::numbers::pi / 6) / kSide; // at distance 1
    const auto edge = [&](std::uint32_t i) { return std::abs((i - 0.5 * kSide) * pixel); };
    std::uint32_t cut = 0; // pixels that an edge goes through
    for (std::uint32_t y = 0; y < kSide; ++y) {
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const auto [nearX, farX] = std::minmax({edge(x), edge(x + 1)});
            const auto [nearY, farY] = std::minmax({edge(y), edge(y + 1)});
            const float depth = *images.depth.pixel(x, y), albedo = *images.albedo.pixel(x, y);
            if (std::max(nearX, nearY) > kHalf / kDistance) {
                EXPECT_EQ(depth, 0.0f) << x << " " << y;
                continue;
            }
            EXPECT_GE(depth, kDistance * std::sqrt(1 + nearX * nearX + nearY * nearY) - 1e-4) << x << " " << y;
            EXPECT_LE(depth, kDistance * std::sqrt(1 + farX * farX + farY * farY) + 1e-4) << x << " " << y;
            const bool isCut = std::max(farX, farY) > kHalf / kDistance;
            EXPECT_EQ(isCut, albedo < 0.499f) << x << " " << y; // the mean over all samples
            cut += isCut;
        }
    }
    EXPECT_EQ(cut, 28u);
}

//   wall     camera           mirror        a ray through (x, y) of the plane at distance 1 meets the mirror at
//     |        o ------|------ |            4 sqrt(1 + x^2 + y^2) and, mirrored, the wall 6 times that root later
//     2               1       4
void expectSurfacesInMirrors(app::Engine& engine) {
    constexpr std::uint32_t kSide = 8;
    constexpr float kOfMirror = 0.75f, kAlbedo = 0.5f, kEmission = 3;
    SceneDesc desc = emptyScene({0, 0, 0}, {0, 0, -1}, 60);
    desc.materials["wall"] = lambertian(kAlbedo, kEmission);
    desc.materials["mirror"].kind = scene::MaterialKind::Metal;
    desc.materials["mirror"].albedo = glm::dvec3(kOfMirror);
    desc.objects.push_back({scene::QuadDesc{{-9, -9, -4}, {18, 0, 0}, {0, 18, 0}, "mirror"}});
    desc.objects.push_back({scene::QuadDesc{{-20, -20, 2}, {40, 0, 0}, {0, 40, 0}, "wall"}});
    const auto compiled = scene::compileScene(desc);
    engine.setScene(compiled, nullptr);
    engine.reset(compiled->camera, smallSettings(kSide, kReplicates));
    app::AovRequest request{{false, false, true}};
    request.wide = {true, true, true};
    request.emission = true;
    const app::AovImages images = engine.renderAovs(request, 16);
    const double pixel = 2 * std::tan(std::numbers::pi / 6) / kSide; // at distance 1
    const auto edge = [&](std::uint32_t i) { return std::abs((i - 0.5 * kSide) * pixel); };
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const auto [nearX, farX] = std::minmax({edge(x), edge(x + 1)});
            const auto [nearY, farY] = std::minmax({edge(y), edge(y + 1)});
            const float first = *images.depth.pixel(x, y), depth = *images.wide.depth.pixel(x, y);
            EXPECT_GE(depth, 10 * std::sqrt(1 + nearX * nearX + nearY * nearY) - 1e-4) << x << " " << y;
            EXPECT_LE(depth, 10 * std::sqrt(1 + farX * farX + farY * farY) + 1e-4) << x << " " << y;
            EXPECT_NEAR(first, 0.4f * depth, 1e-4f);
            EXPECT_NEAR(images.wide.albedo.pixel(x, y)[1], kOfMirror * kAlbedo, 1e-6f);
            EXPECT_NEAR(images.emission.pixel(x, y)[2], kOfMirror * kEmission, 1e-5f);
            EXPECT_NEAR(images.wide.normal.pixel(x, y)[2], -1, 1e-6f); // it faces the ray, which comes from -z
        }
}

// A square of one albedo; where the runs of pixels that are sampled together have neither edges nor a depth that varies
// much, four samples of each are enough.
void expectFewerSamplesWhereTheyAgree(app::Engine& engine) {
    constexpr std::uint32_t kSide = 64, kFew = shared::kFirstSeenSamples, kAll = 16;
    SceneDesc desc = emptyScene({0, 0, 0}, {0, 0, -1}, 60);
    desc.materials["grey"] = lambertian(0.5);
    desc.objects.push_back({scene::QuadDesc{{-0.26, -0.26, -1}, {0.52, 0, 0}, {0, 0.52, 0}, "grey"}});
    const auto compiled = scene::compileScene(desc);
    engine.setScene(compiled, nullptr);
    engine.reset(compiled->camera, smallSettings(kSide, 2));
    app::AovRequest request{{true, true, true}};
    const app::AovImages few = engine.renderAovs(request, kFew), all = engine.renderAovs(request, kAll);
    request.isAdaptive = true;
    const app::AovImages adaptive = engine.renderAovs(request, kAll);
    std::uint32_t runsOfFew = 0;
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; x += shared::kSeenTogether) {
            const auto ofRun = [&](const image::Image& image) {
                return std::span(image.pixel(x, y), std::size_t{image.channels} * shared::kSeenTogether);
            };
            const auto isOf = [&](const app::AovImages& other) {
                return std::ranges::equal(ofRun(adaptive.albedo), ofRun(other.albedo)) &&
                       std::ranges::equal(ofRun(adaptive.normal), ofRun(other.normal)) &&
                       std::ranges::equal(ofRun(adaptive.depth), ofRun(other.depth));
            };
            const auto [least, most] = std::ranges::minmax(ofRun(few.albedo));
            const bool isCut = most > 0 && least < 0.5f;
            EXPECT_TRUE(isCut ? isOf(all) : isOf(few)) << x << " " << y;
            runsOfFew += !isOf(all);
        }
    EXPECT_GT(runsOfFew, 100u); // of the square, whose depth varies, 200 of all 1024
}

// The square's edges are parallel to the image's, so that what it covers of a pixel is a product of two lengths.
void expectFeaturesOfTheirOwnSamples(app::Engine& engine) {
    constexpr std::uint32_t kSide = 64, kSpp = 16;
    constexpr double kHalf = 0.2507; // at distance 1
    constexpr float kAlbedo = 0.5f, kEmission = 3;
    SceneDesc desc = emptyScene({0, 0, 0}, {0, 0, -1}, 60);
    desc.materials["lamp"] = lambertian(kAlbedo, kEmission);
    desc.objects.push_back({scene::QuadDesc{{-kHalf, -kHalf, -1}, {2 * kHalf, 0, 0}, {0, 2 * kHalf, 0}, "lamp"}});
    const auto compiled = scene::compileScene(desc);
    engine.setScene(compiled, nullptr);
    app::RenderSettings settings = smallSettings(kSide, kSpp);
    settings.replicates = 1;
    settings.edgeRays = false;
    const image::Image picture = renderImage(engine, *compiled, settings);
    const image::Image albedo = engine.renderAovs({{true, false, false}}, kSpp).albedo;

    const double pixel = 2 * std::tan(std::numbers::pi / 6) / kSide;
    const auto covered = [&](std::uint32_t i) {
        const double low = (i - 0.5 * kSide) * pixel;
        return std::max(0.0, std::min(low + pixel, kHalf) - std::max(low, -kHalf)) / pixel;
    };
    double products = 0, squaresA = 0, squaresB = 0;
    std::uint32_t cut = 0;
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const double share = covered(x) * covered(y);
            const double a = picture.pixel(x, y)[0] / kEmission - share, b = albedo.pixel(x, y)[0] / kAlbedo - share;
            products += a * b;
            squaresA += a * a;
            squaresB += b * b;
            cut += share > 0 && share < 1;
        }
    EXPECT_GT(squaresA * squaresB, 0);
    EXPECT_LT(std::abs(products), 4 * std::sqrt(squaresA * squaresB / cut)); // four standard deviations
}

} // namespace rt::test
