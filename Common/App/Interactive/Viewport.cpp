#include "Common/App/Interactive/Viewport.h"

#include <algorithm>
#include <utility>

namespace rt::app {
namespace {

constexpr double kHandRestSeconds = 0.3; // after the last motion

} // namespace

void ViewportBoard::open(std::shared_ptr<Viewport> viewport) {
    {
        const std::scoped_lock lock(mutex_);
        opened_.push_back(std::move(viewport));
    }
    ring();
}

std::vector<std::shared_ptr<Viewport>> ViewportBoard::takeOpened() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(opened_, {});
}

void ViewportBoard::setFocus(ViewportId id) {
    focus_ = id;
    ring();
}

void ViewportBoard::noteMotion() {
    const std::scoped_lock lock(mutex_);
    motion_ = Clock::now();
    hasMovedHeld_ = isHeld_;
}

void ViewportBoard::setHeld(bool isHeld) {
    const std::scoped_lock lock(mutex_);
    if (hasMovedHeld_) motion_ = Clock::now();
    isHeld_ = isHeld;
    hasMovedHeld_ = false;
}

double ViewportBoard::secondsToRest() const {
    const std::scoped_lock lock(mutex_);
    if (hasMovedHeld_) return kHandRestSeconds;
    if (!motion_) return 0;
    return std::max(0.0, kHandRestSeconds - std::chrono::duration<double>(Clock::now() - *motion_).count());
}

void ViewportBoard::ring() {
    {
        const std::scoped_lock lock(mutex_);
        ++rings_;
    }
    bell_.notify_one();
}

std::uint64_t ViewportBoard::rings() const {
    const std::scoped_lock lock(mutex_);
    return rings_;
}

void ViewportBoard::wait(std::uint64_t heard, std::optional<double> seconds) {
    std::unique_lock lock(mutex_);
    const auto hasRung = [&] { return rings_ != heard; };
    if (seconds)
        bell_.wait_for(lock, std::chrono::duration<double>(*seconds), hasRung);
    else
        bell_.wait(lock, hasRung);
}

} // namespace rt::app
