#include "Common/Gui/UserFiles.h"

#include "Common/App/Platform.h"
#include "Common/Core/Error.h"
#include "Common/Core/Log.h"

namespace rt::gui {
namespace {

constexpr double kKeepSeconds = 2; // between two writes

std::filesystem::path userFile(const std::string& name) {
    const std::filesystem::path folder = app::userConfigDirectory();
    return folder.empty() ? folder : folder / name;
}

} // namespace

std::filesystem::path layoutFile(const std::string& program) {
    return userFile(program + ".layout.ini");
}

WindowPlace placeOf(const app::GuiSettings& settings) {
    return {settings.windowX,      settings.windowY,      settings.windowWidth,
            settings.windowHeight, settings.windowPlaced, settings.windowMaximised};
}

KeptSettings::KeptSettings(const app::Options& options)
    : settings(app::loadGuiSettings(userFile(options.program + ".json"))), file_(userFile(options.program + ".json")) {
    override(settings, options);
    stored_ = settings;
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
    try {
        saveGuiSettings(file_, settings);
    } catch (const Error& error) {
        logWarning(error.what()); // a home that cannot be written is no reason to stop
    }
}

void KeptSettings::keepChanges(const Window& window) {
    if (settings != stored_ && sinceStored_.seconds() > kKeepSeconds) keep(window);
}

} // namespace rt::gui
