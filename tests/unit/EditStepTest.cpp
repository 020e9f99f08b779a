// Edits as text, and what users do again: from the text comes what the edits were.
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Scene/Edit/EditCheck.h"
#include "Common/Scene/Edit/EditStep.h"
#include "Common/Scene/Edit/EditText.h"
#include "Common/Scene/Json/JsonText.h"
#include "tests/unit/EditedScenes.h"

namespace rt::scene {
namespace {

SceneEdit readBack(const SceneEdit& edit) {
    const std::string text = toText(edit), file = "kept";
    EXPECT_EQ(text.find('\n'), text.npos);
    const LargeJson json(parseJson(text, file));
    return parseEdit(JsonNode(*json, file));
}

// Edits are alike where they make the same of a scene.
void expectSame(SceneDesc scene, SceneEdit edit) {
    checkEdit(scene, edit);
    SceneDesc other = scene;
    SceneEdit again = readBack(edit);
    EXPECT_EQ(again.index(), edit.index());
    exchange(scene, edit);
    exchange(other, again);
    EXPECT_TRUE(scene == other) << toText(edit);
}

TEST(EditTextTest, EachKindReadsBackAsItWas) {
    SceneDesc scene = sceneOfMeshes();
    scene.textures["map"] = CheckerTexture{};
    scene.materials["unused"] = lambertian(0.1, 0.2, 0.3);
    MaterialDesc textured = lambertian(0, 0, 0);
    textured.albedo = std::string("map");
    CheckerTexture checker;
    checker.even = std::string("map");
    MediumDesc fog;
    fog.boundary = SphereBoundary{};
    fog.albedo = std::string("map");
    SceneEdit wrap = WrapObject{{"", {0}}, Transform{Scale{{1, 1.0 / 3, 1}}}, true};
    const SceneEdit edits[] = {SetObject{{"", {0}}, scene.objects[1]},
                               SetTransform{{"", {3}}, {Matrix{}, Translate{{0.1, -0.0, 1e-9}}}},
                               SetMaterialOf{{"hill", {0}}, "lamp"},
                               SetHidden{{"", {2, 0}}, true},
                               PlaceObject{{"", {7}}, ObjectDesc{fog}},
                               PlaceObject{{"", {1}}, std::nullopt},
                               PlaceObject{{"", {0}}, scene.objects[2]},
                               PlaceObject{{"", {0}}, scene.objects[4]},
                               wrap,
                               WrapObject{{"", {2}}, std::nullopt},
                               SetMaterial{"gold \"24\"\n", textured},
                               SetMaterial{"unused", std::nullopt},
                               SetTexture{"other", checker},
                               SetTexture{"map", std::nullopt},
                               SetPrototype{"pair", std::vector<ObjectDesc>{scene.objects[0], scene.objects[3]}},
                               SetCamera{{{1, 2, 3}, {0, 0, 0}, {0, 1, 0}, 33.3, 0.5, 7}},
                               SetBackground{GradientBackground{}},
                               SetRenderDefaults{{1.7}},
                               SetTargets{{TargetDesc{SphereBoundary{{1, 0, 0}, 2}}}},
                               SetTitle{"Another"}};
    for (const SceneEdit& edit : edits) expectSame(scene, edit);
}

TEST(EditTextTest, WhatIsNoEditIsRefused) {
    for (const char* text : {R"({})", R"({"edit": "explode"})", R"({"edit": "hidden", "prototype": "", "place": []})",
                             R"({"edit": "object", "prototype": "", "place": [0]})", R"({"edit": "title", "more": 1})",
                             R"({"edit": "material", "name": "a", "scene": {"objects": []}})"}) {
        const std::string file = "kept";
        const LargeJson json(parseJson(text, file));
        EXPECT_THROW(parseEdit(JsonNode(*json, file)), InputError) << text;
    }
}

// What a user does at random, written down as a window does, and done again.
TEST(EditStepTest, StepsLeadToTheSameDocument) {
    const SceneDesc first = sceneOfMeshes(3);
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        EditsOfMeshes edits(seed);
        SceneDocument document(first);
        std::vector<EditStep> unseen;
        std::vector<std::string> lines;
        std::uint64_t seenGesture = 0, gesture = 0;
        const auto note = [&](EditStep step) {
            repeat(document, step);
            appendStep(unseen, std::move(step), seenGesture);
        };
        for (int i = 0; i < 120; ++i) {
            const std::size_t what = edits.pick(10);
            if (what == 0) note({EditStep::Kind::Undo});
            if (what == 1) note({EditStep::Kind::Redo});
            if (what == 2) note({EditStep::Kind::Join, "Both"});
            if (what == 3) ++gesture;
            if (what == 4) note({EditStep::Kind::GiveUp, {}, {}, gesture});
            if (what >= 5) {
                const bool isHeld = edits.pick(2) == 0;
                note({EditStep::Kind::Perform, "Edit", {edits.next(document.scene())}, isHeld ? gesture : 0});
            }
            if (edits.pick(8) > 0 || unseen.empty()) continue;
            for (const EditStep& step : unseen) lines.push_back(toText(step));
            seenGesture = unseen.back().kind == EditStep::Kind::Perform ? unseen.back().gesture : 0;
            unseen.clear();
        }
        for (const EditStep& step : unseen) lines.push_back(toText(step));
        SceneDocument again(first);
        for (const std::string& line : lines) repeat(again, parseStep(line, "kept"));
        ASSERT_TRUE(again.scene() == document.scene()) << seed;
        ASSERT_EQ(again.position(), document.position()) << seed;
        ASSERT_EQ(again.stepCount(), document.stepCount()) << seed;
        while (again.redo() && document.redo()) {
        }
        EXPECT_TRUE(again.scene() == document.scene()) << seed;
        while (again.undo()) {
        }
        EXPECT_TRUE(again.scene() == first) << seed;
    }
}

TEST(EditStepTest, OfADragAndOfASliderOnlyTheEndIsKept) {
    std::vector<EditStep> steps;
    const auto move = [](double x) {
        return EditStep{EditStep::Kind::Perform, "Move", {SetTransform{{"", {3}}, {Translate{{x, 0, 0}}}}}, 5};
    };
    appendStep(steps, {EditStep::Kind::Perform, "Hide", {SetHidden{{"", {0}}, true}}}, 0);
    for (int i = 0; i < 100; ++i) {
        appendStep(steps, {EditStep::Kind::GiveUp, {}, {}, 5}, 0);
        appendStep(steps, move(i), 0);
    }
    ASSERT_LE(steps.size(), 3u); // with what gives up what had not begun
    EXPECT_EQ(std::get<Translate>(std::get<SetTransform>(steps.back().edits[0]).transform[0]).offset.x, 99);
    for (int i = 0; i < 100; ++i) appendStep(steps, move(-i), 0);
    EXPECT_LE(steps.size(), 3u);
    // What somebody has seen of the gesture is taken back there.
    std::vector<EditStep> later;
    appendStep(later, move(1), 5);
    appendStep(later, {EditStep::Kind::GiveUp, {}, {}, 5}, 5);
    ASSERT_EQ(later.size(), 1u);
    EXPECT_EQ(later[0].kind, EditStep::Kind::GiveUp);
}

} // namespace
} // namespace rt::scene
