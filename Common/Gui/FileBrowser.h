// Chooses a file to open or to save to, by mouse or keyboard.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Interactive/FolderList.h"

namespace rt::gui {

class FileBrowser {
  public:
    struct Request {
        std::string title;
        std::string action; // of the button: "Open"
        std::vector<std::string>
            extensions;               // that are shown, in small letters; to save: the first is added to a name without
        std::filesystem::path folder; // to begin with; empty: the one before, else the user's
        std::string name;             // to begin with
        bool isToSave = false;        // the file need not exist
    };
    void open(Request request);
    void close() { isOpen_ = false; }
    bool isOpen() const { return isOpen_; }
    // Its field gets the keyboard in one of the next frames, which should not be long in coming.
    bool isSettling() const { return isOpen_ && settling_ > 0; }

    // Keys that it takes before ImGui's fields do.
    enum class Key { Up, Down, PageUp, PageDown, Parent, Accept };
    void press(Key key);

    // Within a frame of ImGui, while it is open. `recent` files stand at the side. Returns what was chosen, which
    // closes it: an absolute path, or a text that is none of the folder's files.
    std::optional<std::filesystem::path> draw(const std::vector<std::string>& recent);

  private:
    using Path = std::filesystem::path;

    void enter(const Path& folder);
    bool matches(const app::FolderEntry& entry) const;
    std::vector<std::size_t> shown() const; // entries that match what was typed
    std::optional<Path> accept();
    std::optional<Path> acceptFile(const Path& file);
    void drawPlaces(const std::vector<std::string>& recent, std::optional<Path>& chosen);
    void drawEntries(std::optional<Path>& chosen);
    std::optional<Path> finish(const Path& path);

    bool isOpen_ = false;
    int settling_ = 0; // frames until the field has the keyboard
    Request request_;
    Path folder_;
    app::FolderList list_;
    std::string name_;   // as typed
    std::string listed_; // what was typed when the selection was made
    int selected_ = -1;  // of shown(); -1: what was typed counts
    bool scrollToSelected_ = false;
    bool isAccepted_ = false; // by the keyboard, in the next frame
    std::string question_;    // a file that exists: to be replaced when it is chosen again
};

} // namespace rt::gui
