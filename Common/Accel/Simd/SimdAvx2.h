// Simd.h over AVX2 with FMA.
#pragma once
#include <immintrin.h>

#include "Common/Accel/Simd/LowestBit.h"
#include "Common/Accel/Simd/SimdAvx.h"
#include "Common/Shared/Base/Shim.h"

namespace rt::accel {
namespace {

struct Mask8 {
    __m256 v;
};

RT_FN Mask8 operator<(Float8 a, Float8 b) {
    return {_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)};
}
RT_FN Mask8 operator<=(Float8 a, Float8 b) {
    return {_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)};
}
RT_FN Mask8 operator==(Float8 a, Float8 b) {
    return {_mm256_cmp_ps(a.v, b.v, _CMP_EQ_OQ)};
}
RT_FN Mask8 operator&(Mask8 a, Mask8 b) {
    return {_mm256_and_ps(a.v, b.v)};
}
RT_FN Mask8 operator|(Mask8 a, Mask8 b) {
    return {_mm256_or_ps(a.v, b.v)};
}
RT_FN Float8 select(Mask8 m, Float8 a, Float8 b) {
    return {_mm256_blendv_ps(b.v, a.v, m.v)};
}
RT_FN Index8 select(Mask8 m, Index8 a, Index8 b) {
    return {_mm256_blendv_epi8(b.v, a.v, _mm256_castps_si256(m.v))};
}
RT_FN unsigned bits(Mask8 m) {
    return static_cast<unsigned>(_mm256_movemask_ps(m.v));
}

RT_FN std::uint32_t lane(Index8 a, unsigned i) {
    const __m256i index = _mm256_set1_epi32(static_cast<int>(i));
    return static_cast<std::uint32_t>(_mm256_cvtsi256_si32(_mm256_permutevar8x32_epi32(a.v, index)));
}
RT_FN float firstOf(Mask8 m, Float8 a) {
    return lane(a, lowestBit(bits(m)));
}
RT_FN std::uint32_t firstOf(Mask8 m, Index8 a) {
    return lane(a, lowestBit(bits(m)));
}
// [lanes]: the indices of the bits that are set, a byte each.
struct PackedLanes {
    std::uint64_t indices[256];
    constexpr PackedLanes() : indices{} {
        for (unsigned lanes = 0; lanes < 256; ++lanes) {
            unsigned count = 0;
            for (unsigned i = 0; i < 8; ++i) {
                if ((lanes >> i & 1u) != 0) indices[lanes] |= std::uint64_t{i} << 8 * count++;
            }
        }
    }
};
constexpr PackedLanes kPackedLanes;

RT_FN unsigned topBits(Index8 a) {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(a.v)));
}
RT_FN unsigned storePacked(std::uint32_t* p, Index8 a, unsigned lanes) {
    const void* indices = kPackedLanes.indices + lanes;
    const __m256i order = _mm256_cvtepu8_epi32(_mm_loadl_epi64(static_cast<const __m128i*>(indices)));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm256_permutevar8x32_epi32(a.v, order));
    return static_cast<unsigned>(_mm_popcnt_u32(lanes));
}

} // namespace
} // namespace rt::accel
