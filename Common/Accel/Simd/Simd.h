// Eight floats at a time, over whatever instruction set the translation unit is compiled for. (Sixteen lanes were
// measured to lose: their divisions and their masks take longer than a second register of eight.)
//
//   Float8, Mask8       eight lanes; plain aggregates that live in registers
//   load, broadcast     from aligned memory; one value in all lanes
//   + - * /             lane by lane, correctly rounded; squareRoot, absolute
//   multiplyAdd         (a, b, c): a b + c, one rounding where the machine can; multiplySubtract: a b - c,
//                       negateMultiplyAdd: c - a b
//   minimum, maximum    (a, b): b where either is not a number, as the x86 instruction
//   < <= >= ==          Mask8; false where either is not a number
//   select(m, a, b)     a where m, else b
//   bits(m)             lane i in bit i
//   lane(a, i), least(a)
//   firstOf(m, a)       the lane of the lowest bit of m, of which one must be set
//   Index8              eight words, only carried along: loadIndex, select, firstOf
//   topBits(a)          the top bit of word i in bit i
//   fromWords(p)        eight words of 16 bits as floats
//   storePacked(p, a, lanes)  the lanes of `a` whose bits are set, side by side; writes all eight words, returns how many
//
// Everything has internal linkage: each instruction set's copy stays in its own object file.
#pragma once
#include <cstdint>

#include "Common/Accel/Simd/LowestBit.h"
#include "Common/Shared/Base/Shim.h"

#if defined(RT_SIMD_GENERIC)
#include "Common/Accel/Simd/SimdGeneric.h"
#elif defined(__AVX512F__) && defined(__AVX512VL__) && defined(__AVX512DQ__) && defined(__AVX512BW__)
#include "Common/Accel/Simd/SimdAvx512.h"
#elif defined(__AVX2__)
#include "Common/Accel/Simd/SimdAvx2.h"
#elif defined(__SSE4_2__) || (defined(_MSC_VER) && defined(_M_X64))
#include "Common/Accel/Simd/SimdSse4.h"
#else
#include "Common/Accel/Simd/SimdGeneric.h"
#endif
