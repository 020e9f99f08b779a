// A hint that memory will soon be read.
#pragma once
#if defined(_MSC_VER) && !defined(__clang__)
#include <intrin.h>
#endif

#include "Common/Shared/Base/Shim.h"

namespace rt::accel {
namespace {

// Starts to bring the cache line of `at` in; changes nothing else, whatever the address.
RT_FN void prefetch([[maybe_unused]] const void* at) {
#if !defined(_MSC_VER) || defined(__clang__)
    __builtin_prefetch(at);
#elif defined(_M_X64)
    _mm_prefetch(static_cast<const char*>(at), _MM_HINT_T0);
#endif
}

} // namespace
} // namespace rt::accel
