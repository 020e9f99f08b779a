// Eight (with AVX-512 also sixteen) floats at a time, over whatever instruction set the translation unit is compiled
// for.
//
//   Float<N>, Mask<N>   N lanes; plain aggregates that live in registers
//   load, broadcast     from aligned memory; one value in all lanes
//   + - * /, sqrt, abs  lane by lane, correctly rounded
//   multiplyAdd(a,b,c)  a b + c; one rounding where the machine can. multiplySubtract: a b - c, negateMultiplyAdd: c -
//   a b minimum, maximum    (a, b): b where either is not a number, as the x86 instruction < <= >= ==          Mask;
//   false where either is not a number select(m, a, b)     a where m, else b bits(m)             lane i in bit i
//   lane(a, i), least(a)
//
// Everything has internal linkage: each instruction set's copy stays in its own object file.
#pragma once
#include "Common/Shared/Shim.h"

#if defined(RT_SIMD_GENERIC)
#include "Common/Accel/SimdGeneric.h"
#elif defined(__AVX512F__) && defined(__AVX512VL__) && defined(__AVX512DQ__) && defined(__AVX512BW__)
#include "Common/Accel/SimdAvx512.h"
#elif defined(__AVX2__)
#include "Common/Accel/SimdAvx2.h"
#elif defined(__SSE4_2__) || (defined(_MSC_VER) && defined(_M_X64))
#include "Common/Accel/SimdSse4.h"
#else
#include "Common/Accel/SimdGeneric.h"
#endif

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

// a b - c d. With fused multiply-add the error of one product is added back, which makes the sign that of the exact
// difference (Kahan; Jeannerod, Louvet & Muller, "Further analysis of Kahan's algorithm", 2013) unless it underflows.
// Without, both products are rounded: swapping them negates the result exactly, but it may be zero though the exact one
// is not.
template <class F>
RT_FN F differenceOfProducts(F a, F b, F c, F d) {
    if constexpr (kFusedMultiplyAdd) {
        const F cd = c * d;
        return multiplySubtract(a, b, cd) - multiplySubtract(c, d, cd);
    } else {
        return a * b - c * d;
    }
}

}  // namespace
}  // namespace rt::accel
