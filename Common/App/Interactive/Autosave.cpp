#include "Common/App/Interactive/Autosave.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <system_error>
#include <utility>

#include "Common/Core/Error.h"

namespace rt::app {
namespace {

constexpr double kMinRetrySeconds = 0.05; // between two attempts to write what could not be written

} // namespace

Autosave::Autosave(std::filesystem::path folder, std::string program, std::function<void()> onFailure, double seconds)
    : folder_(std::move(folder)),
      program_(std::move(program)),
      onFailure_(std::move(onFailure)),
      seconds_(seconds),
      thread_([this] { work(); }) {}

Autosave::~Autosave() {
    {
        const std::scoped_lock lock(mutex_);
        quit_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

void Autosave::startAnew() {
    pending_.clear();
    seenGesture_ = 0;
    isFresh_ = true;
    if (takenOver_) unwanted_.push_back(std::move(*takenOver_));
    takenOver_.reset();
}

void Autosave::begin(EditedScene scene) {
    {
        const std::scoped_lock lock(mutex_);
        startAnew();
        scene_ = std::move(scene);
    }
    wake_.notify_one();
}

void Autosave::add(scene::EditStep step) {
    {
        const std::scoped_lock lock(mutex_);
        if (!scene_) return;
        appendStep(pending_, std::move(step), seenGesture_);
    }
    wake_.notify_one();
}

void Autosave::end() {
    {
        const std::scoped_lock lock(mutex_);
        startAnew();
        scene_.reset();
    }
    wake_.notify_one();
}

void Autosave::takeOver(ClaimedAutosave left) {
    {
        const std::scoped_lock lock(mutex_);
        takenOver_ = std::move(left);
        isTakeover_ = true;
    }
    wake_.notify_one();
}

std::optional<std::string> Autosave::takeFailure() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(failure_, std::nullopt);
}

// What has come in the meantime is written together. A drag or a slider is one step of it.
void Autosave::work() {
    lowerThreadPriority();
    std::unique_lock lock(mutex_);
    while (true) {
        const auto isAsked = [this] { return quit_ || isFresh_ || isTakeover_ || !pending_.empty(); };
        if (unwritten_.empty())
            wake_.wait(lock, isAsked);
        else // what could not be written is tried again
            wake_.wait_for(lock, std::chrono::duration<double>(std::max(seconds_, kMinRetrySeconds)), isAsked);
        if (!pending_.empty() && !isFresh_)
            wake_.wait_for(lock, std::chrono::duration<double>(seconds_), [this] { return quit_ || isFresh_; });
        const bool isFresh = std::exchange(isFresh_, false), isLast = quit_;
        isTakeover_ = false;
        std::vector<scene::EditStep> steps = std::exchange(pending_, {});
        if (!steps.empty())
            seenGesture_ = steps.back().kind == scene::EditStep::Kind::Perform ? steps.back().gesture : 0;
        const std::optional<EditedScene> scene = scene_;
        std::vector<ClaimedAutosave> unwanted = std::exchange(unwanted_, {});
        lock.unlock();
        for (ClaimedAutosave& left : unwanted) left.remove();
        if (isFresh) drop();
        if (scene && !(steps.empty() && unwritten_.empty())) write(std::move(steps), *scene);
        settle();
        if (isLast && !leavesUnsaved_) drop();
        lock.lock();
        if (isLast) return;
    }
}

void Autosave::drop() {
    if (file_) file_->remove();
    file_.reset();
    goodBytes_ = 0;
    unwritten_.clear();
    leavesUnsaved_ = isBroken_ = false;
}

void Autosave::fail(const std::exception& error) {
    if (std::exchange(hasFailed_, true)) return;
    {
        const std::scoped_lock lock(mutex_);
        failure_ = "unsaved edits are not kept for the case of a crash: " + messageOf(error);
    }
    if (onFailure_) onFailure_();
}

void Autosave::write(std::vector<scene::EditStep> steps, const EditedScene& scene) {
    if (isBroken_) return;
    try {
        if (!file_ && unwritten_.empty()) unwritten_ = autosaveHeader(scene, program_);
        if (!steps.empty()) leavesUnsaved_ = steps.back().leavesUnsaved;
        for (const scene::EditStep& step : steps) unwritten_ += autosaveLine(step);
    } catch (const InputError& error) { // what follows would be done to another scene
        isBroken_ = leavesUnsaved_ = true;
        fail(error);
    }
    try {
        if (!file_) file_ = ClaimedAutosave::make(folder_, program_);
        append(unwritten_);
        goodBytes_ += unwritten_.size();
        unwritten_.clear();
        if (!isBroken_) hasFailed_ = false;
    } catch (const std::exception& error) {
        fail(error);
    }
}

// What was taken over is needed until its steps are written here.
void Autosave::settle() {
    if (!file_ || !unwritten_.empty() || isBroken_) return;
    std::optional<ClaimedAutosave> left;
    {
        const std::scoped_lock lock(mutex_);
        if (pending_.empty()) left = std::exchange(takenOver_, std::nullopt);
    }
    if (left) left->remove();
}

// After an attempt that came to nothing there may be a part of it.
void Autosave::append(const std::string& text) {
    std::error_code error;
    std::filesystem::resize_file(file_->file(), goodBytes_, error);
    if (error) throw RenderError(file_->file().string() + ": " + error.message());
    errno = 0;
    std::ofstream out(file_->file(), std::ios::binary | std::ios::app);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    if (out) return;
    const std::error_code reason(errno != 0 ? errno : EIO, std::generic_category());
    throw RenderError(file_->file().string() + ": " + reason.message());
}

} // namespace rt::app
