// Ctrl-C and termination requests, by what standard C++ offers.
#pragma once
#include <atomic>

namespace rt::app {

// While it exists, SIGINT and SIGTERM end the program at once with exit code 130; after defer() the first asks to
// stop, and only one that comes at least 0.2 s later ends the program at once. One at a time.
class Interrupt {
  public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    void defer();
    const std::atomic<bool>& requested() const;

  private:
    using Handler = void (*)(int);
    Handler previousInt_;
    Handler previousTerm_;
};

} // namespace rt::app
