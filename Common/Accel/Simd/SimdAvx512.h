// Simd.h over AVX-512 (F, VL, DQ): masks in mask registers.
#pragma once
#if defined(__GNUC__) && \
    !defined(__clang__) // g++ 12 takes the register that its own intrinsics leave undefined for an error
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <immintrin.h>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

#include "Common/Accel/Simd/SimdAvx.h"
#include "Common/Shared/Base/Shim.h"

namespace rt::accel {
namespace {

struct Mask8 {
    __mmask8 v;
};

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
RT_FN float firstOf(Mask8 m, Float8 a) {
    return _mm256_cvtss_f32(_mm256_maskz_compress_ps(m.v, a.v));
}
RT_FN std::uint32_t firstOf(Mask8 m, Index8 a) {
    return static_cast<std::uint32_t>(_mm256_cvtsi256_si32(_mm256_maskz_compress_epi32(m.v, a.v)));
}
RT_FN std::uint32_t lane(Index8 a, unsigned i) {
    return firstOf(Mask8{static_cast<__mmask8>(1u << i)}, a);
}
RT_FN unsigned topBits(Index8 a) {
    return _mm256_movepi32_mask(a.v);
}
RT_FN unsigned storePacked(std::uint32_t* p, Index8 a, unsigned lanes) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm256_maskz_compress_epi32(static_cast<__mmask8>(lanes), a.v));
    return static_cast<unsigned>(_mm_popcnt_u32(lanes));
}

} // namespace
} // namespace rt::accel
