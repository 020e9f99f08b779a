// What a window writes, and what it compares its films with.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "Common/Image/ImageIo.h"
#include "tests/unit/GltfBuilder.h"
#include "tests/unit/InteractiveFixture.h"

namespace rt::app {
namespace {

class InteractiveFilesTest : public InteractiveFixture {};

TEST_F(InteractiveFilesTest, SavesWhatItShows) {
    InteractiveSession session(setup(4));
    ASSERT_TRUE(reaches(session, isFinished));
    const std::string exr = (folder_ / "a.exr").string();
    session.save({.files = {(folder_ / "a.png").string(), exr}});
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.messageSerial == 1; }));
    EXPECT_EQ(image::readImage(exr).data, session.state().picture.image->data);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "a.png"));
    session.save({.files = {(folder_ / "no/such/folder/a.png").string()}});
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.errorSerial == 1; }));
    EXPECT_EQ(session.state().activity, Activity::Finished);
}

// As dropping does it, with the path that the window system hands over.
TEST_F(InteractiveFilesTest, ModelsThatAreDroppedBecomeTheScene) {
    InteractiveSession session(setup(4));
    ASSERT_TRUE(reaches(session, isFinished));
    scene::GltfBuilder gltf;
    nlohmann::json primitive = gltf.triangle();
    primitive["material"] = gltf.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 1}}}});
    gltf.addNode({{"mesh", gltf.addMesh(primitive)}});
    std::filesystem::create_directories(folder_ / "h\xc3\xa4user & mehr");
    const std::filesystem::path glb = gltf.save(folder_ / "h\xc3\xa4user & mehr/a.GLB");
    const std::filesystem::path text = gltf.saveWithBuffer(folder_ / "b.gltf", "b.bin", folder_ / "b.bin");
    std::ofstream(folder_ / "c.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl unknown\nf 1 2 3\n";
    std::uint64_t loads = 1;
    for (const std::filesystem::path& file : {glb, text, folder_ / "c.obj"}) {
        session.open(file.string());
        ++loads;
        ASSERT_TRUE(reaches(session, [&](const SessionState& s) { return s.sceneLoads == loads && isFinished(s); }))
            << file;
        const SessionState state = session.state();
        EXPECT_EQ(state.source, file.string());
        EXPECT_EQ(state.scene->id, file.filename().string());
        EXPECT_EQ(state.scene->meshes.at(0).triangleCount, 1u); // the studio follows
        EXPECT_EQ(state.scene->materials.at(0).kind,
                  file.extension() == ".obj" ? shared::kMaterialLambertian : shared::kMaterialPrincipled);
    }
    EXPECT_EQ(session.state().scene->notices.size(), 2u) << "of its studio and its material; the panel shows them";
    scene::GltfBuilder::write(folder_ / "broken.glb", gltf.binary().substr(0, 100));
    session.open((folder_ / "broken.glb").string());
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.errorSerial == 1; }));
    EXPECT_NE(session.state().errors.back().text.find("broken.glb"), std::string::npos);
    EXPECT_EQ(session.state().scene->id, "c.obj");
}

// Asked for at any time, also where one film ends and the next one begins.
TEST_F(InteractiveFilesTest, WhatIsSavedHasSamplesInEveryPixel) {
    InteractiveSession::Setup s = setup(4);
    s.request.accumulate = false;
    s.request.samplesPerFrame = 2;
    InteractiveSession session(s);
    for (std::uint64_t i = 1; i <= 12; ++i) {
        const std::string file = (folder_ / (std::to_string(i) + ".exr")).string();
        session.save({.files = {file}});
        session.view({i % 2 == 0 ? ViewMode::Albedo : ViewMode::Picture, 1, false}); // interrupts
        ASSERT_TRUE(reaches(session, [i](const SessionState& state) { return state.messageSerial == i; })) << i;
        for (const float value : image::readImage(file).data) ASSERT_GT(value, 0) << i;
    }
    EXPECT_EQ(session.state().errorSerial, 0u);
}

