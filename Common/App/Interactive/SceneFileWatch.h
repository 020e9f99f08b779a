// Whether the files that a scene was read from are still what they were.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Session/FileFingerprint.h"

namespace rt::app {

struct WatchedFile {
    std::string file;
    std::vector<std::optional<FileFingerprint>> known; // as which it need not be read again
};

class SceneFileWatch {
  public:
    // A look at the files: whether one of them has become another one, and was the same at the look before, as it may
    // still be being written. What is not there is between two of its lives.
    bool isDue(const std::vector<WatchedFile>& files);
    // The scene is read again as they are now: once, also where it does not load.
    void setAsked() { asked_ = seen_; }

  private:
    std::vector<std::optional<FileFingerprint>> seen_, asked_; // at the last look; when the scene was read again
};

} // namespace rt::app
