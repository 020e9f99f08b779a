// Motion blur is the mean of the picture over the time that the shutter is open, and the error that is estimated is the
// one that it has.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "Common/App/Session/SceneSource.h"
#include "Common/Image/Summary.h"
#include "Common/Render/ShutterEngine.h"
#include "tests/TempFolder.h"
#include "tests/image/EstimateRatios.h"
#include "tests/image/Harness.h"
#include "tests/unit/MovingModels.h"
#include "tests/unit/Statistics.h"

namespace rt::test {
namespace {

using scene::kSeen;
using scene::MovingModel;

struct Blurred {
    std::unique_ptr<app::Engine> engine;
    std::shared_ptr<const scene::CompiledScene> scene;
};

Blurred blurred(const std::filesystem::path& file, double open, double close) {
    const app::PoseScene pose = app::posesOf({file.string()});
    Blurred result{app::makeShutterEngine(cpu::makeCpuEngine({}), open, close, pose), pose((open + close) / 2)};
    result.engine->setScene(result.scene, nullptr);
    return result;
}

// Means of columns, of as many independent renders as there are seeds.
std::vector<Mean> columns(const Blurred& of, app::RenderSettings settings, std::uint32_t seeds) {
    std::vector<Mean> means(settings.width);
    for (settings.seed = 0; settings.seed < seeds; ++settings.seed) {
        const image::Image picture = renderImage(*of.engine, *of.scene, settings);
        for (std::uint32_t x = 0; x < settings.width; ++x) {
            double sum = 0;
            for (std::uint32_t y = 0; y < settings.height; ++y) sum += double{picture.pixel(x, y)[1]};
            means[x].add(sum / settings.height);
        }
    }
    return means;
}

// How much of the interval [a, b], on average, is covered by [left, right] on its way from there to `way` further on.
double shareCovered(double a, double b, double left, double right, double way) {
    const auto ramp = [way](double c) { // the integral over the way of how far c is ahead
        const double from = std::max(c, 0.0), to = std::max(c - way, 0.0);
        return (from * from - to * to) / 2;
    };
    return (ramp(b - left) - ramp(a - left) - ramp(b - right) + ramp(a - right)) / way / (b - a);
}

// Of a lamp that reaches from `left` to `right` when the shutter opens.
void expectTrapezoid(const Blurred& of, double left, double right, double way) {
    app::RenderSettings settings = smallSettings(16, 40);
    settings.replicates = 1;
    constexpr std::uint32_t kSeeds = 40;
    const std::vector<Mean> means = columns(of, settings, kSeeds);
    double squares = 0, expected = 0;
    std::uint32_t partly = 0;
    for (std::uint32_t x = 0; x < settings.width; ++x) {
        const double pixel = 2 * kSeen / settings.width, a = -kSeen + x * pixel;
        const double truth = shareCovered(a, a + pixel, left, right, way);
        expected += truth;
        // Four standard errors of 40 seeds; and the trapezoid's sides are seen within a hundredth.
        EXPECT_NEAR(means[x].mean(), truth, 4 * means[x].standardError() + 1e-6) << "column " << x;
        EXPECT_LT(means[x].standardError(), 0.01) << "column " << x;
        if (truth < 0.01 || truth > 0.99) continue;
        ++partly;
        const double z = (means[x].mean() - truth) / means[x].standardError();
        squares += z * z;
    }
    EXPECT_GT(partly, 8u); // else there was nothing to see
    EXPECT_GT(expected, 1);
    // Columns have the same times, so that their z scores are not independent: a bias of two standard errors in all
    // columns shows.
    EXPECT_LT(squares / partly, 4);
}

TEST(Shutter, ALampThatMovesCoversATrapezoid) {
    const TempFolder folder;
    const std::filesystem::path file = scene::saveMovingLamp(folder / "lamp.glb");
    expectTrapezoid(blurred(file, 0, 1), -0.85, -0.35, 1.2);
    expectTrapezoid(blurred(file, 0.25, 0.75), -0.55, -0.05, 0.6);
}

TEST(Shutter, ACameraThatMovesBlursWhatStandsStill) {
    const TempFolder folder;
    MovingModel model;
    model.addNode({{"mesh", model.addMesh(model.lamp(0.5f, 4))}});
    model.move(model.addCamera(), "translation", {0.6f, 0, float(scene::kCameraDistance)},
               {-0.6f, 0, float(scene::kCameraDistance)});
    expectTrapezoid(blurred(model.save(folder / "camera.glb"), 0, 1), -0.85, -0.35, 1.2);
}

// Pixels of a replicate share its times: the spread over seeds tells the error of their mean, that over pixels does not.
struct SeedMeans {
    Mean mean;
    double relmse = 0; // of one, on average
};

SeedMeans renderSeveral(const Blurred& of, app::RenderSettings settings, std::uint32_t seeds,
                        const image::Image& truth) {
    SeedMeans result;
    settings.replicates = 1;
    for (settings.seed = 0; settings.seed < seeds; ++settings.seed) {
        const image::Image picture = renderImage(*of.engine, *of.scene, settings);
        result.mean.add(image::channelMeans(picture)[1]);
        result.relmse += image::compare(picture, truth).relmse / seeds;
    }
    return result;
}

// The mean of pictures of instants, the middles of equal parts of the interval.
Estimate meanOfInstants(const std::filesystem::path& file, app::RenderSettings settings, std::uint32_t instants) {
    const app::PoseScene pose = app::posesOf({file.string()});
    const auto engine = cpu::makeCpuEngine({});
    Estimate mean;
    mean.image = image::Image(settings.width, settings.height, 3);
    glm::dvec3 variance{0};
    for (std::uint32_t i = 0; i < instants; ++i) {
        const auto scene = pose((i + 0.5) / instants);
        engine->setScene(scene, nullptr);
        settings.seed = 1000 + i;
        const Estimate one = render(*engine, *scene, settings);
        mean.mean += one.mean / double(instants);
        variance += one.standardError * one.standardError / double(instants) / double(instants);
        for (std::size_t v = 0; v < mean.image.data.size(); ++v)
            mean.image.data[v] += one.image.data[v] / static_cast<float>(instants);
    }
    mean.standardError = glm::sqrt(variance);
    return mean;
}

// The mean of the picture within four standard errors of both, and an error of pixels that falls as that of
// independent samples does or faster: sixteenfold for sixteen times as many, with some room.
void expectMeanOfInstants(const std::filesystem::path& file) {
    const Estimate truth = meanOfInstants(file, smallSettings(16, 64), 128);
    const Blurred of = blurred(file, 0, 1);
    const SeedMeans few = renderSeveral(of, smallSettings(16, 16), 24, truth.image);
    const SeedMeans many = renderSeveral(of, smallSettings(16, 256), 8, truth.image);
    for (const SeedMeans& blur : {few, many})
        EXPECT_NEAR(blur.mean.mean(), truth.mean[1],
                    4 * std::hypot(blur.mean.standardError(), truth.standardError[1]) + 2e-4 * truth.mean[1]);
    EXPECT_LT(few.mean.standardError(), 0.02 * truth.mean[1]);
    EXPECT_LT(many.relmse * 10, few.relmse);
    // It is another picture than that of the middle.
    const auto sharp = cpu::makeCpuEngine({});
    sharp->setScene(of.scene, nullptr);
    const Estimate middle = render(*sharp, *of.scene, smallSettings(16, 256));
    EXPECT_GT(image::compare(middle.image, truth.image).relmse, 30 * many.relmse);
}

// Instances of one mesh, of which one turns about the axis that the camera looks along.
TEST(Shutter, AnInstanceThatTurnsIsTheMeanOfItsInstants) {
    const TempFolder folder;
    MovingModel model;
    const int mesh = model.addMesh(model.lamp(1.6f, 0.3f));
    const int turning = model.addNode({{"mesh", mesh}});
    model.addNode({{"mesh", mesh}, {"translation", {0, 0.8, -1}}});
    model.addCamera();
    const float half = std::sqrt(0.5f);
    model.move(turning, "rotation", {0, 0, 0, 1}, {0, 0, half, half});
    expectMeanOfInstants(model.save(folder / "turning.glb"));
}

TEST(Shutter, ALightThatMovesIsTheMeanOfItsInstants) {
    const TempFolder folder;
    MovingModel model;
    model.addNode({{"mesh", model.addMesh(model.rectangle(4, 4, nlohmann::json::object()))}});
    model.addCamera();
    model.move(model.addLight({-1, 0, 0.3f}, 1), "translation", {-1, 0, 0.3f}, {1, 0, 0.3f});
    expectMeanOfInstants(model.save(folder / "light.glb"));
}

// Estimated over measured relMSE, on average, within four standard errors of 1.
void expectHonestError(const Blurred& of) {
    app::RenderSettings settings = smallSettings(16, 64);
    settings.replicates = 4;
    const std::vector<EstimatedRun> runs = renderSeeds(*of.engine, *of.scene, settings, 60);
    const std::vector<double> measured = measuredErrors(runs);
    Mean truth, estimate;
    for (std::size_t r = 0; r < runs.size(); ++r) {
        truth.add(measured[r]);
        estimate.add(runs[r].estimated.value);
    }
    const double tolerance =
        4 * std::hypot(truth.standardError() / truth.mean(), estimate.standardError() / estimate.mean());
    EXPECT_LT(tolerance, 0.5);
    EXPECT_NEAR(estimate.mean() / truth.mean(), 1, tolerance);
}

// All pixels of a replicate are of the same times: if replicates shared these, the estimate would be far too low.
TEST(Shutter, TheErrorThatIsEstimatedIsThatOfTimesToo) {
    const TempFolder folder;
    expectHonestError(blurred(scene::saveMovingLamp(folder / "lamp.glb"), 0, 1));
}

// Replicates do not share what else is random either, which is all where what moves has come to rest.
TEST(Shutter, TheErrorThatIsEstimatedIsThatOfPathsToo) {
    const TempFolder folder;
    expectHonestError(blurred(scene::saveMovingLamp(folder / "lamp.glb"), 5, 6));
}

// Features are of many times: where the lamp passes, pixels see it for a part of the time, at its distance.
TEST(Shutter, FeaturesAreMeansOverTheInterval) {
    const TempFolder folder;
    MovingModel model;
    const int quad = model.addNode({{"mesh", model.addMesh(model.rectangle(0.5f, 4, nlohmann::json::object()))}});
    model.addCamera();
    model.addLight({0, 0, 5}, 10);
    model.move(quad, "translation", {-0.6f, 0, 0}, {0.6f, 0, 0});
    const Blurred of = blurred(model.save(folder / "quad.glb"), 0, 1);
    app::RenderSettings settings = smallSettings(16, 16);
    renderImage(*of.engine, *of.scene, settings);
    const image::Image film = of.engine->film().resolve();
    const app::AovImages features = of.engine->renderAovs({{true, true, true}}, app::kAovSamples);
    for (std::uint32_t x = 0; x < settings.width; ++x) {
        const double pixel = 2 * kSeen / settings.width, a = -kSeen + x * pixel;
        const double covered = shareCovered(a, a + pixel, -0.85, -0.35, 1.2);
        for (std::uint32_t y = 0; y < settings.height; ++y) {
            // Of 32 stratified times, those are in doubt in which a side of the rectangle passes the pixel.
            EXPECT_NEAR(double{features.normal.pixel(x, y)[2]}, covered, 4.0 / app::kAovPoses + 1e-3) << x;
            if (covered > 0.2) {
                EXPECT_NEAR(double{features.depth.pixel(x, y)[0]}, scene::kCameraDistance, 0.2) << x;
            } else if (covered == 0) {
                EXPECT_EQ(features.depth.pixel(x, y)[0], 0) << x;
            }
        }
    }
    EXPECT_EQ(of.engine->film().resolve().data, film.data); // which stays as it is
}

} // namespace
} // namespace rt::test
