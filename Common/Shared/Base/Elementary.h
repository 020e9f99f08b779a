// Elementary functions with the same short code on every device: Vulkan promises only 2^-11 for sin and cos and 4096
// ulp for atan, and libm's calls cannot be inlined. Polynomials are our own minimax fits. Bounds are asserted by the
// tests.
#ifndef RT_SHARED_ELEMENTARY_H
#define RT_SHARED_ELEMENTARY_H
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

const uint kSignBit = 0x80000000u;

// 1 or -1 by the sign bit: -0 counts as negative, on every device.
RT_FN float signOf(float x) {
    return uintBitsToFloat((floatBitsToUint(x) & kSignBit) | 0x3f800000u);
}

// By exponent bits, because compilers may assume that isnan() is false.
RT_FN bool isFinite(float x) {
    return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u;
}
RT_FN bool isFinite(vec3 v) {
    return isFinite(v.x) && isFinite(v.y) && isFinite(v.z);
}

// n / d and, in `rest`, n % d, for n < 2^22: devices divide integers in some twenty instructions, floats in few.
RT_FN uint quotient(uint n, uint d, RT_INOUT(uint) rest) {
    uint q = uint(float(n) / float(d));
    rest = n - q * d;
    if (rest >= 0x80000000u) { // below 0: the quotient was rounded up
        q--;
        rest += d;
    }
    if (rest >= d) {
        q++;
        rest -= d;
    }
    return q;
}

// (sin, cos) of 2 pi r, |r| <= 1/8. Absolute error <= 1.2e-7.
RT_FN vec2 sinCosOctant(float r) {
    float z = r * r;
    return vec2(r * (6.28318531f + z * (-41.3416732f + z * (81.5939369f + z * -75.4533958f))),
                1.0f + z * (-19.7392087f + z * (64.9393265f + z * (-85.4437417f + z * 59.2459639f))));
}

// (sin, cos) of 2 pi u, 0 <= u <= 1: reduced exactly to an octant. Absolute error <= 1.2e-7.
RT_FN vec2 sinCos2Pi(float u) {
    // At most 4. The mask keeps GCC from taking the way to an integer and back for a call of trunc(), of which it makes
    // no vectors.
    uint quadrant = uint(4.0f * u + 0.5f) & 7u;
    vec2 sc = sinCosOctant(u - 0.25f * float(quadrant));
    conditionalSwap((quadrant & 1u) != 0u, sc.x, sc.y);
    return vec2(uintBitsToFloat(floatBitsToUint(sc.x) ^ ((quadrant & 2u) << 30u)),
                uintBitsToFloat(floatBitsToUint(sc.y) ^ (((quadrant + 1u) & 2u) << 30u)));
}

// Angle of the vector (x, y) in [-pi, pi]; 0 for the zero vector. Relative error <= 3e-7, also of the smallest angles.
RT_FN float arcTan(float y, float x) {
    float ax = abs(x);
    float ay = abs(y);
    float t = min(ax, ay) / max(max(ax, ay), 1.0e-37f);
    float z = t * t;
    float p = -0.0163679106f + z * 0.00292069052f;
    p = -0.0755220832f + z * (0.043211813f + z * p);
    p = -0.142110540f + z * (0.106660008f + z * p);
    p = -0.333331527f + z * (0.199937726f + z * p);
    float a = t + t * z * p;
    a = ay > ax ? 1.57079633f - a : a;
    a = x < 0.0f ? kPi - a : a;
    return uintBitsToFloat(floatBitsToUint(a) | (floatBitsToUint(y) & kSignBit));
}

// log(y), y > 0 and not denormal, where y = fl(1 + x) and x is the exact difference if y is in [sqrt(1/2), sqrt(2)).
RT_FN float logOnePlus(float y, float x) {
    // y = 2^k m with m in [sqrt(1/2), sqrt(2)); log m = 2 artanh(f / (2 + f)), f = m - 1, which is x itself if k = 0.
    uint bits = floatBitsToUint(y) - 0x3f3504f3u;
    int k = int(bits) >> 23;
    float f = k == 0 ? x : uintBitsToFloat((bits & 0x007fffffu) + 0x3f3504f3u) - 1.0f;
    float s = f / (2.0f + f);
    float z = s * s;
    float p = 2.0f * s * z * (0.333333328f + z * (0.200001676f + z * (0.14268651f + z * 0.117911413f)));
    // 2 s = f - f s: the leading term stays exact.
    return float(k) * 0.693147181f + (f - (f * s - p));
}

// log(1 + x), x > -1. Error <= 4 ulp.
RT_FN float log1p(float x) {
    return logOnePlus(1.0f + x, x);
}

// log(x), x > 0 and not denormal. Error <= 4 ulp.
RT_FN float logarithm(float x) {
    return logOnePlus(x, x - 1.0f);
}

// (2^k, exp(x) / 2^k - 1), |x| < 87: the first is exact.
RT_FN vec2 expParts(float x) {
    float k = floor(x * 1.44269504f + 0.5f);
    float r = x - k * 0.693359375f + k * 2.12194440e-4f; // ln 2 in two parts, the first with few bits
    float p = 0.166666668f + r * (0.0416664820f + r * (0.00833328217f + r * (0.00139333142f + r * 1.99096822e-4f)));
    return vec2(uintBitsToFloat(uint(int(k) + 127) << 23u), r + r * r * (0.5f + r * p));
}

// exp(x) within 4 ulp for |x| < 87; beyond, the value there.
RT_FN float exponential(float x) {
    vec2 e = expParts(clamp(x, -87.0f, 87.0f));
    return e.x * e.y + e.x;
}

// exp(x) - 1 within 4 ulp for x < 87, also for the smallest x.
RT_FN float expm1(float x) {
    vec2 e = expParts(clamp(x, -87.0f, 87.0f));
    return e.x * e.y + (e.x - 1.0f);
}

RT_SHARED_END

#endif
