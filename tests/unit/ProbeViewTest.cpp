// A probe that is watched: what it answers is what a run by itself gives, the newest wish is answered, and what is
// saved is what ray-tracing-image writes.
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "Common/Probe/ProbeReport.h"
#include "tests/FileBytes.h"
#include "tests/TempFolder.h"
#include "tests/unit/ProbedRoom.h"

namespace rt::probe {
namespace {

class ProbeViews : public testing::Test {
  protected:
    ProbeViews() : scene_(test::compiled(test::probedRoom())) {}

    using State = std::shared_ptr<const ProbeState>;
    template <class Condition>
    bool eventually(const Condition& condition) {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, std::chrono::minutes(5), condition);
    }
    State answerTo(const ProbeWish& wish) {
        const auto isAnswered = [&] {
            const State state = view_.state();
            return state && state->wish == wish && (state->result.isDone || !state->whyNot.empty());
        };
        EXPECT_TRUE(eventually(isAnswered));
        return view_.state();
    }
    ProbeWish usual() const {
        ProbeWish wish = test::middleOf(scene_);
        wish.settings.rows = 32;
        wish.settings.samples = 1000;
        wish.settings.numbers.seed = 9;
        return wish;
    }
    // Not done in this test's life.
    ProbeWish endless() const {
        ProbeWish wish = usual();
        wish.settings.quantity = Quantity::Radiance;
        wish.settings.rows = 512;
        wish.settings.paths = 65536;
        return wish;
    }
    static ProbeResult alone(const ProbeWish& wish) {
        const SceneFormulas formulas(wish.scene, test::optionsFor(wish.rendering), 0.0);
        const auto probe = Probe::at(formulas, wish.pixel[0], wish.pixel[1]);
        ProbeRun run(*probe, wish.settings);
        while (!run.isDone()) run.advance();
        return run.result();
    }

    std::shared_ptr<const scene::CompiledScene> scene_;
    std::mutex mutex_;
    std::condition_variable changed_;
    ProbeView view_{[this] {
        { const std::scoped_lock lock(mutex_); }
        changed_.notify_all();
    }};
};

TEST_F(ProbeViews, AnswersWhatARunGivesBitForBit) {
    for (const Quantity quantity : {Quantity::Density, Quantity::Product}) {
        ProbeWish wish = usual();
        wish.settings.quantity = quantity;
        wish.settings.showsStrata = true;
        view_.wish(wish);
        const ProbeResult shown = answerTo(wish)->result, expected = alone(wish);
        EXPECT_EQ(figuresOf(shown, "a", wish.pixel), figuresOf(expected, "a", wish.pixel));
        EXPECT_EQ(shown.density.values, expected.density.values);
        EXPECT_EQ(shown.maps.front().values, expected.maps.front().values);
        ASSERT_EQ(shown.shown.size(), expected.shown.size());
        for (std::size_t i = 0; i < shown.shown.size(); ++i)
            EXPECT_EQ(shown.shown[i].direction, expected.shown[i].direction);
        EXPECT_EQ(shown.edges, expected.edges);
    }
}

TEST_F(ProbeViews, TheNewestWishIsAnswered) {
    view_.wish(endless());
    for (std::uint32_t x = 10; x < 30; ++x) { // a point that is dragged
        ProbeWish wish = endless();
        wish.pixel[0] = x;
        view_.wish(wish);
    }
    const ProbeWish last = usual();
    view_.wish(last);
    EXPECT_EQ(figuresOf(answerTo(last)->result, "a", last.pixel), figuresOf(alone(last), "a", last.pixel));
}

TEST_F(ProbeViews, ThereIsSomethingToShowBeforeItIsDone) {
    view_.wish(endless());
    ASSERT_TRUE(eventually([this] { return view_.state() != nullptr; }));
    const State state = view_.state();
    EXPECT_FALSE(state->result.isDone);
    EXPECT_EQ(state->result.shown.size(), ProbeResult::kShown);
    ASSERT_EQ(state->result.maps.size(), 1u);
    EXPECT_GT(state->result.maps.front().maximum(), 0);
}

TEST_F(ProbeViews, ASceneThatIsEditedIsAnotherWish) {
    view_.wish(usual());
    const double before = answerTo(usual())->result.estimates.front().mean;
    scene::SceneDesc brighter = test::probedRoom();
    brighter.materials["lamp"].emission = glm::dvec3(18);
    const auto first = scene_;
    scene_ = test::compiled(brighter);
    view_.wish(usual());
    EXPECT_NEAR(answerTo(usual())->result.estimates.front().mean, 2 * before, 1e-3 * before);
    view_.wish(std::nullopt);
    EXPECT_EQ(view_.state(), nullptr);
}

TEST_F(ProbeViews, WhatCannotBeProbedIsSaid) {
    ProbeWish wish = usual();
    wish.pixel = {0, 0};
    view_.wish(wish);
    EXPECT_EQ(answerTo(wish)->whyNot, "The pixel shows no surface");
    wish = usual();
    wish.settings.strategy = {StrategyKind::Light, 77};
    view_.wish(wish);
    EXPECT_EQ(answerTo(wish)->whyNot, "The scene has no light 77");
    wish = usual();
    wish.camera.lookAt = wish.camera.lookFrom;
    view_.wish(wish);
    EXPECT_FALSE(answerTo(wish)->whyNot.empty());
    view_.wish(usual());
    EXPECT_TRUE(answerTo(usual())->whyNot.empty()) << "it goes on";
}

TEST_F(ProbeViews, SavesPictureAndFigures) {
    const test::TempFolder folder;
    const auto saved = [&](const std::string& file) {
        view_.save(file, usual());
        std::optional<ProbeSaved> outcome;
        while (!(outcome = view_.takeSaved())) std::this_thread::yield();
        return *outcome;
    };
    const std::string file = (folder / "point.png").string();
    EXPECT_EQ(saved(file).error, "");
    ProbeWish wish = usual();
    wish.settings.projections = {Projection::Sphere, Projection::Hemisphere};
    const ProbeResult expected = alone(wish);
    writePicture((folder / "expected.png").string(), expected);
    EXPECT_EQ(test::bytesOfFile(folder / "point.png"), test::bytesOfFile(folder / "expected.png"));
    std::ifstream in(folder / "point.json");
    EXPECT_EQ(nlohmann::ordered_json::parse(in), figuresOf(expected, "room", wish.pixel));
    EXPECT_NE(saved((folder / "nowhere" / "point.png").string()).error, "");
}

} // namespace
} // namespace rt::probe
