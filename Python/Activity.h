// Work of the module while other threads run Python. The end of the interpreter waits for it: a thread that came back
// from such work to an interpreter that is gone would end the process with an error.
#pragma once
#include <atomic>
#include <chrono>
#include <pybind11/pybind11.h>

namespace rt::python {

// To be made and ended with the interpreter's lock held. Once the interpreter ends, what a thread begins throws
// SystemExit, unless it is a part of what the thread has begun before, or the thread is the one that ends it.
class Activity {
  public:
    // `cancel` becomes true when the interpreter ends; null: the work ends soon anyway.
    explicit Activity(std::atomic<bool>* cancel = nullptr);
    ~Activity();
    Activity(const Activity&) = delete;
    Activity& operator=(const Activity&) = delete;

  private:
    std::atomic<bool>* cancel_;
};

// Work without the interpreter's lock.
class Released {
  public:
    explicit Released(std::atomic<bool>* cancel = nullptr) : activity_(cancel) {}

  private:
    Activity activity_;
    pybind11::gil_scoped_release released_;
};

bool threadMustEnd();                   // the interpreter ends, in another thread
const std::atomic<bool>* endOfThread(); // becomes true then; null in the thread that ends the interpreter

// Of long work that is Released, which is to call look() often.
class SignalWatch {
  public:
    // Throws what handlers of signals raise, as KeyboardInterrupt, and Interrupted when the interpreter ends.
    void look();

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

} // namespace rt::python
