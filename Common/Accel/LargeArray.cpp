#include "Common/Accel/LargeArray.h"

#include <cstdint>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace rt::accel {
namespace {

constexpr std::size_t kLargePage = std::size_t{1} << 21;
constexpr std::align_val_t kAlignment{64};

}  // namespace

// Memory is aligned to 64 bytes. From two large pages on the range of whole pages in it is advised to be backed by
// them.
void* allocateLarge(std::size_t bytes) {
    void* memory = ::operator new(bytes, kAlignment);
#if defined(__linux__)
    const std::uintptr_t begin = (reinterpret_cast<std::uintptr_t>(memory) + kLargePage - 1) / kLargePage * kLargePage;
    const std::uintptr_t end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / kLargePage * kLargePage;
    if (end > begin)
        madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // a wish: failure changes nothing
#endif
    return memory;
}

void freeLarge(void* memory) noexcept {
    ::operator delete(memory, kAlignment);
}

}  // namespace rt::accel
