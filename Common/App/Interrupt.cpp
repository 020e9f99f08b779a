#include "Common/App/Interrupt.h"

#include <csignal>
#include <cstdlib>

#include "Common/Core/Error.h"

namespace rt::app {
namespace {

// A handler sees nothing but these.
std::atomic<bool> deferring{false};
std::atomic<bool> stopRequested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "or a handler must not touch it");

void handle(int signal) {
    if (!deferring || stopRequested.exchange(true)) std::_Exit(static_cast<int>(ExitCode::Interrupted));
    std::signal(signal, handle); // some systems reset it
}

} // namespace

Interrupt::Interrupt() {
    deferring = false;
    stopRequested = false;
    previousInt_ = std::signal(SIGINT, handle);
    previousTerm_ = std::signal(SIGTERM, handle);
}

Interrupt::~Interrupt() {
    std::signal(SIGINT, previousInt_ == SIG_ERR ? SIG_DFL : previousInt_);
    std::signal(SIGTERM, previousTerm_ == SIG_ERR ? SIG_DFL : previousTerm_);
}

void Interrupt::defer() {
    deferring = true;
}

const std::atomic<bool>& Interrupt::requested() const {
    return stopRequested;
}

} // namespace rt::app
