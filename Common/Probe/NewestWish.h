// Wishes that are answered on a thread of their own: the newest one wins.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "Common/Render/Stopwatch.h"

namespace rt::probe {

// What there is of an answer so far.
template <class Wish, class Result>
struct Answer {
    Wish wish;          // that this is the answer to
    std::string whyNot; // there is nothing to show; empty: there is
    Result result;
    std::uint64_t serial = 0;
};

// Wish::scene tells whether two of them are about the same scene.
template <class Wish, class Result>
class NewestWish {
  public:
    using State = Answer<Wish, Result>;

    // `answer` is called on the thread for the wish that is the newest when it begins, and with null when nothing is
    // wished any more; it publishes what it finds. `onChange` is called there when that has happened.
    NewestWish(std::function<void(const Wish*)> answer, std::function<void()> onChange)
        : answer_(std::move(answer)), onChange_(std::move(onChange)), thread_([this] { run(); }) {}
    // Calls off what is being answered, and waits for it.
    ~NewestWish() {
        {
            const std::scoped_lock lock(mutex_);
            isEnding_ = true;
            isStale_ = isSceneStale_ = true;
        }
        wake_.notify_all();
        thread_.join();
    }
    NewestWish(const NewestWish&) = delete;
    NewestWish& operator=(const NewestWish&) = delete;

    // A wish that equals the one before changes nothing.
    void wish(std::optional<Wish> wish) {
        {
            const std::scoped_lock lock(mutex_);
            if (wish == wish_) return;
            isSceneStale_ = isSceneStale_ || !wish || !wish_ || wish->scene != wish_->scene;
            isStale_ = isNew_ = true;
            wish_ = std::move(wish);
            if (!wish_) state_.reset();
        }
        wake_.notify_all();
    }
    std::shared_ptr<const State> state() const { // null: none yet
        const std::scoped_lock lock(mutex_);
        return state_;
    }

    // ---- for who answers -------------------------------------------------------------------------------------------

    bool isStale() const { return isStale_; }                               // there is a newer one
    const std::atomic<bool>& isSceneStale() const { return isSceneStale_; } // or it is of another scene
    void publish(const Wish& wish, std::string whyNot, Result result) {
        auto state = std::make_shared<State>(State{wish, std::move(whyNot), std::move(result), ++serial_});
        {
            const std::scoped_lock lock(mutex_);
            if (!wish_) return; // nobody looks any more
            state_ = std::move(state);
        }
        onChange_();
    }

    // Advances work on the wish at hand until it is done or there is a newer wish, but not before its first results
    // are there. These are shown, and then what there is every so many seconds, and all of it.
    template <class Work, class Show>
    void advance(Work& work, double seconds, const Show& show) const {
        app::Stopwatch sinceShown;
        for (bool isFirst = true; !work.isDone();) {
            if (isStale() && work.hasFirst() && !isFirst) return;
            work.advance();
            const bool isDue = isFirst ? work.hasFirst() : sinceShown.seconds() > seconds;
            if (!isDue && !work.isDone()) continue;
            isFirst = false;
            show();
            sinceShown = {};
        }
    }

  private:
    void run() {
        for (;;) {
            std::optional<Wish> wish;
            {
                std::unique_lock lock(mutex_);
                wake_.wait(lock, [this] { return isNew_ || isEnding_; });
                if (isEnding_) return;
                wish = wish_;
                isNew_ = false;
                isStale_ = isSceneStale_ = false;
            }
            answer_(wish ? &*wish : nullptr);
        }
    }

    const std::function<void(const Wish*)> answer_;
    const std::function<void()> onChange_;
    mutable std::mutex mutex_; // guards what follows
    std::condition_variable wake_;
    std::optional<Wish> wish_;
    bool isNew_ = false, isEnding_ = false; // wish_ has not been begun
    std::shared_ptr<const State> state_;

    std::atomic<bool> isStale_{false}, isSceneStale_{false}; // what is being answered
    std::uint64_t serial_ = 0;                               // of the thread
    std::thread thread_;                                     // last: it uses the others
};

} // namespace rt::probe
