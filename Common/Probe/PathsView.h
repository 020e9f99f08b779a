// The samples of a pixel that a window watches, and where their paths are seen from where it looks: the newest wish is
// worked on by a thread of its own.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "Common/Probe/NewestWish.h"
#include "Common/Probe/PathsRun.h"

namespace rt::probe {

struct PathsWish {
    std::shared_ptr<const scene::CompiledScene> scene;
    app::RenderSettings rendering; // those of the film
    scene::CameraDesc camera;
    std::array<std::uint32_t, 2> pixel{};
    PathsSettings settings;
    glm::dvec3 eye{}; // from which lines are looked at
    bool operator==(const PathsWish&) const = default;
};

// A piece of a path, all of it seen or hidden.
struct PathPiece {
    shared::vec3 from{}, to{};
    bool isHidden = false;
};
struct PathLine {
    std::size_t path = 0; // of those that are listed, or of those of the sample that is selected
    std::vector<PathPiece> pieces;
};

struct PathsShown {
    PathsResult result;
    std::vector<PathLine> lines;
    // That `lines` have one of for each.
    const std::vector<ListedPath>& paths() const { return result.settings.selected ? result.selected : result.listed; }
};

// Whether something is between the eye and each piece of the paths' lines behind the camera.
std::vector<PathLine> linesSeenFrom(const SceneFormulas& scene, const glm::dvec3& eye,
                                    const std::vector<ListedPath>& paths);

using PathsState = Answer<PathsWish, PathsShown>;

class PathsView {
  public:
    // `onChange` is called on the view's thread when there is something new.
    explicit PathsView(std::function<void()> onChange);

    // What was wished before is given up, but not before its first samples are there. Nothing: nothing is to be worked
    // on. The same wish once more changes nothing.
    void wish(std::optional<PathsWish> wish) { wishes_.wish(std::move(wish)); }
    std::shared_ptr<const PathsState> state() const { return wishes_.state(); } // null: none yet

  private:
    void work(const PathsWish* wish);
    void answer(const PathsWish& wish);
    PathsShown shownOf(const PathsWish& wish, PathsResult result) const;

    std::shared_ptr<const SceneFormulas> formulas_; // of the thread, for the last wish
    std::optional<PathsState> done_;                // of the thread: the last one that was answered in full
    NewestWish<PathsWish, PathsShown> wishes_;      // last: its thread uses the others
};

} // namespace rt::probe
