// What a window gets to see of its session: changed by the session's thread, copied by the window's.
#pragma once
#include <exception>
#include <functional>
#include <mutex>
#include <string>

#include "Common/App/Interactive/InteractiveState.h"
#include "Common/Render/Stopwatch.h"

namespace rt::app {

class PublishedState {
  public:
    // `onChange` is called after each change, on the thread that made it; may be empty.
    explicit PublishedState(std::function<void()> onChange) : onChange_(std::move(onChange)) {}

    SessionState copy() const;
    void update(const std::function<void(SessionState&)>& change);
    void setStage(const std::string& stage); // its seconds count from now
    // What is fatal is for the program to report, which ends with it. What else the failure changes, `change`, is seen
    // together with its message; may be empty.
    void fail(const std::exception_ptr& failure, ErrorSource source = ErrorSource::Other, bool fatal = false,
              const std::function<void(SessionState&)>& change = {});
    void say(const std::string& message);

    // How the window has answered so far, for the statistics.
    void tell(const WindowFigures& figures);
    WindowFigures windowFigures() const;

  private:
    std::function<void()> onChange_;
    mutable std::mutex mutex_; // guards what follows
    SessionState state_;
    Stopwatch stageWatch_;
    WindowFigures window_;
};

} // namespace rt::app
