#include "Common/Gui/Recovery.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <string>
#include <utility>

#include <imgui.h>

#include "Common/Core/Error.h"
#include "Common/Core/Printable.h"
#include "Common/Gui/Gui.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr float kWidth = 32; // of what is asked, in heights of the font

template <typename Value>
bool hasArrived(const std::future<Value>& future) {
    return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

std::string howMany(std::size_t steps) {
    return std::to_string(steps) + (steps == 1 ? " edit" : " edits");
}

// None of those that are of no interest any more when a scene has been loaded.
void complain(Gui& gui, const std::string& text) {
    gui.fail(text, app::ErrorSource::Other);
}

// Whenever a scene has been opened, as others may have left something meanwhile.
void lookForLeft(Gui& gui) {
    Recovery& recovery = gui.recovery;
    if (hasArrived(recovery.looking)) {
        app::LeftAutosaves found = recovery.looking.get();
        for (const std::string& complaint : found.complaints) complain(gui, complaint);
        const auto isPostponed = [&](const app::LeftAutosave& left) { return recovery.postponed.contains(left.file); };
        std::erase_if(found.files, isPostponed);
        recovery.offered = std::move(found.files);
    }
    if (recovery.looking.valid() || recovery.lookedAt == gui.state.sceneReads) return;
    recovery.lookedAt = gui.state.sceneReads;
    recovery.looking = std::async(std::launch::async, [] { return app::findAutosaves(app::autosaveFolder()); });
}

// What was put off for later is offered again where its scene is opened.
void recallPostponed(Gui& gui) {
    Recovery& recovery = gui.recovery;
    if (recovery.lookedAt == gui.state.sceneReads) return;
    const std::string opened = app::wholeSource(gui.state.source);
    std::erase_if(recovery.postponed, [&](const auto& entry) { return entry.second == opened; });
}

void beginWork(Gui& gui, const app::LeftAutosave& left) {
    auto claimed = app::ClaimedAutosave::take(left.file);
    if (!claimed) return complain(gui, "another window has these edits by now");
    Recovery::Work work;
    work.left = left;
    work.claimed = std::make_shared<app::ClaimedAutosave>(std::move(*claimed));
    work.steps = std::async(std::launch::async, [kept = work.claimed, assetsBelow = gui.assetsBelow] {
        return app::readAutosave(*kept, assetsBelow);
    });
    work.sceneReads = gui.state.sceneReads;
    work.sceneFailures = gui.state.sceneFailures;
    gui.recovery.work.emplace(std::move(work));
    gui.session.open(left.scene.source, left.scene.moment);
}

// All of it is done again, to the scene as it was before.
void finishWork(Gui& gui) {
    Recovery::Work work = std::move(*std::exchange(gui.recovery.work, std::nullopt));
    try {
        std::vector<scene::EditStep> steps = work.steps.get();
        const std::size_t count = steps.size();
        gui.editor.repeat(std::move(steps));
        gui.recovery.autosave->takeOver(std::move(*work.claimed));
        gui.say("Recovered " + howMany(count) + ": they are not saved yet");
    } catch (const std::exception& error) {
        complain(gui, "not all unsaved edits could be recovered: " + messageOf(error) + " (" +
                          work.claimed->keepAside() + ')');
    }
    gui.editing.isListStale = true;
    gui.settings.openPanels["objects"] = true;
}

void followWork(Gui& gui) {
    Recovery::Work& work = *gui.recovery.work;
    const app::SessionState& state = gui.state;
    const bool isRead = state.sceneReads != work.sceneReads;
    const bool isOurs = isRead && app::wholeSource(state.source) == work.left.scene.source;
    if ((isRead && !isOurs) || state.sceneFailures != work.sceneFailures) { // which the session tells
        gui.recovery.postponed.emplace(work.left.file, work.left.scene.source);
        gui.recovery.work.reset();
        return;
    }
    if (!isOurs) return;
    if (!std::exchange(work.isBegun, true)) gui.editor.begin();
    if (gui.editor.document() == nullptr && !gui.editor.isReading()) {
        gui.recovery.work.reset(); // it cannot be read, as the editor tells
    } else if (gui.editor.document() != nullptr && hasArrived(work.steps)) {
        finishWork(gui);
    }
}

} // namespace

void followRecovery(Gui& gui) {
    if (gui.recovery.autosave == nullptr) return;
    if (const auto failure = gui.recovery.autosave->takeFailure()) complain(gui, *failure);
    recallPostponed(gui);
    lookForLeft(gui);
    if (gui.recovery.work) followWork(gui);
}

void drawRecovery(Gui& gui) {
    Recovery& recovery = gui.recovery;
    if (recovery.offered.empty() || recovery.work || gui.editing.whenSaved) return;
    const app::LeftAutosave left = recovery.offered.front();
    const auto takeOut = [&recovery, file = left.file] {
        std::erase_if(recovery.offered, [&file](const app::LeftAutosave& other) { return other.file == file; });
    };
    const ImVec2 size = ImGui::GetMainViewport()->Size;
    const float width = std::min(kWidth * ImGui::GetFontSize(), size.x);
    ImGui::SetNextWindowPos({0.5f * size.x, 0.4f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, size.y});
    constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse |
                                        ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove |
                                        ImGuiWindowFlags_NoFocusOnAppearing;
    if (ImGui::Begin("Unsaved changes", nullptr, kFlags)) {
        ImGui::PushTextWrapPos(0);
        const std::string what = '"' + left.scene.title + "\": " + howMany(left.steps) + " from " + left.when;
        ImGui::TextUnformatted(printable(what + (left.steps == 1 ? " is" : " are") + " not saved.").c_str());
        ImGui::PopTextWrapPos();
        note(printable(left.scene.source));
        if (left.scene.mark && app::markOf(left.scene.source) != left.scene.mark)
            note("That file has changed since: they may not fit it.");
        if (button("Recover", "Opens the scene and does again what was done to it", true)) {
            onceSaved(gui, [&gui, takeOut, left] { // who goes on editing first is asked again
                takeOut();
                beginWork(gui, left);
            });
        }
        ImGui::SameLine();
        if (button("Discard", "They cannot be recovered afterwards", true)) {
            takeOut();
            if (auto claimed = app::ClaimedAutosave::take(left.file)) claimed->remove();
        }
        ImGui::SameLine();
        if (button("Later", "They are offered again when their scene is opened, and by the next window", true)) {
            takeOut();
            recovery.postponed.emplace(left.file, left.scene.source);
        }
    }
    ImGui::End();
}

} // namespace rt::gui
