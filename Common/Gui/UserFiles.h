// What a window keeps between two runs of its program, in the user's place for such files.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "Common/App/Interactive/Autosave.h"
#include "Common/App/Interactive/GuiSettings.h"
#include "Common/App/Options/Options.h"
#include "Common/App/Session/ReferenceCache.h"
#include "Common/Gui/Window.h"
#include "Common/Render/Stopwatch.h"

namespace rt::gui {

// Empty where there is no such place, and with --no-config.
std::filesystem::path layoutFile(const app::Options& options);
std::filesystem::path historyFile(const app::Options& options);
// Keeps nothing with --no-config.
app::ReferenceCache referenceCache(const app::Options& options);

// Null where nothing is kept.
std::unique_ptr<app::Autosave> autosaveOf(const app::Options& options, std::function<void()> onFailure);

WindowPlace placeOf(const app::GuiSettings& settings);

// What the user chose the last time, under what the options ask for; written when it has changed for a while.
class KeptSettings {
  public:
    explicit KeptSettings(const app::Options& options);
    ~KeptSettings(); // stores what is not stored yet
    KeptSettings(const KeptSettings&) = delete;
    KeptSettings& operator=(const KeptSettings&) = delete;

    app::GuiSettings settings;

    void keep(const Window& window);        // with the window's place, now
    void keepChanges(const Window& window); // likewise, but seldom, where there are any
    void store();                           // as they are, but for a look that nobody chose

  private:
    std::filesystem::path file_; // empty: nowhere
    app::GuiSettings stored_;    // what there was to store the last time
    // Exposure and tone curve are those of files where the command line asks for such: of this run alone, until the
    // user changes one.
    app::GuiSettings chosen_, shown_;
    app::Stopwatch sinceStored_;
};

} // namespace rt::gui
