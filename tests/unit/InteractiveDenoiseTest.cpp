// The denoised pictures of a window's session.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "Common/App/Interactive/FilmPlan.h"
#include "Common/Image/ImageIo.h"
#include "Common/Render/PictureDenoiser.h"
#include "tests/unit/InteractiveFixture.h"

namespace rt::app {
namespace {

class InteractiveDenoiseTest : public InteractiveFixture {
  protected:
    static InteractiveSession::Setup denoising(std::uint32_t spp) {
        InteractiveSession::Setup wanted = setup(spp);
        wanted.request.halves = true;
        return wanted;
    }
    static ViewRequest viewOf(ViewMode mode, bool denoise = true) {
        ViewRequest view;
        view.mode = mode;
        view.denoise = denoise;
        return view;
    }
    static bool isFinal(const SessionState& state) {
        return isFinished(state) && state.picture.isDenoised && !state.picture.isLive;
    }
    static bool isRaw(const SessionState& state) { return isFinished(state) && !state.picture.isDenoised; }
    // The fake engine's samples have a mean of 0.5.
    static double meanSquare(const image::Image& image) {
        double sum = 0;
        for (const float value : image.data) sum += (value - 0.5) * (value - 0.5);
        return sum / static_cast<double>(image.data.size());
    }
};

TEST_F(InteractiveDenoiseTest, APictureAtRestIsDenoisedAndTellsBothErrors) {
    InteractiveSession session(denoising(16));
    session.view(viewOf(ViewMode::Picture));
    ASSERT_TRUE(reaches(session, isFinal));
    const SessionState state = session.state();
    EXPECT_EQ(state.settings.replicates, 2u);
    EXPECT_LT(meanSquare(*state.picture.image), 0.2 * meanSquare(*state.picture.radiance));
    ASSERT_TRUE(state.relmse && state.denoisedRelmse);
    EXPECT_LT(*state.denoisedRelmse, *state.relmse);
    EXPECT_GT(state.denoiseSeconds, 0);
}

TEST_F(InteractiveDenoiseTest, TurningItOffAndOnCostsNoSample) {
    InteractiveSession::Setup wanted = denoising(16);
    InteractiveSession session(wanted);
    session.view(viewOf(ViewMode::Picture));
    ASSERT_TRUE(reaches(session, isFinal));
    const int films = SlowEngine::films;
    for (const bool on : {false, true}) {
        wanted.request.halves = on;
        session.change(wanted.request);
        session.view(viewOf(ViewMode::Picture, on));
        ASSERT_TRUE(reaches(session, on ? isFinal : isRaw));
    }
    wanted.request.halves = false;
    wanted.request.settings.spp = 20; // goes on, with halves that nobody asks for
    session.change(wanted.request);
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return isFinished(s) && s.picture.spp == 20; }));
    EXPECT_EQ(session.state().settings.replicates, 2u);
    EXPECT_EQ(SlowEngine::films, films + 1); // begun again for the number alone,
    EXPECT_GT(SlowEngine::restored, 0);      // with all its samples
}

TEST_F(InteractiveDenoiseTest, AFilmWithoutHalvesIsRenderedAgain) {
    InteractiveSession::Setup wanted = setup(16);
    InteractiveSession session(wanted);
    session.view(viewOf(ViewMode::Picture));
    ASSERT_TRUE(reaches(session, isRaw));
    EXPECT_EQ(session.state().settings.replicates, 1u);
    wanted.request.halves = true;
    session.change(wanted.request);
    ASSERT_TRUE(reaches(session, isFinal));
    EXPECT_EQ(session.state().settings.replicates, 2u);
}

