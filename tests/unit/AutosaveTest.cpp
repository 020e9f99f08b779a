// What is edited and not saved outlives the program, and only that.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Interactive/Autosave.h"
#include "Common/App/Interactive/SceneEditor.h"
#include "Common/Scene/Edit/ObjectMotion.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/FileBytes.h"
#include "tests/unit/InteractiveFixture.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;
using scene::EditStep;

constexpr double kAtOnce = 0;

class AutosaveTest : public InteractiveFixture {
  protected:
    static EditStep rename(const std::string& title, bool leavesUnsaved = true) {
        return {EditStep::Kind::Perform, "Rename", {scene::SetTitle{title}}, 0, leavesUnsaved};
    }
    static EditedScene edited(const std::string& source = "cornell-box") { return {source, "Box", {}, {}}; }
    fs::path place() const { return folder_ / "autosave"; }
    std::vector<fs::path> files() const {
        std::vector<fs::path> files;
        std::error_code none;
        for (const auto& entry : fs::directory_iterator(place(), none))
            if (entry.path().extension() == ".autosave") files.push_back(entry.path());
        return files;
    }
    static bool becomes(const std::function<bool()>& condition) {
        for (int i = 0; i < 20'000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return condition();
    }
    // As a program leaves it that ends before it is told to.
    fs::path leave(const std::vector<EditStep>& steps) {
        {
            Autosave autosave(place(), "test", {}, kAtOnce);
            autosave.begin(edited());
            for (const EditStep& step : steps) autosave.add(step);
        }
        EXPECT_EQ(files().size(), 1u);
        return files().empty() ? fs::path() : files().front();
    }
    static std::string titleOf(const EditStep& step) { return std::get<scene::SetTitle>(step.edits.at(0)).value; }
    static std::vector<EditStep> readAll(const LeftAutosave& left) {
        auto claimed = ClaimedAutosave::take(left.file);
        EXPECT_TRUE(claimed);
        return claimed ? readAutosave(*claimed) : std::vector<EditStep>();
    }
};

TEST_F(AutosaveTest, WhatAProgramLeavesIsFound) {
    leave({rename("One"), rename("Two")});
    const LeftAutosaves found = findAutosaves(place());
    EXPECT_TRUE(found.complaints.empty());
    ASSERT_EQ(found.files.size(), 1u);
    EXPECT_EQ(found.files[0].scene, edited());
    EXPECT_EQ(found.files[0].process, processId());
    EXPECT_EQ(found.files[0].steps, 2u);
    EXPECT_EQ(found.files[0].when.size(), std::string("2026-11-29 13:45").size());
    const std::vector<EditStep> steps = readAll(found.files[0]);
    ASSERT_EQ(steps.size(), 2u);
    EXPECT_EQ(titleOf(steps[1]), "Two");
}

TEST_F(AutosaveTest, OfAWindowThatIsAtWorkNothingIsOffered) {
    Autosave autosave(place(), "test", {}, kAtOnce);
    autosave.begin(edited());
    autosave.add(rename("One"));
    ASSERT_TRUE(becomes([&] { return files().size() == 1 && fs::file_size(files()[0]) > 0; }));
    EXPECT_TRUE(findAutosaves(place()).files.empty());
    EXPECT_FALSE(ClaimedAutosave::take(files()[0]));
    Autosave other(place(), "test", {}, kAtOnce); // of another window
    other.begin(edited());
    other.add(rename("Other"));
    ASSERT_TRUE(becomes([&] { return files().size() == 2; }));
    other.end();
    ASSERT_TRUE(becomes([&] { return files().size() == 1; }));
    autosave.end();
    EXPECT_TRUE(becomes([&] { return fs::is_empty(place()); })) << "locks are removed, too";
}

TEST_F(AutosaveTest, WithoutUnsavedEditsNothingIsLeft) {
    {
        Autosave autosave(place(), "test", {}, kAtOnce);
        autosave.begin(edited());
        autosave.add(rename("One"));
        ASSERT_TRUE(becomes([&] { return files().size() == 1; }));
        autosave.add(rename("Box", false)); // as undo does
    }
    EXPECT_TRUE(files().empty());
    EXPECT_TRUE(findAutosaves(place()).files.empty());
    EXPECT_TRUE(findAutosaves(folder_ / "nowhere").files.empty());
    EXPECT_TRUE(findAutosaves({}).files.empty());
}

TEST_F(AutosaveTest, ALineThatWasWrittenInPartIsNone) {
    const fs::path file = leave({rename("One"), rename("Two")});
    fs::resize_file(file, fs::file_size(file) - 5);
    const LeftAutosaves found = findAutosaves(place());
    ASSERT_EQ(found.files.size(), 1u);
    EXPECT_EQ(found.files[0].steps, 1u);
    EXPECT_EQ(titleOf(readAll(found.files[0]).at(0)), "One");
}

TEST_F(AutosaveTest, WhatIsDamagedIsKeptAsideWithOneLine) {
    const fs::path file = leave({rename("One"), rename("Two")});
    const std::string good = test::bytesOfFile(file);
    std::string bad = good;
    bad[good.find("One")] = 'X';
    const std::string damaged[] = {
        bad, "", "\n", "nonsense\n", good.substr(good.find('\n') + 1), std::string(3000, '\0') + '\n'};
    for (const std::string& bytes : damaged) {
        std::ofstream(file, std::ios::binary) << bytes;
        const LeftAutosaves found = findAutosaves(place());
        EXPECT_TRUE(found.files.empty());
        ASSERT_EQ(found.complaints.size(), 1u) << bytes.substr(0, 100);
        EXPECT_NE(found.complaints[0].find(file.string()), std::string::npos) << found.complaints[0];
        const fs::path aside = fs::path(file).replace_extension(".damaged");
        EXPECT_EQ(test::bytesOfFile(aside), bytes);
        fs::remove(aside);
        EXPECT_TRUE(findAutosaves(place()).complaints.empty()) << "once";
    }
}

TEST_F(AutosaveTest, WhatCouldNotBeWrittenIsTriedAgain) {
    std::ofstream(place()) << "a file is in its place";
    std::atomic<int> failures{0};
    Autosave autosave(
        place(), "test", [&] { ++failures; }, kAtOnce);
    autosave.begin(edited());
    autosave.add(rename("One"));
    ASSERT_TRUE(becomes([&] { return failures > 0; }));
    fs::remove(place());
    EXPECT_TRUE(becomes([&] { return !files().empty(); }));
    EXPECT_EQ(failures, 1);
}

TEST_F(AutosaveTest, AFolderThatCannotBeWrittenIsOneNotice) {
    std::ofstream(place()) << "a file is in its place";
    std::atomic<int> failures{0};
    {
        Autosave autosave(
            place(), "test", [&] { ++failures; }, kAtOnce);
        autosave.begin(edited());
        for (int i = 0; i < 20; ++i) {
            autosave.add(rename(std::to_string(i)));
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        ASSERT_TRUE(becomes([&] { return failures > 0; }));
        const auto failure = autosave.takeFailure();
        ASSERT_TRUE(failure);
        EXPECT_NE(failure->find(place().string()), std::string::npos) << *failure;
        EXPECT_FALSE(autosave.takeFailure());
        fs::remove(place()); // from here on there is a place
        autosave.add(rename("Last"));
        ASSERT_TRUE(becomes([&] { return files().size() == 1 && fs::file_size(files()[0]) > 0; }));
    }
    EXPECT_EQ(failures, 1);
    const LeftAutosaves found = findAutosaves(place());
    ASSERT_EQ(found.files.size(), 1u);
    EXPECT_EQ(found.files[0].steps, 21u) << "nothing of it is lost";
}

TEST_F(AutosaveTest, WhatIsNewIsWrittenAlone) {
    scene::MeshData grid;
    for (int i = 0; i < 3000; ++i) grid.positions.emplace_back(i, i % 7, 0.1 * i);
    for (unsigned i = 0; i + 2 < 3000; ++i) grid.triangles.emplace_back(i, i + 1, i + 2);
    scene::MeshDesc mesh;
    mesh.source = grid;
    mesh.material = "m";
    const EditStep add{EditStep::Kind::Perform, "Add", {scene::PlaceObject{{"", {0}}, scene::ObjectDesc{mesh}}}};
    Autosave autosave(place(), "test", {}, kAtOnce);
    autosave.begin(edited());
    autosave.add(add);
    const std::uintmax_t size = autosaveHeader(edited(), "test").size() + autosaveLine(add).size();
    ASSERT_GT(size, 50'000u);
    ASSERT_TRUE(becomes([&] { return files().size() == 1 && fs::file_size(files()[0]) == size; })); // as a whole
    autosave.add({EditStep::Kind::Undo});
    autosave.add({EditStep::Kind::Redo});
    ASSERT_TRUE(becomes([&] { return fs::file_size(files()[0]) > size; }));
    EXPECT_LT(fs::file_size(files()[0]), size + 400);
}

TEST_F(AutosaveTest, WhatWasHadBackIsTakenOver) {
    const fs::path left = leave({rename("One")});
    Autosave autosave(place(), "test", {}, kAtOnce);
    autosave.begin(edited());
    auto claimed = ClaimedAutosave::take(left);
    ASSERT_TRUE(claimed);
    for (const EditStep& step : readAutosave(*claimed)) autosave.add(step);
    autosave.takeOver(std::move(*claimed));
    autosave.add(rename("Two"));
    EXPECT_TRUE(becomes([&] { return files().size() == 1 && !fs::exists(left); }));
}

// ---- by way of the editor ------------------------------------------------------------------------------------------

class AutosavedEditorTest : public AutosaveTest {
  protected:
    static constexpr const char* kBalls = R"({
      "version": 1, "title": "Two balls", "camera": {"look_from": [0, 0, 5], "look_at": [0, 0, 0]},
      "materials": {"m": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}},
      "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "m"},
                  {"type": "sphere", "center": [2, 0, 0], "radius": 0.5, "material": "m"}]})";
    struct Window {
        explicit Window(AutosavedEditorTest& test, const std::string& source)
            : autosave(test.place(), "test", {}, kAtOnce) {
            auto setup = InteractiveFixture::setup(64);
            setup.scene.source = source;
            session.emplace(std::move(setup));
            editor.emplace(*session, "", &autosave);
            EXPECT_TRUE(reaches(*session, [](const SessionState& state) { return state.sceneLoads == 1; }));
            editor->follow(session->state());
            editor->begin();
            EXPECT_TRUE(reaches(*session, [this](const SessionState& state) {
                editor->follow(state);
                return editor->document() != nullptr;
            }));
        }
        void move(std::uint32_t object, double x, std::uint64_t gesture = 0) {
            const auto edit = moved(editor->document()->scene(), {"", {object}}, {scene::Translate{{x, 0, 0}}});
            editor->perform("Move", {edit}, gesture);
        }
        void drag(std::uint32_t object, double x) {
            const std::uint64_t gesture = editor->newGesture();
            for (int i = 1; i <= 10; ++i)
                editor->performAnew(
                    "Drag",
                    [&](const scene::SceneDesc& scene) {
                        return std::vector{moved(scene, {"", {object}}, {scene::Translate{{0.1 * i * x, 0, 0}}})};
                    },
                    gesture);
        }
        void save(const std::string& file) {
            editor->save(file);
            EXPECT_TRUE(reaches(*session, [this](const SessionState& state) {
                editor->follow(state);
                return editor->takeSaved().has_value();
            }));
        }
        std::string text() const { return toJson(editor->document()->scene()); }

        Autosave autosave;
        std::optional<InteractiveSession> session;
        std::optional<SceneEditor> editor;
    };
    AutosavedEditorTest() : file_(folder_ / "balls.json") { std::ofstream(file_) << kBalls; }

    // What is left leads to the same scene.
    void expectHadBack(const fs::path& source, const std::string& text) {
        const LeftAutosaves found = findAutosaves(place());
        ASSERT_EQ(found.files.size(), 1u);
        EXPECT_EQ(found.files[0].scene.source, source.string());
        EXPECT_EQ(found.files[0].scene.mark, markOf(source.string()));
        auto claimed = ClaimedAutosave::take(found.files[0].file);
        ASSERT_TRUE(claimed);
        Window window(*this, source.string());
        window.editor->repeat(readAutosave(*claimed));
        EXPECT_EQ(window.text(), text);
        EXPECT_TRUE(window.editor->isDirty());
        claimed->remove();
        window.autosave.end();
    }

    fs::path file_;
};

