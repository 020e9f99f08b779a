// Eight floats at a time for the denoiser's kernel: GCC's and Clang's vectors, elsewhere loops. Everything has internal
// linkage, as each instruction set's copy must stay in its own object file.
#pragma once
#include "Common/Shared/Base/Shim.h"

#if defined(__FMA__) && defined(__AVX__)
#include <immintrin.h>
#endif

namespace rt::image {
namespace {

inline constexpr int kLaneCount = 8;

// Before a loop of few rounds that is to be none in the end, and one of kLaneCount rounds that is to be one vector.
#if defined(__GNUC__) && !defined(__clang__)
#define RT_UNROLL _Pragma("GCC unroll 17")
#define RT_AS_VECTOR _Pragma("GCC unroll 1")
#else
#define RT_UNROLL
#define RT_AS_VECTOR
#endif

#if defined(__GNUC__)

// How vectors are passed depends on the instruction set, which does not matter within one object file.
#pragma GCC diagnostic ignored "-Wpsabi"

// May begin at any float; as a value it is what a register holds.
using Float8 __attribute__((vector_size(32))) = float;
using Float8InMemory __attribute__((vector_size(32), aligned(4), may_alias)) = float;

RT_FN Float8 load(const float* p) {
    return *reinterpret_cast<const Float8InMemory*>(p);
}
RT_FN void store(float* p, Float8 a) {
    *reinterpret_cast<Float8InMemory*>(p) = a;
}
RT_FN Float8 broadcast(float x) {
    return Float8{x, x, x, x, x, x, x, x};
}
RT_FN Float8 maximum(Float8 a, Float8 b) {
#if defined(__FMA__) && defined(__AVX__)
    return _mm256_max_ps(a, b);
#else
    return a > b ? a : b;
#endif
}

#else

struct Float8 {
    float v[kLaneCount];
};
RT_FN Float8 load(const float* p) {
    Float8 r;
    for (int i = 0; i < kLaneCount; ++i) r.v[i] = p[i];
    return r;
}
RT_FN void store(float* p, Float8 a) {
    for (int i = 0; i < kLaneCount; ++i) p[i] = a.v[i];
}
RT_FN Float8 broadcast(float x) {
    Float8 r;
    for (int i = 0; i < kLaneCount; ++i) r.v[i] = x;
    return r;
}
RT_FN Float8 operator+(Float8 a, Float8 b) {
    for (int i = 0; i < kLaneCount; ++i) a.v[i] += b.v[i];
    return a;
}
RT_FN Float8 operator-(Float8 a, Float8 b) {
    for (int i = 0; i < kLaneCount; ++i) a.v[i] -= b.v[i];
    return a;
}
RT_FN Float8 operator*(Float8 a, Float8 b) {
    for (int i = 0; i < kLaneCount; ++i) a.v[i] *= b.v[i];
    return a;
}
RT_FN Float8 operator/(Float8 a, Float8 b) {
    for (int i = 0; i < kLaneCount; ++i) a.v[i] /= b.v[i];
    return a;
}
RT_FN Float8 maximum(Float8 a, Float8 b) {
    for (int i = 0; i < kLaneCount; ++i) a.v[i] = a.v[i] > b.v[i] ? a.v[i] : b.v[i];
    return a;
}

#endif

// a b + c
RT_FN Float8 multiplyAdd(Float8 a, Float8 b, Float8 c) {
#if defined(__GNUC__) && defined(__FMA__) && defined(__AVX__)
    return _mm256_fmadd_ps(a, b, c);
#else
    return a * b + c;
#endif
}
// c - a b
RT_FN Float8 negateMultiplyAdd(Float8 a, Float8 b, Float8 c) {
#if defined(__GNUC__) && defined(__FMA__) && defined(__AVX__)
    return _mm256_fnmadd_ps(a, b, c);
#else
    return c - a * b;
#endif
}
// Of numbers from 0 on.
RT_FN bool isAnyPositive(Float8 a) {
#if defined(__GNUC__) && defined(__FMA__) && defined(__AVX__)
    return _mm256_testz_si256(_mm256_castps_si256(a), _mm256_castps_si256(a)) == 0;
#else
    float lanes[kLaneCount];
    store(lanes, a);
    float largest = 0;
    for (const float lane : lanes) largest = lane > largest ? lane : largest;
    return largest > 0;
#endif
}

} // namespace
} // namespace rt::image