TEST_F(InteractiveDenoiseTest, ShowsBothHalvesTheErrorAndTheBandwidth) {
    InteractiveSession session(denoising(16));
    std::optional<image::Image> halves[2];
    for (const bool isDenoised : {true, false}) {
        for (int i = 0; i < 2; ++i) {
            session.view(viewOf(i == 0 ? ViewMode::HalfA : ViewMode::HalfB, isDenoised));
            ASSERT_TRUE(reaches(session, [&](const SessionState& s) {
                if (!(isDenoised ? isFinal(s) : isRaw(s)) || s.picture.image == s.picture.radiance) return false;
                return i == 0 || s.picture.image->data != halves[0]->data;
            }));
            halves[i] = *session.state().picture.image;
        }
        if (isDenoised) continue;
        const image::Image raw = *session.state().picture.radiance;
        for (std::size_t i = 0; i < raw.data.size(); ++i)
            ASSERT_NEAR(0.5f * (halves[0]->data[i] + halves[1]->data[i]), raw.data[i], 1e-5f);
    }
    const auto legend = [](const SessionState& s) { return s.picture.legend.has_value(); };
    session.view(viewOf(ViewMode::DenoisedError));
    ASSERT_TRUE(reaches(session, legend));
    EXPECT_EQ(session.state().picture.legend->quantity, Legend::Quantity::DenoisedError);
    session.view(viewOf(ViewMode::Bandwidth));
    ASSERT_TRUE(reaches(session, [&](const SessionState& s) {
        return legend(s) && s.picture.legend->quantity == Legend::Quantity::Bandwidth;
    }));
    for (const float chosen : session.state().picture.values->data) {
        EXPECT_GE(chosen, 0);
        EXPECT_LE(chosen, static_cast<float>(image::kDenoiseCandidates - 1));
    }
}

TEST_F(InteractiveDenoiseTest, SavesWhatIsAskedFor) {
    InteractiveSession session(denoising(16));
    session.view(viewOf(ViewMode::Picture));
    ASSERT_TRUE(reaches(session, isFinal));
    const auto save = [&](const std::string& name, SavedPicture what) {
        SaveRequest request;
        request.files = {(folder_ / name).string()};
        request.what = what;
        const std::uint64_t before = session.state().messageSerial;
        session.save(request);
        return reaches(session, [&](const SessionState& s) { return s.messageSerial > before; });
    };
    ASSERT_TRUE(save("raw.pfm", SavedPicture::Raw));
    ASSERT_TRUE(save("denoised.pfm", SavedPicture::Denoised));
    ASSERT_TRUE(save("both.pfm", SavedPicture::Both));
    const auto read = [&](const char* name) { return image::readImage(folder_ / name).data; };
    const SessionState state = session.state();
    EXPECT_EQ(read("raw.pfm"), state.picture.radiance->data);
    EXPECT_EQ(read("denoised.pfm"), state.picture.image->data); // what is seen
    EXPECT_EQ(read("both.pfm"), read("raw.pfm"));
    EXPECT_EQ(read("both.denoised.pfm"), read("denoised.pfm"));
}

// Its filter takes until it is called off.
class EndlessFilterEngine : public SlowEngine {
  public:
    inline static std::atomic<int> started{0}, calledOff{0};

    std::unique_ptr<PictureDenoiser> makeDenoiser() override {
        class Endless : public PictureDenoiser {
            std::optional<DenoisedPicture> denoise(const DenoiseRequest&, const std::atomic<bool>& cancel) override {
                ++started;
                while (!cancel) std::this_thread::sleep_for(std::chrono::milliseconds(1));
                ++calledOff;
                return std::nullopt;
            }
        };
        return std::make_unique<Endless>();
    }
};

TEST_F(InteractiveDenoiseTest, WhateverIsWantedCallsTheFilterOff) {
    InteractiveSession::Setup wanted = denoising(4);
    wanted.makeEngine = [](const EngineChoice&) { return std::make_unique<EndlessFilterEngine>(); };
    InteractiveSession session(wanted);
    session.view(viewOf(ViewMode::Picture, false));
    ASSERT_TRUE(reaches(session, isFinished));
    session.view(viewOf(ViewMode::Picture));
    const auto isBusy = [](int times) {
        return [times](const SessionState&) { return EndlessFilterEngine::started >= times; };
    };
    ASSERT_TRUE(reaches(session, isBusy(1)));
    session.view(viewOf(ViewMode::Albedo));
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.picture.isDisplay; }));
    session.view(viewOf(ViewMode::Picture, false));
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return !s.picture.isDisplay; }));
    EXPECT_GT(EndlessFilterEngine::calledOff, 0);
    const int before = EndlessFilterEngine::started;
    session.view(viewOf(ViewMode::Picture));
    ASSERT_TRUE(reaches(session, isBusy(before + 1)));
    session.close(); // ends, too
}

