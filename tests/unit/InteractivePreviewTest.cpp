// A window with ray tracing switched off.
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "Common/Image/ImageIo.h"
#include "tests/unit/InteractiveFixture.h"

namespace rt::app {
namespace {

using namespace std::chrono_literals;

// Draws a grey that tells from where.
class DrawingEngine : public SlowEngine {
  public:
    inline static std::atomic<int> drawn{0};
    bool canPreview() const override { return true; }
    Preview renderPreview(const scene::CameraDesc& camera, std::uint32_t width, std::uint32_t height) override {
        ++drawn;
        Preview preview{image::Image(width, height, 3), image::Image(width, height, 1)};
        preview.picture.data.assign(preview.picture.data.size(), static_cast<float>(camera.lookFrom.x));
        preview.depth.data.assign(preview.depth.data.size(), 8.0f);
        return preview;
    }
};

class InteractivePreviewTest : public InteractiveFixture {};

TEST_F(InteractivePreviewTest, ThePreviewLeavesTheFilmAsItIsAndRaysRest) {
    InteractiveSession::Setup s = setup(1'000'000);
    s.makeEngine = [](const EngineChoice&) { return std::make_unique<DrawingEngine>(); };
    InteractiveSession session(s);
    const auto isPreview = [](const SessionState& state) { return state.picture.isPreview; };
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.picture.spp > 0; }));
    EXPECT_TRUE(session.state().canPreview);
    session.preview(true);
    ASSERT_TRUE(reaches(session, isPreview));
    const SessionState before = session.state();
    const int films = SlowEngine::films, drawn = DrawingEngine::drawn;
    EXPECT_EQ(before.picture.image->width, 24u);
    EXPECT_EQ(before.picture.image->data[0], static_cast<float>(before.scene->camera.lookFrom.x));
    std::this_thread::sleep_for(30ms);
    session.pause(); // rests already
    session.pickFocus(12, 12);
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.focusSerial == 1; }));
    EXPECT_EQ(session.state().picture.serial, before.picture.serial); // neither drawn again nor rendered on
    session.save({.files = {(folder_ / "preview.exr").string()}});
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.messageSerial == 1; }));
    EXPECT_EQ(image::readImage((folder_ / "preview.exr").string()).data, before.picture.image->data);
    session.renderReference(4);
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.errorSerial == 1; }));

    session.preview(false); // the film goes on
    ASSERT_TRUE(reaches(session, [&](const SessionState& state) {
        return !state.picture.isPreview && state.picture.spp > before.status.samplesDone / (24 * 24);
    }));
    EXPECT_EQ(SlowEngine::films, films);
    EXPECT_EQ(DrawingEngine::drawn, drawn);

    session.preview(true);
    ASSERT_TRUE(reaches(session, isPreview));
    scene::CameraDesc camera = before.scene->camera;
    camera.lookFrom.x = 77;
    session.moveCamera(camera, before.sceneSerial);
    EXPECT_TRUE(reaches(session, [](const SessionState& state) { return state.picture.image->data[0] == 77; }));
    EXPECT_EQ(SlowEngine::films, films);
    session.preview(false); // another film
    EXPECT_TRUE(reaches(session, [](const SessionState& state) { return !state.picture.isPreview; }));
    EXPECT_TRUE(reaches(session, [](const SessionState& state) { return state.picture.spp > 0; }));
    EXPECT_GT(SlowEngine::films, films);
}

TEST_F(InteractivePreviewTest, APreviewFromTheBeginningNeedsNoRay) {
    InteractiveSession::Setup s = setup(4);
    s.makeEngine = [](const EngineChoice&) { return std::make_unique<DrawingEngine>(); };
    s.preview = true;
    const int films = SlowEngine::films;
    InteractiveSession session(s);
    EXPECT_TRUE(reaches(session, [](const SessionState& state) { return state.picture.isPreview; }));
    EXPECT_EQ(SlowEngine::films, films);
    EXPECT_EQ(session.state().settings.width, 24u);
}

// As many pixels as suit the window; files have those of the picture.
TEST_F(InteractivePreviewTest, ThePreviewSuitsTheWindowAndItsFilesThePicture) {
    InteractiveSession::Setup s = setup(4);
    s.makeEngine = [](const EngineChoice&) { return std::make_unique<DrawingEngine>(); };
    s.preview = true;
    InteractiveSession session(s);
    session.previewWidth(100);
    ASSERT_TRUE(reaches(
        session, [](const SessionState& state) { return state.picture.image && state.picture.image->width == 100; }));
    EXPECT_EQ(session.state().picture.image->height, 100u);
    session.save({.files = {(folder_ / "preview.exr").string()}});
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.messageSerial == 1; }));
    EXPECT_EQ(image::readImage((folder_ / "preview.exr").string()).width, 24u);
    session.pickFocus(99, 99); // of what is shown
    EXPECT_TRUE(reaches(session, [](const SessionState& state) { return state.focusSerial == 1; }));
    session.previewWidth(0);
    EXPECT_TRUE(reaches(session, [](const SessionState& state) { return state.picture.image->width == 24; }));
}

} // namespace
} // namespace rt::app
