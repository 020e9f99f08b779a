// A probe that a window watches while its wishes change: the newest one wins, and is worked on by a thread of its own.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "Common/Probe/NewestWish.h"
#include "Common/Probe/ProbeRun.h"
#include "Common/Render/Settings.h"

namespace rt::probe {

struct ProbeWish {
    std::shared_ptr<const scene::CompiledScene> scene;
    app::RenderSettings rendering; // those of light sampling, the depth of paths, and the image's size
    scene::CameraDesc camera;
    std::array<std::uint32_t, 2> pixel{};
    ProbeSettings settings;
    bool operator==(const ProbeWish&) const = default;
};

using ProbeState = Answer<ProbeWish, ProbeResult>;

// Of a picture that was to be written.
struct ProbeSaved {
    std::string file;
    std::string error; // empty: it is there
};

class ProbeView {
  public:
    // `onChange` is called on the view's thread when there is something new.
    explicit ProbeView(std::function<void()> onChange);
    ~ProbeView(); // gives up what it works on
    ProbeView(const ProbeView&) = delete;
    ProbeView& operator=(const ProbeView&) = delete;

    // What was wished before is given up, but not before its first samples and map are there: a point that is dragged
    // is followed. Nothing: nothing is to be worked on. The same wish once more changes nothing.
    void wish(std::optional<ProbeWish> wish) { wishes_.wish(std::move(wish)); }
    // Works out all of the wish, on another thread, and writes picture and figures as ray-tracing-image probe does: the
    // picture to `file`, the figures beside it as .json. One at a time.
    void save(const std::string& file, const ProbeWish& wish);
    bool isSaving() const { return saving_.valid(); }
    std::optional<ProbeSaved> takeSaved(); // once

    std::shared_ptr<const ProbeState> state() const { return wishes_.state(); } // null: none yet

  private:
    void work(const ProbeWish* wish);
    void answer(const ProbeWish& wish);

    const std::function<void()> onChange_;
    std::shared_ptr<const SceneFormulas> formulas_; // of the thread, for the last wish
    std::atomic<bool> isGivenUp_{false};            // what is being saved
    std::future<ProbeSaved> saving_;
    NewestWish<ProbeWish, ProbeResult> wishes_; // last: its thread uses the others
};

} // namespace rt::probe
