// A scene that is edited while it is rendered: what the session shows, what it keeps, and what is saved.
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "Common/App/Interactive/SceneEditor.h"
#include "Common/Core/Error.h"
#include "Common/Scene/Edit/ObjectMotion.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/unit/InteractiveFixture.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScene = R"({
  "version": 1, "title": "Two balls", "camera": {"look_from": [0, 0, 5], "look_at": [0, 0, 0]},
  "background": {"type": "constant", "color": [1, 1, 1]},
  "materials": {"m": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}},
  "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "m"},
              {"type": "sphere", "center": [2, 0, 0], "center_end": [2, 1, 0], "radius": 0.5, "material": "m"}]})";

class SceneEditorTest : public InteractiveFixture {
  protected:
    SceneEditorTest() : file_(folder_.path() / "balls.json") {
        std::ofstream(file_) << kScene;
        auto setup = InteractiveFixture::setup(64);
        setup.scene.source = file_.string();
        session_.emplace(std::move(setup));
        editor_.emplace(*session_, "");
        EXPECT_TRUE(reaches(*session_, [](const SessionState& state) { return state.sceneLoads == 1; }));
    }
    // As a window does each frame.
    bool follows(const std::function<bool(const SessionState&)>& condition) {
        return reaches(*session_, [&](const SessionState& state) {
            editor_->follow(state);
            return condition(state);
        });
    }
    bool begin() {
        editor_->follow(session_->state());
        editor_->begin();
        return follows([this](const SessionState&) { return editor_->document() != nullptr; });
    }
    void move(std::uint32_t object, double x, std::uint64_t gesture = 0) {
        const auto edit = moved(editor_->document()->scene(), {"", {object}}, {scene::Translate{{x, 0, 0}}});
        editor_->perform("Move", {edit}, gesture);
    }
    // The middle of the first ball, as it is rendered.
    static double placeOf(const SessionState& state) {
        return state.scene->origin.x + static_cast<double>(state.scene->spheres[0].center.x);
    }
    static std::string textOf(const fs::path& file) {
        std::stringstream text;
        text << std::ifstream(file).rdbuf();
        return text.str();
    }

    fs::path file_;
    std::optional<InteractiveSession> session_;
    std::optional<SceneEditor> editor_;
};

TEST_F(SceneEditorTest, WhatIsEditedIsRenderedFromTheSameCamera) {
    ASSERT_TRUE(begin());
    const SessionState before = session_->state();
    scene::CameraDesc camera = before.scene->camera;
    camera.lookFrom = {1, 2, 5};
    session_->moveCamera(camera, before.sceneSerial);
    move(0, 3);
    editor_->perform("Camera", {scene::SetCamera{camera}}); // of the scene: what is seen stays
    ASSERT_TRUE(follows([](const SessionState& state) { return state.sceneEdits == 2; }));
    const SessionState after = session_->state();
    EXPECT_NEAR(placeOf(after), 3, 1e-6);
    EXPECT_EQ(after.sceneSerial, before.sceneSerial) << "the camera is that of the window";
    EXPECT_EQ(after.settings, before.settings);
    EXPECT_EQ(after.source, before.source);
    EXPECT_TRUE(follows([](const SessionState& state) { return state.status.samplesDone > 0; }));
    editor_->undo();
    editor_->undo();
    EXPECT_FALSE(editor_->isDirty());
    ASSERT_TRUE(follows([](const SessionState& state) { return state.sceneEdits == 4; }));
    EXPECT_EQ(session_->state().scene->hash, before.scene->hash);
}

