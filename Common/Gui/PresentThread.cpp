#include "Common/Gui/PresentThread.h"

#include <utility>

namespace rt::gui {

PresentThread::PresentThread(Presenter& presenter) : presenter_(presenter), thread_([this] { run(); }) {}

PresentThread::~PresentThread() {
    {
        const std::lock_guard lock(mutex_);
        isEnding_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

bool PresentThread::isIdle() {
    const std::lock_guard lock(mutex_);
    if (frame_) return false;
    if (const std::exception_ptr failure = std::exchange(failure_, nullptr)) std::rethrow_exception(failure);
    return true;
}

void PresentThread::present(WindowFrame frame) {
    {
        const std::lock_guard lock(mutex_);
        frame_ = std::move(frame);
    }
    wake_.notify_one();
}

void PresentThread::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        wake_.wait(lock, [this] { return frame_ || isEnding_; });
        if (!frame_) return;
        lock.unlock(); // nobody else touches the frame
        std::exception_ptr failure;
        try {
            presenter_.present(*frame_);
        } catch (...) {
            failure = std::current_exception();
        }
        lock.lock();
        failure_ = failure;
        frame_.reset();
    }
}

} // namespace rt::gui
