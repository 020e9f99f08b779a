// Live pictures of a camera that moves: what they take over from the one before.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Image/Metrics.h"
#include "Common/Render/PictureDenoiser.h"
#include "Common/Scene/CameraRecord.h"
#include "Common/Vulkan/PipelineCache.h"
#include "RayTracingCPU/CpuEngine.h"
#include "RayTracingGPU/DeviceDenoiser.h"
#include "RayTracingGPU/GpuEngine.h"
#include "RayTracingGPU/LiveHistory.h"
#include "tests/cross/Device.h"

namespace rt::test {
namespace {

using image::Image;

const std::atomic<bool> kGoesOn{false};

// ---- films of an engine ------------------------------------------------------------------------------------------

class LiveHistoryTest : public ::testing::Test {
  protected:
    static constexpr std::uint32_t kSide = 64;

    LiveHistoryTest() {
        settings_.width = kSide;
        settings_.height = kSide;
        engine_ = gpu::makeGpuEngine(
            device(), {.pipelineCache = false, .engine = app::GpuEngineKind::Compute, .denoisesInSoftware = true});
        forget();
    }
    // As for a scene that is new.
    void forget() { engine_->setScene(scene_, nullptr); }
    // Around what it looks at.
    scene::CameraDesc turned(double degrees) const {
        scene::CameraDesc camera = scene_->camera;
        const glm::dvec3 view = camera.lookFrom - camera.lookAt;
        const double c = std::cos(degrees * std::numbers::pi / 180), s = std::sin(degrees * std::numbers::pi / 180);
        camera.lookFrom = camera.lookAt + glm::dvec3(c * view.x + s * view.z, view.y, c * view.z - s * view.x);
        return camera;
    }
    void render(const scene::CameraDesc& camera, std::uint32_t spp, std::uint32_t seed) {
        settings_.spp = spp;
        settings_.replicates = std::min(spp, 2u);
        settings_.seed = seed;
        engine_->reset(camera, settings_);
        while (!engine_->renderSome({}).finished) continue;
    }
    Image live() {
        const auto made = engine_->makeDenoiser()->denoise({app::DenoiseQuality::Live, false, 1}, kGoesOn);
        EXPECT_TRUE(made && !made->device.empty());
        return made ? made->images.picture : Image();
    }
    Image live(const scene::CameraDesc& camera, std::uint32_t spp, std::uint32_t seed) {
        render(camera, spp, seed);
        return live();
    }
    // Against a render of the other engine. The median is that over the pixels: of the mean a third and more is lamps'
    // edges, one pixel wide, of which no frame has enough samples.
    struct Errors {
        double mean, median;
    };
    Errors errorsOf(const Image& picture, const scene::CameraDesc& camera) {
        if (reference_.data.empty() || referenceCamera_ != camera) renderReference(camera);
        std::vector<double> errors;
        for (std::size_t i = 0; i < picture.data.size(); ++i) {
            const double value = reference_.data[i], difference = picture.data[i] - value;
            errors.push_back(difference * difference / (value * value + image::kRelativeFloor));
        }
        const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
        std::nth_element(errors.begin(), middle, errors.end());
        return {image::compare(picture, reference_).relmse, *middle};
    }
    void renderReference(const scene::CameraDesc& camera) {
        app::RenderSettings settings = settings_;
        settings.spp = 1024;
        settings.replicates = 1;
        const auto cpu = cpu::makeCpuEngine({});
        cpu->setScene(scene_, &kGoesOn);
        cpu->reset(camera, settings);
        while (!cpu->renderSome({}).finished) continue;
        reference_ = cpu->film().resolve();
        referenceCamera_ = camera;
    }
    // Two views from within the box that have no point in common.
    std::pair<scene::CameraDesc, scene::CameraDesc> oppositeViews() const {
        scene::CameraDesc first = scene_->camera;
        const glm::dvec3 middle = first.lookAt;
        const glm::dvec3 aside = glm::normalize(glm::cross(first.lookFrom - first.lookAt, first.up));
        first.verticalFov = 40;
        first.lookFrom = middle;
        scene::CameraDesc second = first;
        first.lookAt = middle + aside;
        second.lookAt = middle - aside;
        return {first, second};
    }

