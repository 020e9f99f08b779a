#include "Common/App/Session/Interrupt.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>

#include "Common/Core/Error.h"

namespace rt::app {
namespace {

// A handler sees nothing but these.
std::atomic<bool> deferring{false};
std::atomic<bool> stopRequested{false};
std::atomic<std::int64_t> firstRequest{0}; // milliseconds of a steady clock; 0: none
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free,
              "or a handler must not touch them");

// `timeout` sends its signal to the program and to the program's group: two within a moment are one request.
constexpr std::int64_t kOneRequest = 200; // milliseconds

constexpr int kSignals[] = {SIGINT, SIGTERM};

std::int64_t milliseconds() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::max<std::int64_t>(1, std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
}

void handle(int signal) {
    const std::int64_t now = milliseconds();
    std::int64_t first = 0;
    bool again = !firstRequest.compare_exchange_strong(first, now) && now - first > kOneRequest;
#ifdef SIGHUP
    again = again && signal != SIGHUP; // of a terminal that closes, the shell and the system tell one after the other
#endif
    if (!deferring || again) std::_Exit(static_cast<int>(ExitCode::Interrupted));
    stopRequested = true;
    std::signal(signal, handle); // some systems reset it
}

} // namespace

Interrupt::Interrupt() {
    deferring = false;
    stopRequested = false;
    firstRequest = 0;
    for (const int signal : kSignals) previous_.emplace_back(signal, std::signal(signal, handle));
#ifdef SIGHUP
    const Handler hangUp = std::signal(SIGHUP, handle);
    if (hangUp == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
    previous_.emplace_back(SIGHUP, hangUp);
#endif
}

Interrupt::~Interrupt() {
    for (const auto& [signal, handler] : previous_) std::signal(signal, handler == SIG_ERR ? SIG_DFL : handler);
}

void Interrupt::defer() {
    deferring = true;
}

void Interrupt::finishFirst(const std::function<void()>& work) {
    deferring = true;
    work();
    deferring = false; // from here on the handler ends the program itself
    if (stopRequested) std::_Exit(static_cast<int>(ExitCode::Interrupted));
}

const std::atomic<bool>& Interrupt::requested() const {
    return stopRequested;
}

} // namespace rt::app