TEST_F(AutosavedEditorTest, AllThatWasDoneIsDoneAgain) {
    std::string text;
    {
        Window window(*this, file_.string());
        window.move(0, 1);
        window.drag(1, -0.3);
        window.move(1, 7);
        window.editor->undo();
        window.move(0, 1.0 / 3);
        window.editor->joinSteps("Both");
        window.editor->perform("Delete", {scene::PlaceObject{{"", {1}}, std::nullopt}});
        window.editor->undo();
        text = window.text();
    }
    expectHadBack(file_, text);
}

// What is undone of the time before it was saved is none of the saved file's steps.
TEST_F(AutosavedEditorTest, AfterSavingItIsOfTheSavedFile) {
    const fs::path saved = folder_ / "saved.json";
    std::string text;
    {
        Window window(*this, file_.string());
        window.move(0, 1);
        window.move(1, 2);
        window.save(saved.string());
        EXPECT_TRUE(becomes([&] { return files().empty(); })) << "all is saved";
        window.editor->undo();
        window.editor->undo();
        window.editor->redo();
        window.drag(1, 5);
        text = window.text();
    }
    expectHadBack(saved, text);
}

TEST_F(AutosavedEditorTest, WhatIsDoneWhileItIsSavedIsKept) {
    const fs::path saved = folder_ / "saved.json";
    std::string text;
    {
        Window window(*this, file_.string());
        window.move(0, 1);
        window.editor->save(saved.string());
        window.move(1, 2);
        window.editor->undo();
        window.move(0, 3);
        ASSERT_TRUE(reaches(*window.session, [&](const SessionState& state) {
            window.editor->follow(state);
            return window.editor->takeSaved().has_value();
        }));
        text = window.text();
    }
    expectHadBack(saved, text);
}

TEST_F(AutosavedEditorTest, StepsOfAnotherSceneStopWhereTheyDoNotFit) {
    Window window(*this, file_.string());
    std::vector<EditStep> steps = {
        rename("Fits"), {EditStep::Kind::Perform, "Hide", {scene::SetHidden{{"", {5}}, true}}}, rename("Never")};
    EXPECT_THROW(window.editor->repeat(steps), InputError);
    EXPECT_EQ(window.editor->document()->scene().title, "Fits");
    window.autosave.end();
}

} // namespace
} // namespace rt::app
