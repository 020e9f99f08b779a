// Ctrl-C, termination requests and terminals that go away, by what standard C++ offers.
#pragma once
#include <atomic>
#include <functional>
#include <utility>
#include <vector>

namespace rt::app {

// While it exists, SIGINT, SIGTERM and SIGHUP end the program at once with exit code 130; after defer() the first asks
// to stop, and only a SIGINT or SIGTERM that comes at least 0.2 s later ends the program at once. A SIGHUP that was
// ignored, as nohup does, stays so. One at a time.
class Interrupt {
  public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    void defer();
    // Before defer(): a signal that comes meanwhile ends the program once `work` is done, which would leave files
    // behind.
    void finishFirst(const std::function<void()>& work);
    const std::atomic<bool>& requested() const;

  private:
    using Handler = void (*)(int);
    std::vector<std::pair<int, Handler>> previous_; // of each signal
};

} // namespace rt::app
