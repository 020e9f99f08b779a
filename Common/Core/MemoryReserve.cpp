#include "Common/Core/MemoryReserve.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace rt {
namespace {

constexpr std::size_t kReserve = std::size_t{1} << 20; // bytes

std::atomic<void*> reserve{nullptr};
std::atomic<bool> isKept{false}; // whether there is to be one

void giveReserveBack() {
    void* const memory = reserve.exchange(nullptr);
    if (memory == nullptr) throw std::bad_alloc();
    std::free(memory);
}

} // namespace

void keepMemoryReserve() noexcept {
    if (reserve.load() != nullptr) return;
    isKept = true;
    std::set_new_handler(giveReserveBack);
    void* const memory = std::malloc(kReserve); // which does not call that handler
    void* none = nullptr;
    if (!reserve.compare_exchange_strong(none, memory)) std::free(memory);
}

void requireMemoryReserve() {
    if (!isKept || reserve.load() != nullptr) return;
    keepMemoryReserve();
    if (reserve.load() == nullptr) throw std::bad_alloc();
}

} // namespace rt
