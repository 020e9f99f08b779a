#include "Common/Core/SystemMemory.h"

#include <cstdint>

#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
#endif
#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace rt {

void releaseFreedMemory() {
#if defined(__GLIBC__)
    malloc_trim(0);
#endif
}

void preferLargePages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) noexcept {
#if defined(__linux__)
    const auto address = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t skipped = (kLargePage - address % kLargePage) % kLargePage;
    if (bytes < skipped + kLargePage) return;
    const std::size_t whole = (bytes - skipped) / kLargePage * kLargePage;
    madvise(static_cast<char*>(memory) + skipped, whole, MADV_HUGEPAGE); // failure changes nothing
#endif
}

void providePages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) noexcept {
#if defined(__linux__) && defined(MADV_POPULATE_WRITE)
    static const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    const auto address = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t begin = (address + page - 1) / page * page, end = (address + bytes) / page * page;
    if (begin < end) madvise(static_cast<char*>(memory) + (begin - address), end - begin, MADV_POPULATE_WRITE);
#endif
}

void discard([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) noexcept {
#if defined(__linux__)
    static const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    const auto address = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t begin = (address + page - 1) / page * page, end = (address + bytes) / page * page;
    if (begin < end) madvise(static_cast<char*>(memory) + (begin - address), end - begin, MADV_DONTNEED);
#endif
}

} // namespace rt
