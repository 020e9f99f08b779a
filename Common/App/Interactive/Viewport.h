// The viewports of a session: pictures of one scene, each with a camera, settings and an engine of its own. What the
// window and the session's thread share of them.
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "Common/App/Interactive/InteractiveState.h"
#include "Common/App/Interactive/Mailbox.h"
#include "Common/App/Interactive/PublishedState.h"

namespace rt::app {

using ViewportId = std::uint32_t; // none is used twice

// Where its thread finds what is asked of it, and what it tells.
struct Viewport {
    Viewport(ViewportId number, SessionSetup start, std::function<void()> onPost)
        : id(number), setup(std::move(start)), mailbox(std::move(onPost)), state(setup.onChange) {}

    const ViewportId id;
    const SessionSetup setup;
    Mailbox mailbox;
    PublishedState state;
};

// Who is there, who has the focus, and the bell that wakes the thread. On any thread.
class ViewportBoard {
  public:
    // Opened by the window and not taken by the thread yet.
    void open(std::shared_ptr<Viewport> viewport);
    std::vector<std::shared_ptr<Viewport>> takeOpened();

    void setFocus(ViewportId id);
    ViewportId focus() const { return focus_; }
    // The user has just changed what the focus shows: it alone is rendered until he rests, and where he has hold of
    // something until he lets it go.
    void noteMotion();
    void setHeld(bool isHeld);
    double secondsToRest() const; // 0: he does

    void ring();
    std::uint64_t rings() const;
    // Until it has rung after `heard`, at most so long; none: however long that takes.
    void wait(std::uint64_t heard, std::optional<double> seconds);

  private:
    using Clock = std::chrono::steady_clock;
    mutable std::mutex mutex_; // guards what follows
    std::condition_variable bell_;
    std::uint64_t rings_ = 0;
    std::vector<std::shared_ptr<Viewport>> opened_;
    std::optional<Clock::time_point> motion_; // the last
    bool isHeld_ = false, hasMovedHeld_ = false;
    std::atomic<ViewportId> focus_{0};
};

} // namespace rt::app
