// Presents frames on a thread of their own: a software driver draws while it submits, and a display keeps who presents
// waiting for its next refresh; the window's thread goes on with what its user does meanwhile.
#pragma once
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "Common/Gui/Presenter.h"

namespace rt::gui {

class PresentThread {
  public:
    explicit PresentThread(Presenter& presenter);
    ~PresentThread(); // waits for the frame under way
    PresentThread(const PresentThread&) = delete;
    PresentThread& operator=(const PresentThread&) = delete;

    // Whether no frame is under way. While one is, the presenter, all that the frame draws and the device's queue are
    // this thread's alone. Throws, once, what has ended the last frame.
    bool isIdle();
    void present(WindowFrame frame); // requires isIdle(); returns at once

  private:
    void run();

    Presenter& presenter_;
    std::mutex mutex_; // guards what follows
    std::condition_variable wake_;
    std::optional<WindowFrame> frame_; // until it has been presented
    std::exception_ptr failure_;
    bool isEnding_ = false;
    std::thread thread_; // last: it uses the others
};

} // namespace rt::gui
