#include "Common/Core/Interruption.h"

#include <utility>

#include "Common/Core/MemoryReserve.h"

namespace rt {
namespace {

thread_local const std::atomic<bool>* requested = nullptr;

} // namespace

Interruptible::Interruptible(const std::atomic<bool>* flag) : outer_(std::exchange(requested, flag)) {}

Interruptible::~Interruptible() {
    requested = outer_;
}

const std::atomic<bool>* interruptionFlag() {
    return requested;
}

bool interruptionRequested() {
    return requested != nullptr && requested->load(std::memory_order_relaxed);
}

void interruptionPoint() {
    if (interruptionRequested()) throw Interrupted();
    requireMemoryReserve();
}

} // namespace rt
