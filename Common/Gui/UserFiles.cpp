#include "Common/Gui/UserFiles.h"

#include <utility>

#include "Common/App/Platform.h"
#include "Common/Core/Error.h"
#include "Common/Core/Log.h"

namespace rt::gui {
namespace {

constexpr double kKeepSeconds = 2; // between two writes

std::filesystem::path userFile(const app::Options& options, const std::string& name) {
    const std::filesystem::path folder = options.keepsUserFiles ? app::userConfigDirectory() : std::filesystem::path();
    return folder.empty() ? folder : folder / name;
}

} // namespace

std::filesystem::path layoutFile(const app::Options& options) {
    return userFile(options, options.program + ".layout.ini");
}

std::filesystem::path historyFile(const app::Options& options) {
    return options.keepsUserFiles ? app::RunHistory::userFile() : std::filesystem::path();
}

app::ReferenceCache referenceCache(const app::Options& options) {
    return options.keepsUserFiles ? app::ReferenceCache::ofUser() : app::ReferenceCache({});
}

std::unique_ptr<app::Autosave> autosaveOf(const app::Options& options, std::function<void()> onFailure) {
    const std::filesystem::path folder = options.keepsUserFiles ? app::autosaveFolder() : std::filesystem::path();
    if (folder.empty()) return nullptr;
    return std::make_unique<app::Autosave>(folder, options.program, std::move(onFailure));
}

WindowPlace placeOf(const app::GuiSettings& settings) {
    return {settings.windowX,      settings.windowY,      settings.windowWidth,
            settings.windowHeight, settings.windowPlaced, settings.windowMaximised};
}

KeptSettings::KeptSettings(const app::Options& options) : file_(userFile(options, options.program + ".json")) {
    if (!file_.empty()) settings = app::loadGuiSettings(file_);
    chosen_ = settings;
    override(settings, options);
    stored_ = shown_ = settings;
}

KeptSettings::~KeptSettings() {
    if (settings != stored_) store();
}

void KeptSettings::keep(const Window& window) {
    const WindowPlace place = window.place();
    settings.windowMaximised = place.maximised;
    if (!place.maximised) {
        settings.windowX = place.x;
        settings.windowY = place.y;
        settings.windowWidth = place.width;
        settings.windowHeight = place.height;
        settings.windowPlaced = place.hasPosition;
    }
    store();
}

void KeptSettings::store() {
    stored_ = settings;
    sinceStored_ = {};
    if (file_.empty()) return;
    app::GuiSettings kept = settings;
    const auto keepChosen = [&](auto member) {
        if (settings.*member != shown_.*member) chosen_.*member = shown_.*member = settings.*member;
        kept.*member = chosen_.*member;
    };
    keepChosen(&app::GuiSettings::exposure);
    keepChosen(&app::GuiSettings::autoExposure);
    keepChosen(&app::GuiSettings::tonemap);
    try {
        saveGuiSettings(file_, kept);
    } catch (const Error& error) {
        logWarning(error.what()); // a home that cannot be written is no reason to stop
    }
}

void KeptSettings::keepChanges(const Window& window) {
    if (settings != stored_ && sinceStored_.seconds() > kKeepSeconds) keep(window);
}

} // namespace rt::gui
