#include "Common/App/Session/SceneLoader.h"

#include <utility>

#include "Common/App/Platform.h"
#include "Common/Core/Interruption.h"
#include "Common/Render/Stopwatch.h"

namespace rt::app {
namespace {

LoadedScene load(const SceneRequest& request, const std::atomic<bool>& callOff) {
    const Interruptible interruptible(callOff);
    LoadedScene result;
    result.request = request;
    result.mark = markOf(request.source);
    const Stopwatch watch;
    try {
        result.scene = compile(request);
    } catch (...) {
        result.failure = std::current_exception();
    }
    result.seconds = watch.seconds();
    return result;
}

} // namespace

SceneLoader::SceneLoader(std::function<void(LoadedScene)> onLoaded)
    : onLoaded_(std::move(onLoaded)), thread_([this] { work(); }) {}

SceneLoader::~SceneLoader() {
    {
        const std::scoped_lock lock(mutex_);
        quit_ = callOff_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

void SceneLoader::request(SceneRequest request) {
    {
        const std::scoped_lock lock(mutex_);
        last_ = request;
        next_ = std::move(request);
        callOff_ = true;
        isGivenUp_ = false;
    }
    wake_.notify_one();
}

void SceneLoader::giveUp() {
    const std::scoped_lock lock(mutex_);
    if (next_ || current_) last_ = handedOver_;
    next_.reset();
    isGivenUp_ = callOff_ = true;
}

bool SceneLoader::isWanted(const SceneRequest& request) const {
    const std::scoped_lock lock(mutex_);
    return !isGivenUp_ && request == last_;
}

void SceneLoader::open(const std::string& source) {
    const SceneRequest last = lastRequest();
    request({source, last.oneSidedLights, {}, last.assetsBelow});
}

bool SceneLoader::setOneSidedLights(bool on) {
    SceneRequest last = lastRequest();
    if (last.oneSidedLights == on) return false;
    last.oneSidedLights = on;
    request(std::move(last));
    return true;
}

SceneRequest SceneLoader::lastRequest() const {
    const std::scoped_lock lock(mutex_);
    return last_;
}

std::optional<std::string> SceneLoader::busyWith() const {
    const std::scoped_lock lock(mutex_);
    if (next_) return next_->source;
    if (current_ && !isGivenUp_) return current_->source;
    return std::nullopt;
}

void SceneLoader::work() {
    lowerThreadPriority();
    std::unique_lock lock(mutex_);
    while (true) {
        wake_.wait(lock, [this] { return quit_ || next_; });
        if (quit_) return;
        current_ = std::exchange(next_, std::nullopt);
        const SceneRequest request = *current_;
        callOff_ = false;
        lock.unlock();
        LoadedScene loaded = load(request, callOff_);
        lock.lock();
        const bool wanted = !quit_ && !next_ && !isGivenUp_;
        if (wanted) {
            handedOver_ = request;
            lock.unlock();
            onLoaded_(std::move(loaded));
            lock.lock();
        }
        current_.reset();
    }
}

} // namespace rt::app
