// Simd.h in plain C++: loops over eight lanes, which compilers turn into whatever vectors the machine has.
#pragma once
#include <cmath>

#include "Common/Accel/Simd/LowestBit.h"
#include "Common/Shared/Base/Shim.h"

namespace rt::accel {
namespace {

#if defined(FP_FAST_FMAF)
constexpr bool kFusedMultiplyAdd = true;
#else
constexpr bool kFusedMultiplyAdd = false;
#endif

struct Float8 {
    float v[8];
};
struct Index8 {
    std::uint32_t v[8];
};
struct Mask8 {
    bool v[8];
};

// Lane by lane; `expression` names the lane i.
#define RT_EACH_LANE(Result, expression) \
    Result r;                            \
    for (int i = 0; i < 8; ++i) {        \
        r.v[i] = expression;             \
    }                                    \
    return r

RT_FN float scalarMultiplyAdd(float a, float b, float c) {
    if constexpr (kFusedMultiplyAdd) {
        return std::fma(a, b, c);
    } else {
        return a * b + c;
    }
}

RT_FN Float8 load(const float* p) {
    RT_EACH_LANE(Float8, p[i]);
}
RT_FN Float8 broadcast(float x) {
    RT_EACH_LANE(Float8, x);
}
RT_FN Index8 loadIndex(const std::uint32_t* p) {
    RT_EACH_LANE(Index8, p[i]);
}
RT_FN Float8 fromWords(const std::uint16_t* p) {
    RT_EACH_LANE(Float8, static_cast<float>(p[i]));
}
RT_FN void store(float* p, Float8 a) {
    for (int i = 0; i < 8; ++i) {
        p[i] = a.v[i];
    }
}

RT_FN Float8 operator+(Float8 a, Float8 b) {
    RT_EACH_LANE(Float8, a.v[i] + b.v[i]);
}
RT_FN Float8 operator-(Float8 a, Float8 b) {
    RT_EACH_LANE(Float8, a.v[i] - b.v[i]);
}
RT_FN Float8 operator*(Float8 a, Float8 b) {
    RT_EACH_LANE(Float8, a.v[i] * b.v[i]);
}
RT_FN Float8 operator/(Float8 a, Float8 b) {
    RT_EACH_LANE(Float8, a.v[i] / b.v[i]);
}
RT_FN Float8 multiplyAdd(Float8 a, Float8 b, Float8 c) {
    RT_EACH_LANE(Float8, scalarMultiplyAdd(a.v[i], b.v[i], c.v[i]));
}
RT_FN Float8 multiplySubtract(Float8 a, Float8 b, Float8 c) {
    RT_EACH_LANE(Float8, scalarMultiplyAdd(a.v[i], b.v[i], -c.v[i]));
}
RT_FN Float8 negateMultiplyAdd(Float8 a, Float8 b, Float8 c) {
    RT_EACH_LANE(Float8, scalarMultiplyAdd(-a.v[i], b.v[i], c.v[i]));
}
RT_FN Float8 minimum(Float8 a, Float8 b) {
    RT_EACH_LANE(Float8, a.v[i] < b.v[i] ? a.v[i] : b.v[i]);
}
RT_FN Float8 maximum(Float8 a, Float8 b) {
    RT_EACH_LANE(Float8, a.v[i] > b.v[i] ? a.v[i] : b.v[i]);
}
RT_FN Float8 squareRoot(Float8 a) {
    RT_EACH_LANE(Float8, std::sqrt(a.v[i]));
}
RT_FN Float8 absolute(Float8 a) {
    RT_EACH_LANE(Float8, std::fabs(a.v[i]));
}
// |a| with the sign of b.
RT_FN Float8 withSign(Float8 a, Float8 b) {
    RT_EACH_LANE(Float8, std::copysign(a.v[i], b.v[i]));
}

RT_FN Mask8 operator<(Float8 a, Float8 b) {
    RT_EACH_LANE(Mask8, a.v[i] < b.v[i]);
}
RT_FN Mask8 operator<=(Float8 a, Float8 b) {
    RT_EACH_LANE(Mask8, a.v[i] <= b.v[i]);
}
RT_FN Mask8 operator==(Float8 a, Float8 b) {
    RT_EACH_LANE(Mask8, a.v[i] == b.v[i]);
}
RT_FN Mask8 operator&(Mask8 a, Mask8 b) {
    RT_EACH_LANE(Mask8, a.v[i] && b.v[i]);
}
RT_FN Mask8 operator|(Mask8 a, Mask8 b) {
    RT_EACH_LANE(Mask8, a.v[i] || b.v[i]);
}
RT_FN Float8 select(Mask8 m, Float8 a, Float8 b) {
    RT_EACH_LANE(Float8, m.v[i] ? a.v[i] : b.v[i]);
}
RT_FN Index8 select(Mask8 m, Index8 a, Index8 b) {
    RT_EACH_LANE(Index8, m.v[i] ? a.v[i] : b.v[i]);
}
RT_FN unsigned bits(Mask8 m) {
    unsigned result = 0;
    for (int i = 0; i < 8; ++i) {
        result |= static_cast<unsigned>(m.v[i]) << i;
    }
    return result;
}

RT_FN float lane(Float8 a, unsigned i) {
    return a.v[i];
}
RT_FN std::uint32_t lane(Index8 a, unsigned i) {
    return a.v[i];
}
RT_FN float firstOf(Mask8 m, Float8 a) {
    return a.v[lowestBit(bits(m))];
}
RT_FN std::uint32_t firstOf(Mask8 m, Index8 a) {
    return a.v[lowestBit(bits(m))];
}
RT_FN unsigned topBits(Index8 a) {
    unsigned result = 0;
    for (int i = 0; i < 8; ++i) result |= a.v[i] >> 31 << i;
    return result;
}
RT_FN unsigned storePacked(std::uint32_t* p, Index8 a, unsigned lanes) {
    unsigned count = 0;
    for (unsigned i = 0; i < 8; ++i) {
        p[count] = a.v[i];
        count += lanes >> i & 1u;
    }
    return count;
}
RT_FN float minimum(Float8 a) {
    float result = a.v[0];
    for (int i = 1; i < 8; ++i) {
        result = a.v[i] < result ? a.v[i] : result;
    }
    return result;
}

#undef RT_EACH_LANE

} // namespace
} // namespace rt::accel