    std::shared_ptr<const scene::CompiledScene> scene_ = app::compile(app::loadScene("cornell-box-lights"), true);
    std::unique_ptr<app::Engine> engine_;
    app::RenderSettings settings_;
    Image reference_;
    scene::CameraDesc referenceCamera_;
};

// Five frames' samples instead of one's.
TEST_F(LiveHistoryTest, ACameraThatMovesHasLessNoiseFromFrameToFrame) {
    const Image alone = live(turned(4), 2, 4);
    forget();
    Image picture;
    for (const std::uint32_t frame : {0u, 1u, 2u, 3u, 4u}) picture = live(turned(frame), 2, frame);
    const Errors got = errorsOf(picture, turned(4)), before = errorsOf(alone, turned(4));
    EXPECT_LT(got.median, 0.5 * before.median);
    EXPECT_LT(got.mean, 0.85 * before.mean);
}

TEST_F(LiveHistoryTest, OneSampleAPixelMakesAPictureAsTwoHalvesOfIt) {
    const Image first = live(turned(5), 1, 5);
    const Image raw = engine_->film().resolve();
    forget();
    Image picture;
    for (const std::uint32_t frame : {0u, 1u, 2u, 3u, 4u, 5u}) picture = live(turned(frame), 1, frame);
    const Errors ofRaw = errorsOf(raw, turned(5)), ofFirst = errorsOf(first, turned(5));
    EXPECT_LT(ofFirst.mean, 0.6 * ofRaw.mean);
    const Errors got = errorsOf(picture, turned(5));
    EXPECT_LT(got.median, 0.5 * ofFirst.median);
    EXPECT_LT(got.mean, 0.6 * ofFirst.mean);
}

TEST_F(LiveHistoryTest, AfterACutNothingIsLeft) {
    const auto [first, second] = oppositeViews();
    const Image alone = live(second, 2, 1);
    forget();
    live(first, 2, 0);
    EXPECT_EQ(live(second, 2, 1).data, alone.data);
}

TEST_F(LiveHistoryTest, AnotherSceneOrDepthForgets) {
    const Image alone = live(turned(1), 2, 1);
    live(turned(0), 2, 0);
    EXPECT_NE(live(turned(1), 2, 1).data, alone.data);
    forget();
    EXPECT_EQ(live(turned(1), 2, 1).data, alone.data);
    live(turned(0), 2, 0);
    settings_.maxDepth = 1;
    const Image shallow = live(turned(1), 2, 1);
    forget();
    EXPECT_EQ(live(turned(1), 2, 1).data, shallow.data);
}

// What was seen before has no part in a film that knows better, and its own samples count once.
TEST_F(LiveHistoryTest, AFilmThatGoesOnIsLeftAlone) {
    const auto more = 4 * static_cast<std::uint32_t>(shared::kHistorySamples);
    const Image alone = live(turned(1), more, 1);
    forget();
    live(turned(0), 2, 0);
    EXPECT_EQ(live(turned(1), more, 1).data, alone.data);
    live(turned(0), 2, 0);
    const Image few = live(turned(1), 4, 1);
    EXPECT_EQ(live().data, few.data);
}

// A smaller draft before, as windows have it, is remembered, too.
TEST_F(LiveHistoryTest, TakesOverFromAnotherSize) {
    const Image alone = live(turned(1), 2, 5);
    forget();
    settings_.width = settings_.height = 48;
    for (const std::uint32_t seed : {0u, 1u, 2u, 3u}) live(turned(0), 2, seed);
    settings_.width = settings_.height = kSide;
    EXPECT_LT(errorsOf(live(turned(1), 2, 5), turned(1)).median, 0.8 * errorsOf(alone, turned(1)).median);
}

TEST_F(LiveHistoryTest, APictureOfFinalQualityIsRemembered) {
    const Image alone = live(turned(1), 2, 5);
    forget();
    live(turned(0), 64, 0);
    ASSERT_TRUE(engine_->makeDenoiser()->denoise({app::DenoiseQuality::Final}, kGoesOn));
    EXPECT_LT(errorsOf(live(turned(1), 2, 5), turned(1)).median, 0.5 * errorsOf(alone, turned(1)).median);
}

TEST_F(LiveHistoryTest, ItsMemoryIsTold) {
    live(turned(0), 2, 0);
    const auto before = engine_->report().deviceBytes;
    live(turned(1), 2, 1);
    const auto pixels = std::uint64_t{settings_.width} * settings_.height;
    EXPECT_GE(engine_->report().deviceBytes, before + pixels * shared::kHistoryPlanes * 4 * sizeof(float));
    const auto both = engine_->report().deviceBytes;
    live(turned(2), 2, 2);
    EXPECT_EQ(engine_->report().deviceBytes, both);
}

// ---- pictures whose truth is known -------------------------------------------------------------------------------

// A wall across the view that fills it, before a camera that moves aside by a few pixels a frame.
class HistoryOfAWall {
  public:
    static constexpr std::uint32_t kSide = 96;

