// What the lines of progress and status and the picture's chips say, and what gives way where they have less room.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Gui/Panels/StatusTexts.h"
#include "Common/Scene/CompiledScene.h"

namespace rt::gui {
namespace {

using app::Activity;

// Every byte is as wide.
float widthOf(const std::string& text) {
    return static_cast<float>(text.size());
}

app::SessionState rendering(std::uint64_t samplesPerPixel) {
    app::SessionState state;
    state.activity = Activity::Rendering;
    state.settings.width = state.settings.height = 10;
    state.settings.spp = 64;
    state.status.samplesDone = 100 * samplesPerPixel;
    state.status.samplesTotal = 100 * 64;
    state.renderSeconds = 8;
    return state;
}

TEST(ProgressTexts, BarAndItsTextAreOfTheSameSamples) {
    const ProgressTexts texts = progressOf(rendering(16), 0);
    EXPECT_EQ(texts.share, 0.25f);
    EXPECT_EQ(texts.bar, "16 / 64 spp   25 %");
    EXPECT_EQ(texts.line, "rendering, 24 s left");
}

TEST(ProgressTexts, NothingButTheWholeIsAHundredPercent) {
    app::SessionState state = rendering(64);
    EXPECT_EQ(progressOf(state, 0).bar, "64 / 64 spp   100 %");
    --state.status.samplesDone;
    EXPECT_EQ(progressOf(state, 0).bar, "63 / 64 spp   99 %");
}

TEST(ProgressTexts, WhatIsPreparedHasMadeNoProgress) {
    app::SessionState state = rendering(64); // of the picture that is still shown
    state.activity = Activity::Finished;
    EXPECT_EQ(progressOf(state, 0).share, 1);
    state.stage = "Loading a";
    state.stageSeconds = 2;
    EXPECT_EQ(progressOf(state, 0).share, 0);
    EXPECT_EQ(progressOf(state, 0).bar, "preparing");
    EXPECT_EQ(progressOf(state, 0).line, "Loading a ... 2.00 s");
    state.stage.clear();
    state.activity = Activity::Preparing;
    EXPECT_EQ(progressOf(state, 0).share, 0);
    EXPECT_EQ(progressOf(state, 0).bar, "preparing");
}

TEST(ProgressTexts, ABudgetOfTimeBoundsTheTimeLeft) {
    EXPECT_EQ(progressOf(rendering(16), 10).line, "rendering, 2 s left");
    EXPECT_EQ(progressOf(rendering(16), 100).line, "rendering, 24 s left");
    EXPECT_EQ(progressOf(rendering(16), 5).line, "rendering, 2 s left"); // it has gone on: as much again
}

TEST(ProgressTexts, APreviewHasNoTimeLeft) {
    app::SessionState state = rendering(16);
    state.picture.isPreview = true;
    EXPECT_EQ(progressOf(state, 0).line, "preview: ray tracing is off");
}

TEST(ChipTexts, SayWhatThePictureIs) {
    using Texts = std::vector<std::string>;
    app::SessionState state = rendering(20);
    state.report.engine = "multi";
    EXPECT_EQ(chipTexts(state, false, true), (Texts{"CPU multi", "draft", "8.00 s"}));
    state.picture.spp = 16; // the render is four samples further
    EXPECT_EQ(chipTexts(state, false, true), (Texts{"CPU multi", "16 spp", "8.00 s"}));
    EXPECT_EQ(chipTexts(state, false, false), (Texts{"CPU multi", "16 / 64 spp", "8.00 s"}));
    state.relmse = 0.05;
    EXPECT_EQ(chipTexts(state, true, true).back(), "relMSE 5.00e-02, estimated");
    state.curve.push_back({});
    EXPECT_EQ(chipTexts(state, true, true).back(), "relMSE 5.00e-02, measured");
    state.picture.isDenoised = state.picture.isLive = true;
    EXPECT_EQ(chipTexts(state, true, true)[3], "denoised, live");
    state.picture.isLive = false;
    EXPECT_EQ(chipTexts(state, true, true)[3], "denoised");
    state.denoisedRelmse = 0.002;
    EXPECT_EQ(chipTexts(state, true, true), (Texts{"GPU multi", "16 spp", "8.00 s", "raw relMSE 5.00e-02, measured",
                                                   "denoised relMSE 2.00e-03, measured"}));
    state.picture.isPreview = true;
    EXPECT_EQ(chipTexts(state, true, true), Texts{"GPU preview"});
}

TEST(StatusTexts, SayWhatIsRendered) {
    app::SessionState state = rendering(16);
    EXPECT_EQ(statusOf(state).title, "no scene");
    EXPECT_EQ(statusOf(state).engine, "starting");
    auto scene = std::make_shared<scene::CompiledScene>();
    scene->title = "A scene";
    state.scene = scene;
    state.report.engine = "multi";
    state.report.device = "A processor";
    const StatusParts parts = statusOf(state);
    EXPECT_EQ(fitStatus(parts, 1000, widthOf),
              "A scene   |   10 x 10   |   200 samples/s   |   multi   |   A processor");
}

TEST(StatusTexts, TheDeviceGivesWayFirstAndFiguresLast) {
    const StatusParts parts{"A long title", "600 x 600", "1.2 M samples/s", "multi", "Some processor"};
    const std::string figures = "600 x 600   |   1.2 M samples/s";
    EXPECT_EQ(fitStatus(parts, 83, widthOf), "A long title   |   " + figures + "   |   multi   |   Some processor");
    EXPECT_EQ(fitStatus(parts, 80, widthOf), "A long title   |   " + figures + "   |   multi   |   Some pro...");
    EXPECT_EQ(fitStatus(parts, 75, widthOf), "A long title   |   " + figures + "   |   multi");
    EXPECT_EQ(fitStatus(parts, 55, widthOf), "A long title   |   " + figures);
    EXPECT_EQ(fitStatus(parts, 47, widthOf), "A long...   |   " + figures);
    EXPECT_EQ(fitStatus(parts, 31, widthOf), figures);
    for (int width = 31; width < 90; ++width) {
        const std::string text = fitStatus(parts, static_cast<float>(width), widthOf);
        EXPECT_LE(text.size(), static_cast<std::size_t>(width));
        EXPECT_NE(text.find(figures), std::string::npos) << text;
    }
}

TEST(TextFit, LettersAreNotCutInTwo) {
    EXPECT_EQ(elided("abcdef", 6, widthOf), "abcdef");
    EXPECT_EQ(elided("abcdefg", 6, widthOf), "abc...");
    EXPECT_EQ(elided("a\xc3\xa4\xc3\xa4\xc3\xa4", 6, widthOf), "a\xc3\xa4..."); // a letter of two bytes
    EXPECT_EQ(elided("abc", 2, widthOf), "");
}

TEST(TextFit, LinesEndBetweenWordsAndTheLastOneByDots) {
    using Lines = std::vector<std::string>;
    EXPECT_EQ(elidedLines("one two three", 20, 2, widthOf), Lines{"one two three"});
    EXPECT_EQ(elidedLines("one two three", 8, 2, widthOf), (Lines{"one two", "three"}));
    EXPECT_EQ(elidedLines("one two three four", 8, 2, widthOf), (Lines{"one two", "three..."}));
    EXPECT_EQ(elidedLines("overlong", 6, 2, widthOf), Lines{"ove..."}); // no place to break it
    EXPECT_EQ(elidedLines("", 6, 2, widthOf), Lines{});
}

} // namespace
} // namespace rt::gui
