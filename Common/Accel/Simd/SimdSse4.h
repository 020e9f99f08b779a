// Simd.h over SSE4.2: eight lanes in two registers.
#pragma once
#include <nmmintrin.h>

#include "Common/Accel/Simd/LowestBit.h"
#include "Common/Shared/Base/Shim.h"

namespace rt::accel {
namespace {

constexpr bool kFusedMultiplyAdd = false;

struct Float8 {
    __m128 lo, hi;
};
struct Index8 {
    __m128i lo, hi;
};
struct Mask8 {
    __m128 lo, hi;
};

RT_FN Float8 load(const float* p) {
    return {_mm_load_ps(p), _mm_load_ps(p + 4)};
}
RT_FN Float8 broadcast(float x) {
    return {_mm_set1_ps(x), _mm_set1_ps(x)};
}
RT_FN Index8 loadIndex(const std::uint32_t* p) {
    const __m128i* v = reinterpret_cast<const __m128i*>(p);
    return {_mm_load_si128(v), _mm_load_si128(v + 1)};
}
RT_FN Float8 fromWords(const std::uint16_t* p) {
    const __m128i words = _mm_load_si128(reinterpret_cast<const __m128i*>(p));
    return {_mm_cvtepi32_ps(_mm_cvtepu16_epi32(words)), _mm_cvtepi32_ps(_mm_cvtepu16_epi32(_mm_srli_si128(words, 8)))};
}
RT_FN void store(float* p, Float8 a) {
    _mm_store_ps(p, a.lo);
    _mm_store_ps(p + 4, a.hi);
}

RT_FN Float8 operator+(Float8 a, Float8 b) {
    return {_mm_add_ps(a.lo, b.lo), _mm_add_ps(a.hi, b.hi)};
}
RT_FN Float8 operator-(Float8 a, Float8 b) {
    return {_mm_sub_ps(a.lo, b.lo), _mm_sub_ps(a.hi, b.hi)};
}
RT_FN Float8 operator*(Float8 a, Float8 b) {
    return {_mm_mul_ps(a.lo, b.lo), _mm_mul_ps(a.hi, b.hi)};
}
RT_FN Float8 operator/(Float8 a, Float8 b) {
    return {_mm_div_ps(a.lo, b.lo), _mm_div_ps(a.hi, b.hi)};
}
RT_FN Float8 multiplyAdd(Float8 a, Float8 b, Float8 c) {
    return a * b + c;
}
RT_FN Float8 multiplySubtract(Float8 a, Float8 b, Float8 c) {
    return a * b - c;
}
RT_FN Float8 negateMultiplyAdd(Float8 a, Float8 b, Float8 c) {
    return c - a * b;
}
RT_FN Float8 minimum(Float8 a, Float8 b) {
    return {_mm_min_ps(a.lo, b.lo), _mm_min_ps(a.hi, b.hi)};
}
RT_FN Float8 maximum(Float8 a, Float8 b) {
    return {_mm_max_ps(a.lo, b.lo), _mm_max_ps(a.hi, b.hi)};
}
RT_FN Float8 squareRoot(Float8 a) {
    return {_mm_sqrt_ps(a.lo), _mm_sqrt_ps(a.hi)};
}
RT_FN Float8 absolute(Float8 a) {
    const __m128 sign = _mm_set1_ps(-0.0f);
    return {_mm_andnot_ps(sign, a.lo), _mm_andnot_ps(sign, a.hi)};
}
// |a| with the sign of b.
RT_FN Float8 withSign(Float8 a, Float8 b) {
    const __m128 sign = _mm_set1_ps(-0.0f);
    return {_mm_or_ps(_mm_andnot_ps(sign, a.lo), _mm_and_ps(sign, b.lo)),
            _mm_or_ps(_mm_andnot_ps(sign, a.hi), _mm_and_ps(sign, b.hi))};
}

RT_FN Mask8 operator<(Float8 a, Float8 b) {
    return {_mm_cmplt_ps(a.lo, b.lo), _mm_cmplt_ps(a.hi, b.hi)};
}
RT_FN Mask8 operator<=(Float8 a, Float8 b) {
    return {_mm_cmple_ps(a.lo, b.lo), _mm_cmple_ps(a.hi, b.hi)};
}
RT_FN Mask8 operator==(Float8 a, Float8 b) {
    return {_mm_cmpeq_ps(a.lo, b.lo), _mm_cmpeq_ps(a.hi, b.hi)};
}
RT_FN Mask8 operator&(Mask8 a, Mask8 b) {
    return {_mm_and_ps(a.lo, b.lo), _mm_and_ps(a.hi, b.hi)};
}
RT_FN Mask8 operator|(Mask8 a, Mask8 b) {
    return {_mm_or_ps(a.lo, b.lo), _mm_or_ps(a.hi, b.hi)};
}
RT_FN Float8 select(Mask8 m, Float8 a, Float8 b) {
    return {_mm_blendv_ps(b.lo, a.lo, m.lo), _mm_blendv_ps(b.hi, a.hi, m.hi)};
}
RT_FN Index8 select(Mask8 m, Index8 a, Index8 b) {
    return {_mm_blendv_epi8(b.lo, a.lo, _mm_castps_si128(m.lo)), _mm_blendv_epi8(b.hi, a.hi, _mm_castps_si128(m.hi))};
}
RT_FN unsigned bits(Mask8 m) {
    return static_cast<unsigned>(_mm_movemask_ps(m.lo)) | static_cast<unsigned>(_mm_movemask_ps(m.hi)) << 4;
}

RT_FN float lane(Float8 a, unsigned i) {
    alignas(16) float lanes[8];
    store(lanes, a);
    return lanes[i];
}
RT_FN std::uint32_t lane(Index8 a, unsigned i) {
    alignas(16) std::uint32_t lanes[8];
    _mm_store_si128(reinterpret_cast<__m128i*>(lanes), a.lo);
    _mm_store_si128(reinterpret_cast<__m128i*>(lanes + 4), a.hi);
    return lanes[i];
}
RT_FN float firstOf(Mask8 m, Float8 a) {
    return lane(a, lowestBit(bits(m)));
}
RT_FN std::uint32_t firstOf(Mask8 m, Index8 a) {
    return lane(a, lowestBit(bits(m)));
}
RT_FN unsigned topBits(Index8 a) {
    return static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(a.lo))) |
           static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(a.hi))) << 4;
}
RT_FN unsigned storePacked(std::uint32_t* p, Index8 a, unsigned lanes) {
    alignas(16) std::uint32_t words[8];
    _mm_store_si128(reinterpret_cast<__m128i*>(words), a.lo);
    _mm_store_si128(reinterpret_cast<__m128i*>(words + 4), a.hi);
    unsigned count = 0;
    for (unsigned i = 0; i < 8; ++i) {
        p[count] = words[i];
        count += lanes >> i & 1u;
    }
    return count;
}
RT_FN float minimum(Float8 a) {
    __m128 m = _mm_min_ps(a.lo, a.hi);
    m = _mm_min_ps(m, _mm_movehl_ps(m, m));
    return _mm_cvtss_f32(_mm_min_ss(m, _mm_movehdup_ps(m)));
}

} // namespace
} // namespace rt::accel
