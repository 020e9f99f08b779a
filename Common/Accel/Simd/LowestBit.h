#pragma once
#include "Common/Shared/Base/Shim.h"

#if defined(_MSC_VER) && !defined(__clang__)
#include <intrin.h>
#endif

namespace rt::accel {
namespace {

// Index of the lowest bit that is set; bits must not be 0.
RT_FN unsigned lowestBit(unsigned bits) {
#if defined(_MSC_VER) && !defined(__clang__)
    unsigned long index;
    _BitScanForward(&index, bits);
    return index;
#else
    return static_cast<unsigned>(__builtin_ctz(bits));
#endif
}

} // namespace
} // namespace rt::accel
