#include "Common/App/Interactive/PublishedState.h"

#include "Common/Core/Error.h"
#include "Common/Core/Log.h"
#include "Common/Core/MemoryReserve.h"

namespace rt::app {

SessionState PublishedState::copy() const {
    const std::scoped_lock lock(mutex_);
    SessionState copy = state_;
    copy.stageSeconds = stageWatch_.seconds();
    return copy;
}

void PublishedState::update(const std::function<void(SessionState&)>& change) {
    {
        const std::scoped_lock lock(mutex_);
        change(state_);
    }
    if (onChange_) onChange_();
}

void PublishedState::setStage(const std::string& stage) {
    update([&](SessionState& state) {
        state.stage = stage;
        stageWatch_ = {};
    });
}

void PublishedState::fail(const std::exception_ptr& failure, ErrorSource source, bool fatal,
                          const std::function<void(SessionState&)>& change) try {
    std::rethrow_exception(failure);
} catch (const std::exception& error) {
    keepMemoryReserve(); // that this failure may have used
    const std::string message = messageOf(error);
    if (!fatal) logWarning(message);
    update([&](SessionState& state) {
        state.errors.push_back({message, source});
        if (state.errors.size() > SessionState::kMaxErrors) state.errors.erase(state.errors.begin());
        ++state.errorSerial;
        if (fatal) state.fatal = failure;
        if (change) change(state);
    });
}

void PublishedState::say(const std::string& message) {
    update([&](SessionState& state) {
        state.message = message;
        ++state.messageSerial;
    });
}

void PublishedState::tell(const WindowFigures& figures) {
    const std::scoped_lock lock(mutex_);
    window_ = figures;
}

WindowFigures PublishedState::windowFigures() const {
    const std::scoped_lock lock(mutex_);
    WindowFigures figures = window_;
    figures.slowestAnswer = state_.slowestAnswer;
    return figures;
}

} // namespace rt::app
