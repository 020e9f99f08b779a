// Edits that another window, or this program the last time, could not save: they are offered when the window opens and
// when their scene is opened.
#pragma once
#include <cstdint>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Interactive/Autosave.h"

namespace rt::gui {

struct Gui;

struct Recovery {
    app::Autosave* autosave = nullptr; // of this window; null: nothing is kept, nor looked for
    std::future<app::LeftAutosaves> looking;
    std::optional<std::uint64_t> lookedAt; // reads of scenes when it was last looked; none: never
    std::vector<app::LeftAutosave> offered;
    std::map<std::filesystem::path, std::string> postponed; // until their scene, which this names, is opened

    // What is being had back.
    struct Work {
        app::LeftAutosave left;
        std::shared_ptr<app::ClaimedAutosave> claimed;
        std::future<std::vector<scene::EditStep>> steps;
        std::uint64_t sceneReads = 0, sceneFailures = 0; // when its scene was asked for
        bool isBegun = false;                            // its scene is there
    };
    std::optional<Work> work;
};

// Each frame, behind followEditing().
void followRecovery(Gui& gui);
void drawRecovery(Gui& gui); // asks what is to become of them

} // namespace rt::gui
