// What AVX2 with FMA and AVX-512 have in common of Simd.h: vectors of eight, without masks. The includer has
// immintrin.h.
#pragma once
#include "Common/Shared/Base/Shim.h"

namespace rt::accel {
namespace {

constexpr bool kFusedMultiplyAdd = true;

struct Float8 {
    __m256 v;
};
struct Index8 {
    __m256i v;
};

RT_FN Float8 load(const float* p) {
    return {_mm256_load_ps(p)};
}
RT_FN Float8 broadcast(float x) {
    return {_mm256_set1_ps(x)};
}
RT_FN Index8 loadIndex(const std::uint32_t* p) {
    return {_mm256_load_si256(reinterpret_cast<const __m256i*>(p))};
}
RT_FN Float8 fromWords(const std::uint16_t* p) {
    return {_mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(_mm_load_si128(reinterpret_cast<const __m128i*>(p))))};
}
RT_FN void store(float* p, Float8 a) {
    _mm256_store_ps(p, a.v);
}

RT_FN Float8 operator+(Float8 a, Float8 b) {
    return {_mm256_add_ps(a.v, b.v)};
}
RT_FN Float8 operator-(Float8 a, Float8 b) {
    return {_mm256_sub_ps(a.v, b.v)};
}
RT_FN Float8 operator*(Float8 a, Float8 b) {
    return {_mm256_mul_ps(a.v, b.v)};
}
RT_FN Float8 operator/(Float8 a, Float8 b) {
    return {_mm256_div_ps(a.v, b.v)};
}
RT_FN Float8 multiplyAdd(Float8 a, Float8 b, Float8 c) {
    return {_mm256_fmadd_ps(a.v, b.v, c.v)};
}
RT_FN Float8 multiplySubtract(Float8 a, Float8 b, Float8 c) {
    return {_mm256_fmsub_ps(a.v, b.v, c.v)};
}
RT_FN Float8 negateMultiplyAdd(Float8 a, Float8 b, Float8 c) {
    return {_mm256_fnmadd_ps(a.v, b.v, c.v)};
}
RT_FN Float8 minimum(Float8 a, Float8 b) {
    return {_mm256_min_ps(a.v, b.v)};
}
RT_FN Float8 maximum(Float8 a, Float8 b) {
    return {_mm256_max_ps(a.v, b.v)};
}
RT_FN Float8 squareRoot(Float8 a) {
    return {_mm256_sqrt_ps(a.v)};
}
RT_FN Float8 absolute(Float8 a) {
    return {_mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.v)};
}
// |a| with the sign of b.
RT_FN Float8 withSign(Float8 a, Float8 b) {
    const __m256 sign = _mm256_set1_ps(-0.0f);
    return {_mm256_or_ps(_mm256_andnot_ps(sign, a.v), _mm256_and_ps(sign, b.v))};
}

RT_FN float lane(Float8 a, unsigned i) {
    return _mm256_cvtss_f32(_mm256_permutevar8x32_ps(a.v, _mm256_set1_epi32(static_cast<int>(i))));
}
RT_FN float minimum(Float8 a) {
    __m128 m = _mm_min_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
    m = _mm_min_ps(m, _mm_movehl_ps(m, m));
    return _mm_cvtss_f32(_mm_min_ss(m, _mm_movehdup_ps(m)));
}

} // namespace
} // namespace rt::accel
