#include "Common/Accel/LargeArray.h"

#include <new>

#include "Common/Core/SystemMemory.h"

namespace rt::accel {
namespace {

constexpr std::size_t kAlignment = 64;

// From half a large page on, memory is whole large pages.
bool isLarge(std::size_t bytes) {
    return bytes >= kLargePage / 2;
}

std::align_val_t alignment(std::size_t bytes) {
    return std::align_val_t{isLarge(bytes) ? kLargePage : kAlignment};
}

} // namespace

void* allocateLarge(std::size_t bytes) {
    if (!isLarge(bytes)) return ::operator new(bytes, alignment(bytes));
    const std::size_t whole = (bytes + kLargePage - 1) / kLargePage * kLargePage;
    void* memory = ::operator new(whole, alignment(bytes));
    preferLargePages(memory, whole);
    return memory;
}

void freeLarge(void* memory, std::size_t bytes) noexcept {
    ::operator delete(memory, alignment(bytes));
}

} // namespace rt::accel
