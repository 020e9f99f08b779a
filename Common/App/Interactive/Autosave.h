// Keeps what is edited and not saved in a file of its own (AutosaveFiles.h), on a thread of its own: whoever edits
// waits for nothing, and only what is new is written.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "Common/App/Interactive/AutosaveFiles.h"

namespace rt::app {

class Autosave {
  public:
    // `seconds`: from a step until it is written, at least. `onFailure` is called on another thread when takeFailure()
    // has something to say.
    Autosave(std::filesystem::path folder, std::string program, std::function<void()> onFailure = {},
             double seconds = 2);
    // What is not written yet is. The file stays where it has steps that leave something unsaved.
    ~Autosave();
    Autosave(const Autosave&) = delete;
    Autosave& operator=(const Autosave&) = delete;

    void begin(EditedScene scene);       // in place of what was edited before, of which nothing is kept any more
    void add(scene::EditStep step);      // to the scene that was begun
    void end();                          // nothing is edited, or none of it is wanted
    void takeOver(ClaimedAutosave left); // of whose steps those here are a copy: removed when they are written
    // Once: why nothing can be written. Nothing more is said until something could be.
    std::optional<std::string> takeFailure();

  private:
    void work();
    void write(std::vector<scene::EditStep> steps, const EditedScene& scene);
    void append(const std::string& text);
    void drop();
    void fail(const std::exception& error);
    void startAnew(); // locked
    void settle();

    const std::filesystem::path folder_;
    const std::string program_;
    const std::function<void()> onFailure_;
    const double seconds_;

    std::mutex mutex_;
    std::condition_variable wake_;
    std::optional<EditedScene> scene_;
    std::vector<scene::EditStep> pending_;
    std::uint64_t seenGesture_ = 0; // of the last step that the thread has taken
    std::optional<ClaimedAutosave> takenOver_;
    std::vector<ClaimedAutosave> unwanted_; // that were taken over
    std::optional<std::string> failure_;
    bool isFresh_ = false;    // what the thread has written is of another scene, or not wanted
    bool isTakeover_ = false; // since the thread has looked
    bool quit_ = false;

    // The thread's own.
    std::optional<ClaimedAutosave> file_;
    std::uintmax_t goodBytes_ = 0;
    std::string unwritten_;
    bool leavesUnsaved_ = false;
    bool hasFailed_ = false, isBroken_ = false; // broken: what cannot be written down is missing
    std::thread thread_;
};

} // namespace rt::app
