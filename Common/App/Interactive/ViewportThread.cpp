#include "Common/App/Interactive/ViewportThread.h"

#include <utility>

#include "Common/App/Platform.h"
#include "Common/Render/Stopwatch.h"

namespace rt::app {

EndFiles ViewportThread::run() {
    lowerThreadPriority();
    for (bool isEmpty = true;;) {
        const std::uint64_t heard = board_.rings(); // before looking: what comes meanwhile is heard below
        if (open()) isEmpty = false;
        if (places_.empty() && !isEmpty) return endFiles_;
        const double secondsToRest = places_.size() > 1 ? board_.secondsToRest() : 0;
        const std::optional<std::size_t> turn = next(secondsToRest);
        if (!turn) {
            board_.wait(heard, secondsToRest > 0 ? std::optional(secondsToRest) : std::nullopt);
            continue;
        }
        const Stopwatch watch;
        if (places_[*turn].thread->step())
            turns_.spend(*turn, watch.seconds());
        else
            close(*turn);
    }
}

// Whether there is a new one.
bool ViewportThread::open() {
    const auto opened = board_.takeOpened();
    for (const std::shared_ptr<Viewport>& viewport : opened) {
        auto thread = std::make_unique<SessionThread>(viewport->setup, viewport->mailbox, viewport->state, loader_);
        places_.push_back({viewport, std::move(thread)});
        turns_.add();
    }
    return !opened.empty();
}

// What is asked of the one with the focus does not wait. All others rest while the user moves what that shows, or while
// one races.
std::optional<std::size_t> ViewportThread::next(double secondsToRest) {
    const auto first = [this](const auto& is) -> std::optional<std::size_t> {
        for (std::size_t i = 0; i < places_.size(); ++i)
            if (is(i)) return i;
        return std::nullopt;
    };
    if (const auto leaving = first([this](std::size_t i) { return places_[i].viewport->mailbox.isAskedToQuit(); }))
        return leaving;
    const auto asked = [this](std::size_t i) { return places_[i].viewport->mailbox.hasRequests(); };
    const auto racing = first([this](std::size_t i) { return places_[i].thread->isRacing(); });
    std::vector<bool> isWaiting(places_.size());
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const bool rests = racing ? i != *racing : secondsToRest > 0 && !hasFocus(i);
        isWaiting[i] = !rests && (asked(i) || places_[i].thread->hasWork());
    }
    const auto turn = turns_.next(isWaiting);
    const auto wished = first([&](std::size_t i) { return isWaiting[i] && hasFocus(i) && asked(i); });
    return wished ? wished : turn;
}

// Its engine and its film go.
void ViewportThread::close(std::size_t place) {
    Place leaving = std::move(places_[place]); // its thread goes before what that uses
    const EndFiles files = leaving.thread->end();
    endFiles_.hasFilm = endFiles_.hasFilm && files.hasFilm;
    endFiles_.failures.insert(endFiles_.failures.end(), files.failures.begin(), files.failures.end());
    places_.erase(places_.begin() + static_cast<std::ptrdiff_t>(place));
    turns_.remove(place);
}

} // namespace rt::app
