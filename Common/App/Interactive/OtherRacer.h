// An entrant of a race that the other program renders: at the same time, on its own device and by its own clock. What
// it has so far is read from the checkpoints that it writes, whose time is none of sampling.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "Common/App/Interactive/OtherEngine.h"
#include "Common/App/Platform.h"
#include "Common/App/Session/FileFingerprint.h"
#include "Common/Core/OwnFolder.h"
#include "Common/Image/Film.h"

namespace rt::app {

class OtherRacer {
  public:
    // Starts the program, which renders for so long; of the job's settings spp does not count. `folder`: where the
    // programs are, in place of this one's. Throws RenderError.
    OtherRacer(const OtherJob& job, double seconds, const std::filesystem::path& folder);

    struct News {
        double seconds = 0; // of sampling
        image::Film film;
    };
    // The film as the program has last written it; none that has been returned before.
    std::optional<News> look();
    // Whether it has ended, and all that it wrote has been returned. Throws RenderError where it has failed.
    bool hasEnded();
    // When it has ended: on what it ran, and whether a processor does that device's work.
    struct Device {
        std::string engine, name;
        bool isSoftware = false;
    };
    Device device() const;

  private:
    std::filesystem::path checkpoint() const { return folder_ / "film.rtc"; }
    std::filesystem::path statistics() const { return folder_ / "statistics.json"; }
    std::filesystem::path messages() const { return folder_ / "messages.txt"; }

    OwnFolder folder_;
    std::string program_, scene_, sceneHash_;
    std::optional<FileFingerprint> seen_; // of the checkpoint
    std::optional<ChildProcess> child_;   // which writes to the folder and ends before it goes
};

} // namespace rt::app
