// Simd.h over AVX-512 (F, VL, DQ): eight and sixteen lanes, masks in mask registers.
#pragma once
#if defined(__GNUC__) && \
    !defined(__clang__)  // g++ 12 takes the register that its own intrinsics leave undefined for an error
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <immintrin.h>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

#include "Common/Shared/Shim.h"

namespace rt::accel {
namespace {

constexpr bool kFusedMultiplyAdd = true;
constexpr int kLanes = 16;  // of the widest Float

template <int N>
struct Float;
template <int N>
struct Mask;
template <>
struct Float<8> {
    __m256 v;
};
template <>
struct Float<16> {
    __m512 v;
};
template <int N>
struct Index;
template <>
struct Index<8> {
    __m256i v;
};
template <>
struct Index<16> {
    __m512i v;
};
template <>
struct Mask<8> {
    __mmask8 v;
};
template <>
struct Mask<16> {
    __mmask16 v;
};
using Float8 = Float<8>;
using Mask8 = Mask<8>;
using Index8 = Index<8>;
using Index16 = Index<16>;
using Float16 = Float<16>;
using Mask16 = Mask<16>;

template <int N>
RT_FN Float<N> load(const float* p) {
    if constexpr (N == 16) {
        return {_mm512_loadu_ps(p)};
    } else {
        return {_mm256_load_ps(p)};
    }
}
template <int N>
RT_FN Float<N> broadcast(float x) {
    if constexpr (N == 16) {
        return {_mm512_set1_ps(x)};
    } else {
        return {_mm256_set1_ps(x)};
    }
}
template <int N>
RT_FN Index<N> loadIndex(const std::uint32_t* p) {
    if constexpr (N == 16) {
        return {_mm512_loadu_si512(p)};
    } else {
        return {_mm256_load_si256(reinterpret_cast<const __m256i*>(p))};
    }
}
RT_FN void store(float* p, Float8 a) {
    _mm256_store_ps(p, a.v);
}
RT_FN void store(float* p, Float16 a) {
    _mm512_storeu_ps(p, a.v);
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
RT_FN Mask8 operator<(Float8 a, Float8 b) {
    return {_mm256_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ)};
}
RT_FN Mask8 operator<=(Float8 a, Float8 b) {
    return {_mm256_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ)};
}
RT_FN Mask8 operator==(Float8 a, Float8 b) {
    return {_mm256_cmp_ps_mask(a.v, b.v, _CMP_EQ_OQ)};
}
RT_FN Mask8 operator&(Mask8 a, Mask8 b) {
    return {static_cast<__mmask8>(a.v & b.v)};
}
RT_FN Mask8 operator|(Mask8 a, Mask8 b) {
    return {static_cast<__mmask8>(a.v | b.v)};
}
RT_FN Float8 select(Mask8 m, Float8 a, Float8 b) {
    return {_mm256_mask_blend_ps(m.v, b.v, a.v)};
}
RT_FN Index8 select(Mask8 m, Index8 a, Index8 b) {
    return {_mm256_mask_blend_epi32(m.v, b.v, a.v)};
}
RT_FN unsigned bits(Mask8 m) {
    return m.v;
}
RT_FN float lane(Float8 a, unsigned i) {
    return _mm256_cvtss_f32(_mm256_permutevar8x32_ps(a.v, _mm256_set1_epi32(static_cast<int>(i))));
}
RT_FN float firstOf(Mask8 m, Float8 a) {
    return _mm256_cvtss_f32(_mm256_maskz_compress_ps(m.v, a.v));
}
RT_FN std::uint32_t firstOf(Mask8 m, Index8 a) {
    return static_cast<std::uint32_t>(_mm256_cvtsi256_si32(_mm256_maskz_compress_epi32(m.v, a.v)));
}
RT_FN std::uint32_t lane(Index8 a, unsigned i) {
    return firstOf(Mask8{static_cast<__mmask8>(1u << i)}, a);
}
RT_FN float least(Float8 a) {
    __m128 m = _mm_min_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
    m = _mm_min_ps(m, _mm_movehl_ps(m, m));
    return _mm_cvtss_f32(_mm_min_ss(m, _mm_movehdup_ps(m)));
}

RT_FN Float16 operator+(Float16 a, Float16 b) {
    return {_mm512_add_ps(a.v, b.v)};
}
RT_FN Float16 operator-(Float16 a, Float16 b) {
    return {_mm512_sub_ps(a.v, b.v)};
}
RT_FN Float16 operator*(Float16 a, Float16 b) {
    return {_mm512_mul_ps(a.v, b.v)};
}
RT_FN Float16 operator/(Float16 a, Float16 b) {
    return {_mm512_div_ps(a.v, b.v)};
}
RT_FN Float16 multiplyAdd(Float16 a, Float16 b, Float16 c) {
    return {_mm512_fmadd_ps(a.v, b.v, c.v)};
}
RT_FN Float16 multiplySubtract(Float16 a, Float16 b, Float16 c) {
    return {_mm512_fmsub_ps(a.v, b.v, c.v)};
}
RT_FN Float16 negateMultiplyAdd(Float16 a, Float16 b, Float16 c) {
    return {_mm512_fnmadd_ps(a.v, b.v, c.v)};
}
RT_FN Float16 minimum(Float16 a, Float16 b) {
    return {_mm512_min_ps(a.v, b.v)};
}
RT_FN Float16 maximum(Float16 a, Float16 b) {
    return {_mm512_max_ps(a.v, b.v)};
}
RT_FN Float16 squareRoot(Float16 a) {
    return {_mm512_sqrt_ps(a.v)};
}
RT_FN Float16 absolute(Float16 a) {
    return {_mm512_andnot_ps(_mm512_set1_ps(-0.0f), a.v)};
}
RT_FN Float16 withSign(Float16 a, Float16 b) {
    const __m512 sign = _mm512_set1_ps(-0.0f);
    return {_mm512_or_ps(_mm512_andnot_ps(sign, a.v), _mm512_and_ps(sign, b.v))};
}
RT_FN Mask16 operator<(Float16 a, Float16 b) {
    return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ)};
}
RT_FN Mask16 operator<=(Float16 a, Float16 b) {
    return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ)};
}
RT_FN Mask16 operator==(Float16 a, Float16 b) {
    return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_EQ_OQ)};
}
RT_FN Mask16 operator&(Mask16 a, Mask16 b) {
    return {static_cast<__mmask16>(a.v & b.v)};
}
RT_FN Mask16 operator|(Mask16 a, Mask16 b) {
    return {static_cast<__mmask16>(a.v | b.v)};
}
RT_FN Float16 select(Mask16 m, Float16 a, Float16 b) {
    return {_mm512_mask_blend_ps(m.v, b.v, a.v)};
}
RT_FN Index16 select(Mask16 m, Index16 a, Index16 b) {
    return {_mm512_mask_blend_epi32(m.v, b.v, a.v)};
}
RT_FN unsigned bits(Mask16 m) {
    return m.v;
}
RT_FN float lane(Float16 a, unsigned i) {
    return _mm512_cvtss_f32(_mm512_permutexvar_ps(_mm512_set1_epi32(static_cast<int>(i)), a.v));
}
RT_FN float firstOf(Mask16 m, Float16 a) {
    return _mm512_cvtss_f32(_mm512_maskz_compress_ps(m.v, a.v));
}
RT_FN std::uint32_t firstOf(Mask16 m, Index16 a) {
    return static_cast<std::uint32_t>(_mm512_cvtsi512_si32(_mm512_maskz_compress_epi32(m.v, a.v)));
}
RT_FN std::uint32_t lane(Index16 a, unsigned i) {
    return firstOf(Mask16{static_cast<__mmask16>(1u << i)}, a);
}
RT_FN float least(Float16 a) {
    return least(Float8{_mm256_min_ps(_mm512_castps512_ps256(a.v), _mm512_extractf32x8_ps(a.v, 1))});
}
// Eight lanes among sixteen; the others mean nothing, and their mask is not set.
RT_FN Float16 widen(Float8 a) {
    return {_mm512_castps256_ps512(a.v)};
}
RT_FN Index16 widen(Index8 a) {
    return {_mm512_castsi256_si512(a.v)};
}
RT_FN Mask16 widen(Mask8 m) {
    return {m.v};
}

}  // namespace
}  // namespace rt::accel