// Of a drag the last place is what is shown in the end, whatever is shown in between; one undo leads back.
TEST_F(SceneEditorTest, ADragEndsWhereThePointerDoes) {
    ASSERT_TRUE(begin());
    const std::uint64_t gesture = editor_->newGesture();
    for (int i = 1; i <= 200; ++i) {
        const auto edit = [i](const scene::SceneDesc& scene) {
            return std::vector{moved(scene, {"", {0}}, {scene::Translate{{0.01 * i, 0, 0}}})};
        };
        editor_->performAnew("Move", edit, gesture);
        if (i % 20 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ASSERT_TRUE(follows([](const SessionState& state) { return state.sceneEdits == 200; }));
    EXPECT_NEAR(placeOf(session_->state()), 2, 1e-6);
    EXPECT_EQ(editor_->document()->stepCount(), 1u);
    editor_->giveUp(gesture);
    ASSERT_TRUE(follows([](const SessionState& state) { return state.sceneEdits == 201; }));
    EXPECT_EQ(placeOf(session_->state()), 0);
    EXPECT_EQ(editor_->document()->stepCount(), 0u);
}

// A moving sphere cannot be scaled along an axis, which the compiler alone finds.
TEST_F(SceneEditorTest, ASceneThatCannotBeCompiledLeavesTheOneBefore) {
    ASSERT_TRUE(begin());
    move(0, 1);
    ASSERT_TRUE(follows([](const SessionState& state) { return state.sceneEdits == 1; }));
    const auto bad = moved(editor_->document()->scene(), {"", {1}}, scene::scaled({0, 0, 0}, {1, 2, 1}));
    editor_->perform("Scale", {bad});
    ASSERT_TRUE(follows([](const SessionState& state) { return !state.errors.empty(); }));
    const SessionState failed = session_->state();
    EXPECT_NE(failed.errors.back().text.find("a moving sphere can be scaled uniformly only"), std::string::npos);
    EXPECT_EQ(failed.sceneEdits, 1u);
    EXPECT_EQ(failed.sceneFailures, 0u) << "the file is well";
    EXPECT_NEAR(placeOf(failed), 1, 1e-6);
    editor_->undo();
    ASSERT_TRUE(follows([](const SessionState& state) { return state.sceneEdits == 3; }));
    EXPECT_NEAR(placeOf(session_->state()), 1, 1e-6);
}

TEST_F(SceneEditorTest, WhatIsRefusedChangesNothing) {
    ASSERT_TRUE(begin());
    EXPECT_THROW(editor_->perform("Delete", {scene::SetMaterial{"m", {}}}), InputError);
    EXPECT_FALSE(editor_->isDirty());
    editor_->select(scene::ObjectPath{"", {1}});
    EXPECT_TRUE(editor_->selection());
    editor_->perform("Delete", {scene::PlaceObject{{"", {1}}, {}}});
    EXPECT_FALSE(editor_->selection()) << "it is gone";
    editor_->select(scene::ObjectPath{"", {5}});
    EXPECT_FALSE(editor_->selection());
}

TEST_F(SceneEditorTest, BoundsAreThoseOfThePicture) {
    ASSERT_TRUE(begin());
    editor_->select(scene::ObjectPath{"", {1}});
    const scene::Bounds bounds = editor_->outline(session_->state()).all;
    EXPECT_NEAR(bounds.lower.x, 1.5, 1e-6);
    EXPECT_NEAR(bounds.upper.y, 1.5, 1e-6); // where it is at time 1
    editor_->toggle({"", {0}});
    const SelectionOutline both = editor_->outline(session_->state());
    ASSERT_EQ(both.boxes.size(), 2u);
    EXPECT_NEAR(both.boxes[0].lower.x, -1, 1e-6);
    EXPECT_NEAR(both.all.lower.x, -1, 1e-6);
    EXPECT_EQ(both.all.upper.y, both.boxes[1].upper.y);
    editor_->toggle({"", {0}});
    editor_->perform("Delete", {scene::PlaceObject{{"", {0}}, {}}});
    EXPECT_EQ(editor_->selection(), (scene::ObjectPath{"", {0}})) << "the second object is the first one now";
    EXPECT_TRUE(editor_->outline(session_->state()).boxes.empty()) << "the picture's objects are others";
    ASSERT_TRUE(follows([this](const SessionState& state) { return editor_->isUpToDate(state); }));
    EXPECT_NEAR(editor_->outline(session_->state()).all.lower.x, 1.5, 1e-6);
}

// Media and lights have no surfaces: they are where they are described to be.
TEST_F(SceneEditorTest, WhatHasNoSurfaceIsOutlinedToo) {
    ASSERT_TRUE(begin());
    scene::MediumDesc medium;
    medium.boundary = scene::SphereBoundary{{0, 3, 0}, 0.5};
    editor_->perform("Add", {scene::PlaceObject{{"", {2}}, scene::ObjectDesc{medium}},
                             scene::PlaceObject{{"", {3}}, scene::ObjectDesc{scene::PointLightDesc{{1, 7, 1}}}}});
    editor_->select({{"", {2}}, {"", {3}}}, {"", {3}});
    const SelectionOutline outline = editor_->outline(session_->state());
    ASSERT_EQ(outline.boxes.size(), 1u);
    EXPECT_EQ(outline.boxes[0].lower, glm::dvec3(-0.5, 2.5, -0.5));
    EXPECT_EQ(outline.lights, std::vector<glm::dvec3>(1, glm::dvec3(1, 7, 1)));
    EXPECT_EQ(outline.all.upper, glm::dvec3(1, 7, 1));
}

TEST_F(SceneEditorTest, SavedFilesHoldWhatIsSeen) {
    ASSERT_TRUE(begin());
    move(0, 3);
    EXPECT_TRUE(editor_->isDirty());
    const fs::path other = folder_.path() / "other.json";
    editor_->save(other.string());
    ASSERT_TRUE(follows([this](const SessionState&) { return editor_->takeSaved().has_value(); }));
    EXPECT_FALSE(editor_->isDirty());
    ASSERT_TRUE(follows([&](const SessionState& state) { return state.source == other.string(); }));
    ASSERT_NE(editor_->document(), nullptr) << "and it is still edited";
    EXPECT_EQ(scene::loadSceneFile(other).objects, editor_->document()->scene().objects);
    EXPECT_EQ(textOf(file_), kScene);
    EXPECT_EQ(session_->state().sourceMark, markOf(other.string())) << "the window need not read it again";
    move(0, 1);
    ASSERT_TRUE(follows([](const SessionState& state) { return placeOf(state) > 3.5; }));
    EXPECT_EQ(session_->state().source, other.string());
    editor_->save((folder_.path() / "missing" / "x.json").string());
    const auto fails = [this](const SessionState&) { return !editor_->isSaving(); };
    EXPECT_THROW(follows(fails), Error);
    EXPECT_TRUE(editor_->isDirty()) << "it is not saved";
}

TEST_F(SceneEditorTest, AnotherSceneEndsIt) {
    ASSERT_TRUE(begin());
    move(0, 3);
    session_->open("one-weekend-test");
    ASSERT_TRUE(follows([this](const SessionState&) { return editor_->document() == nullptr; }));
    EXPECT_FALSE(editor_->isDirty());
    ASSERT_TRUE(begin());
    EXPECT_EQ(editor_->document()->scene().title, session_->state().scene->title);
    move(1, 0.5);
    const std::uint64_t edits = 2;
    EXPECT_TRUE(follows([=](const SessionState& state) { return state.sceneEdits == edits; }));
    EXPECT_EQ(session_->state().source, "one-weekend-test");
}

} // namespace
} // namespace rt::app