// Its live pictures are those of any film.
class UndemandingEngine : public SlowEngine {
  public:
    std::unique_ptr<PictureDenoiser> makeDenoiser() override {
        class Undemanding : public PictureDenoiser {
            bool needsHalves() const override { return false; }
            std::optional<DenoisedPicture> denoise(const DenoiseRequest& request, const std::atomic<bool>&) override {
                if (request.quality == DenoiseQuality::Final) return std::nullopt;
                DenoisedPicture made;
                made.quality = request.quality;
                made.images.picture = image::Image(24, 24);
                return made;
            }
        };
        return std::make_unique<Undemanding>();
    }
};

TEST_F(InteractiveDenoiseTest, AFilmOfOneSampleHasALivePictureWhereThatNeedsNoHalves) {
    for (const bool needsHalves : {false, true}) {
        InteractiveSession::Setup wanted = denoising(1);
        if (!needsHalves) wanted.makeEngine = [](const EngineChoice&) { return std::make_unique<UndemandingEngine>(); };
        InteractiveSession session(wanted);
        session.view(viewOf(ViewMode::Picture));
        ASSERT_TRUE(reaches(session, isFinished));
        EXPECT_EQ(session.state().settings.replicates, 1u);
        EXPECT_EQ(session.state().picture.isDenoised, !needsHalves);
        EXPECT_EQ(session.state().picture.isLive, !needsHalves);
    }
}

// Says that it fails; the render goes on without it.
class NoFeaturesEngine : public SlowEngine {
  public:
    NoFeaturesEngine() { aovsFail = true; }
};

TEST_F(InteractiveDenoiseTest, AFilterThatFailsLeavesTheRenderAlone) {
    InteractiveSession::Setup wanted = denoising(16);
    wanted.makeEngine = [](const EngineChoice&) { return std::make_unique<NoFeaturesEngine>(); };
    InteractiveSession session(wanted);
    session.view(viewOf(ViewMode::Picture));
    ASSERT_TRUE(reaches(session, isRaw));
    ASSERT_EQ(session.state().errors.size(), 1u); // once
    EXPECT_EQ(session.state().errors[0].text, "no features");
}

TEST(FilmPlanHalves, TheReplicatesAreEvenInNumberWhereThereAreSamplesForThem) {
    const scene::CompiledScene scene;
    const auto replicatesOf = [&](std::uint32_t spp, std::uint32_t asked) {
        RenderRequest request;
        request.halves = true;
        request.settings.spp = spp;
        request.settings.replicates = asked;
        return filmSettings(request, scene, 0, false, {}).replicates;
    };
    EXPECT_EQ(replicatesOf(100, 1), 2u);
    EXPECT_EQ(replicatesOf(100, 3), 4u);
    EXPECT_EQ(replicatesOf(3, 3), 2u);
    EXPECT_EQ(replicatesOf(1, 1), 1u);
}

// A slower filter makes smaller drafts, not later ones: with two samples of each pixel 2 p / speed + p filter = 0.02 s.
TEST(FilmPlanHalves, ADenoisedDraftTakesNoLonger) {
    RenderSettings film;
    film.replicates = 2;
    RenderSpeed speed;
    speed.learn(200'000, 1, 1);
    for (const double filter : {0.0, 1e-6, 1e-5}) {
        const auto draft = draftSettings(film, speed, filter);
        ASSERT_TRUE(draft);
        EXPECT_EQ(draft->replicates, 2u);
        EXPECT_EQ(draft->spp, 2u);
        const double pixels = static_cast<double>(draft->width) * draft->height;
        const double seconds = pixels * (2 / speed.samplesIn(1) + filter);
        EXPECT_LE(seconds, 0.02);
        EXPECT_GT(seconds, 0.018); // but for the rounding of both sides
    }
    EXPECT_EQ(draftSettings(film, speed)->replicates, 1u); // one that is not denoised
}

} // namespace
} // namespace rt::app
