// Four floats at a time with what every processor of an architecture has: for builders, which exist once.
#pragma once
#include "Common/Accel/Box.h"

#if defined(__SSE2__) || defined(_M_X64)
#define RT_FLOAT4_SSE 1
#include <emmintrin.h>
#endif

namespace rt::accel {

#if defined(RT_FLOAT4_SSE)

struct Float4 {
    __m128 v;

    Float4() = default;
    explicit Float4(__m128 m) : v(m) {}
    explicit Float4(float x) : v(_mm_set1_ps(x)) {}
    Float4(float x, float y, float z, float w) : v(_mm_setr_ps(x, y, z, w)) {}

    static Float4 load(const float* p) { return Float4(_mm_loadu_ps(p)); }
    // With 0 in place of p[3].
    static Float4 load3(const float* p) {
        return Float4(_mm_and_ps(_mm_loadu_ps(p), _mm_castsi128_ps(_mm_setr_epi32(-1, -1, -1, 0))));
    }
    // p[1], p[2], p[3], 0.
    static Float4 loadLast3(const float* p) {
        return Float4(_mm_castsi128_ps(_mm_srli_si128(_mm_castps_si128(_mm_loadu_ps(p)), 4)));
    }
    void store(float* p) const { _mm_storeu_ps(p, v); }
    // Rounded towards zero.
    void storeInts(std::int32_t* p) const { _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm_cvttps_epi32(v)); }

    friend Float4 operator+(Float4 a, Float4 b) { return Float4(_mm_add_ps(a.v, b.v)); }
    friend Float4 operator-(Float4 a, Float4 b) { return Float4(_mm_sub_ps(a.v, b.v)); }
    friend Float4 operator*(Float4 a, Float4 b) { return Float4(_mm_mul_ps(a.v, b.v)); }
    friend Float4 minimum(Float4 a, Float4 b) { return Float4(_mm_min_ps(a.v, b.v)); }
    friend Float4 maximum(Float4 a, Float4 b) { return Float4(_mm_max_ps(a.v, b.v)); }
};

#else

struct Float4 {
    float v[4];

    Float4() = default;
    explicit Float4(float x) : v{x, x, x, x} {}
    Float4(float x, float y, float z, float w) : v{x, y, z, w} {}

    static Float4 load(const float* p) { return {p[0], p[1], p[2], p[3]}; }
    // With 0 in place of p[3].
    static Float4 load3(const float* p) { return {p[0], p[1], p[2], 0.0f}; }
    // p[1], p[2], p[3], 0.
    static Float4 loadLast3(const float* p) { return {p[1], p[2], p[3], 0.0f}; }
    void store(float* p) const {
        for (int i = 0; i < 4; ++i) {
            p[i] = v[i];
        }
    }
    void storeInts(std::int32_t* p) const {
        for (int i = 0; i < 4; ++i) {
            p[i] = static_cast<std::int32_t>(v[i]);
        }
    }

    friend Float4 operator+(Float4 a, Float4 b) {
        return {a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2], a.v[3] + b.v[3]};
    }
    friend Float4 operator-(Float4 a, Float4 b) {
        return {a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2], a.v[3] - b.v[3]};
    }
    friend Float4 operator*(Float4 a, Float4 b) {
        return {a.v[0] * b.v[0], a.v[1] * b.v[1], a.v[2] * b.v[2], a.v[3] * b.v[3]};
    }
    friend Float4 minimum(Float4 a, Float4 b) {
        for (int i = 0; i < 4; ++i) {
            a.v[i] = a.v[i] < b.v[i] ? a.v[i] : b.v[i];
        }
        return a;
    }
    friend Float4 maximum(Float4 a, Float4 b) {
        for (int i = 0; i < 4; ++i) {
            a.v[i] = a.v[i] > b.v[i] ? a.v[i] : b.v[i];
        }
        return a;
    }
};

#endif

// A box in two registers; the fourth lanes mean nothing and take part in nothing that is read.
struct Bounds {
    Float4 lower, upper; // uninitialised

    static Bounds empty() {
        return {Float4(std::numeric_limits<float>::infinity()), Float4(-std::numeric_limits<float>::infinity())};
    }
    void add(Float4 point) {
        lower = minimum(lower, point);
        upper = maximum(upper, point);
    }
    void add(const Bounds& other) {
        lower = minimum(lower, other.lower);
        upper = maximum(upper, other.upper);
    }
    Box box() const {
        float l[4], u[4];
        lower.store(l);
        upper.store(u);
        Box result;
        result.lower = {l[0], l[1], l[2]};
        result.upper = {u[0], u[1], u[2]};
        return result;
    }
    // Half of the surface area; the box must not be empty.
    float halfArea() const {
        float s[4];
        (upper - lower).store(s);
        return s[0] * s[1] + s[1] * s[2] + s[2] * s[0];
    }
};

} // namespace rt::accel