    HistoryOfAWall()
        : cache_(device(), ""), pipelines_(device(), cache_), denoiser_(device(), pipelines_, kSide, kSide) {}

    // The picture with the halves that are there.
    Image frame(const Image& a, const Image& b, std::uint64_t samples = 1) {
        scene::CameraDesc camera;
        camera.verticalFov = 60;
        camera.lookFrom = {0.037 * ++frames_, 0, 2};
        camera.lookAt = {camera.lookFrom.x, 0, 0};
        const shared::Camera record = scene::makeCamera(camera, kSide, kSide, {0, 0, 0});
        Image albedo(kSide, kSide), normal(kSide, kSide), depth(kSide, kSide, 1);
        for (std::uint32_t y = 0; y < kSide; ++y)
            for (std::uint32_t x = 0; x < kSide; ++x) {
                const shared::vec2 place((static_cast<float>(x) + 0.5f) / kSide,
                                         (static_cast<float>(y) + 0.5f) / kSide);
                normal.pixel(x, y)[2] = 1;
                depth.pixel(x, y)[0] = -2 / shared::historyDirection(record, place).z;
                for (std::uint32_t c = 0; c < 3; ++c) albedo.pixel(x, y)[c] = 0.5f;
            }
        denoiser_.setSurfaces(albedo, normal, depth);
        denoiser_.setHalves(a, b);
        history_.begin(record, {});
        const gpu::HistoryStep step = history_.step(kSide, kSide, samples, false);
        denoiser_.runLive(&step);
        return denoiser_.readLive();
    }

  private:
    vulkan::PipelineCache cache_;
    gpu::DenoisePipelines pipelines_;
    gpu::DeviceDenoiser denoiser_;
    gpu::LiveHistory history_{device()};
    int frames_ = 0;
};

TEST(HistoryOfAWallTest, KeepsWhatIsTheSameEverywhere) {
    HistoryOfAWall wall;
    Image constant(HistoryOfAWall::kSide, HistoryOfAWall::kSide);
    for (std::size_t i = 0; i < constant.data.size(); ++i) constant.data[i] = 0.3f + 0.2f * static_cast<float>(i % 3);
    for (int frame = 0; frame < 20; ++frame) {
        const Image picture = wall.frame(constant, constant);
        for (std::size_t i = 0; i < constant.data.size(); ++i) ASSERT_NEAR(picture.data[i], constant.data[i], 1e-5f);
    }
}

// Frames of exponential noise, as rare and bright as that of few paths is: its mean is 0.5, its variance 0.25. The last
// of each sequence counts, as their histories have nothing in common. The mean of its pixels is that of all samples in
// it, whose weights add up to 1: its standard error is at most what the last frame alone has.
TEST(HistoryOfAWallTest, KeepsTheEnergyOfNoiseAndLowersIt) {
    constexpr int kSequences = 6, kFrames = 8;
    std::mt19937 random(11);
    std::exponential_distribution<float> noise(2.0f);
    double sum = 0, squares = 0, squaresOfFirst = 0, values = 0;
    for (int sequence = 0; sequence < kSequences; ++sequence) {
        HistoryOfAWall wall;
        for (int frame = 1; frame <= kFrames; ++frame) {
            Image halves[2]{Image(HistoryOfAWall::kSide, HistoryOfAWall::kSide),
                            Image(HistoryOfAWall::kSide, HistoryOfAWall::kSide)};
            for (Image& half : halves)
                for (float& value : half.data) value = noise(random);
            const Image picture = wall.frame(halves[0], halves[1]);
            for (const float value : picture.data) {
                const double error = value - 0.5;
                if (frame == 1) squaresOfFirst += error * error;
                if (frame < kFrames) continue;
                sum += error;
                squares += error * error;
                ++values;
            }
        }
    }
    EXPECT_LT(std::abs(sum / values) / (0.5 / std::sqrt(2 * values)), 4);
    EXPECT_LT(squares, 0.4 * squaresOfFirst);
}

} // namespace
} // namespace rt::test