TEST_F(InteractiveFilesTest, RunsThatEndGoIntoTheHistory) {
    RunHistory history(folder_ / "history.jsonl");
    InteractiveSession::Setup s = setup(20);
    s.history = &history;
    {
        InteractiveSession session(s);
        ASSERT_TRUE(reaches(session, [](const SessionState& state) { return state.historySerial == 1; }));
    }
    const std::vector<RunRecord>& records = history.records();
    ASSERT_EQ(records.size(), 1u);
    EXPECT_EQ(records[0].scene, "cornell-box-lights");
    EXPECT_EQ(records[0].spp, 20u);
    EXPECT_EQ(records[0].width, 24u);
    EXPECT_GT(records[0].renderSeconds, 0);
    EXPECT_GT(records[0].samplesPerSecond, 0);
    EXPECT_EQ(lackingIn(records[0]), ""); // all that the work depends on
}

TEST_F(InteractiveFilesTest, ErrorsAreTakenAgainstAReferenceOfTheSameView) {
    RunHistory history(folder_ / "history.jsonl");
    InteractiveSession::Setup s = setup(20);
    s.history = &history;
    InteractiveSession session(s);
    ASSERT_TRUE(reaches(session, isFinished));
    session.renderReference(40);
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return isFinished(state) && state.referenceFits; }));
    ASSERT_TRUE(reaches(session, [](const SessionState& state) { return !state.curve.empty(); }));
    const SessionState state = session.state();
    EXPECT_FALSE(state.isReferenceRender);
    EXPECT_EQ(state.settings.spp, 20u);
    EXPECT_EQ(state.curve.back().spp, 20);
    EXPECT_GT(state.curve.back().relmse, 0);
    ASSERT_TRUE(
        reaches(session, [](const SessionState& st) { return st.historySerial == 2; })); // the reference is no run
    EXPECT_TRUE(history.records().back().hasReference);
    EXPECT_EQ(history.records().back().relmse, state.curve.back().relmse);

    scene::CameraDesc camera = state.scene->camera;
    camera.verticalFov += 1;
    session.moveCamera(camera, state.sceneSerial);
    EXPECT_TRUE(reaches(
        session, [](const SessionState& st) { return isFinished(st) && !st.referenceFits && st.curve.empty(); }));
    session.moveCamera(state.scene->camera, state.sceneSerial); // back to what the reference shows
    EXPECT_TRUE(reaches(session, [](const SessionState& st) { return isFinished(st) && st.referenceFits; }));
}

TEST_F(InteractiveFilesTest, ReferencesAreReadFromLinearFilesOfTheSameSize) {
    InteractiveSession session(setup(4));
    ASSERT_TRUE(reaches(session, isFinished));
    image::writeImage(folder_ / "right.pfm", image::Image(24, 24));
    image::writeImage(folder_ / "wrong.pfm", image::Image(25, 24));
    session.loadReference((folder_ / "wrong.pfm").string());
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.errorSerial == 1; }));
    EXPECT_NE(session.state().errors.back().text.find("25x24"), std::string::npos);
    EXPECT_TRUE(session.state().reference.empty());
    session.loadReference((folder_ / "right.pfm").string());
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.referenceFits && !s.curve.empty(); }));
}

TEST_F(InteractiveFilesTest, StopGivesAReferenceUp) {
    InteractiveSession session(setup(4));
    ASSERT_TRUE(reaches(session, isFinished));
    session.renderReference(1'000'000);
    ASSERT_TRUE(reaches(session, [](const SessionState& s) { return s.isReferenceRender; }));
    session.stop();
    EXPECT_TRUE(reaches(session, [](const SessionState& s) { return isFinished(s) && !s.isReferenceRender; }));
    EXPECT_TRUE(session.state().reference.empty());
    EXPECT_EQ(session.state().settings.spp, 4u);
}

} // namespace
} // namespace rt::app
