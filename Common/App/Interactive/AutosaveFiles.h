// Files of what has been edited and not saved, which outlive a program that ends before its user has decided: a header
// that says what was edited, and a line for each step since, with a hash. A line that is written only in part is the
// last one, and counts for nothing. Beside each file is one by whose lock it is known whether somebody is at work on
// it.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Platform.h"
#include "Common/App/Session/FileFingerprint.h"
#include "Common/Scene/Edit/EditStep.h"
#include "Common/Scene/Moment.h"

namespace rt::app {

// A scene as it was before it was edited.
struct EditedScene {
    std::string source; // id or whole path
    std::string title;
    scene::Moment moment;
    std::optional<FileFingerprint> mark; // of the file
    bool operator==(const EditedScene&) const = default;
};

// An absolute path of a file, the id of a built-in scene as it is.
std::string wholeSource(const std::string& source);

// Below the user's place for the state of programs; empty where there is none.
std::filesystem::path autosaveFolder();

// Lines of such a file, each with its end.
std::string autosaveHeader(const EditedScene& scene, const std::string& program);
std::string autosaveLine(const scene::EditStep& step);

// A file that nobody else is at work on, as long as this exists.
class ClaimedAutosave {
  public:
    // A new file, empty. Throws RenderError.
    static ClaimedAutosave make(const std::filesystem::path& folder, const std::string& program);
    // One that a program has left; nothing where another one has it, or it is gone.
    static std::optional<ClaimedAutosave> take(const std::filesystem::path& file);

    const std::filesystem::path& file() const { return file_; }
    void remove(); // what is kept there is not wanted any more
    // Gives it another name, under which nobody looks for it: a part of a sentence about that.
    std::string keepAside();

  private:
    ClaimedAutosave(std::filesystem::path file, std::unique_ptr<FileLock> lock)
        : file_(std::move(file)), lock_(std::move(lock)) {}

    std::filesystem::path file_;
    std::unique_ptr<FileLock> lock_;
};

// What a program has left.
struct LeftAutosave {
    std::filesystem::path file;
    EditedScene scene;
    std::string when; // of the last step: "2026-11-29 13:45", local time
    std::uint64_t process = 0;
    std::size_t steps = 0;
};
struct LeftAutosaves {
    std::vector<LeftAutosave> files;     // the latest first
    std::vector<std::string> complaints; // a line for each that is damaged, and kept aside under another name
};
// Removes those with which nothing would be lost. Never throws.
LeftAutosaves findAutosaves(const std::filesystem::path& folder);

// `assetsBelow`: as --assets-below. Throws InputError where it is damaged, or names what is not there any more.
std::vector<scene::EditStep> readAutosave(const ClaimedAutosave& claimed, const std::string& assetsBelow = {});

} // namespace rt::app
