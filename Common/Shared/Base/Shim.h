// The one place where C++ and GLSL differ, but for SceneAccess.h. Every other header of Common/Shared is valid as C++20
// and as GLSL 460 (scalar block layout) alike; what the common subset may not use is listed in docs/shared-code.md.
//
//   RT_FN            prefix of every function: internal linkage in C++, which keeps the copies compiled for different
//                    instruction sets apart, and forced inlining in kernels; nothing in GLSL.
//   RT_METHOD_FN     the same for member functions of kernels, in C++ alone.
//   RT_CALL          the same for a function that is worth a call: never inlined in kernels.
//   RT_IN(T)         a record that is read; in C++ by reference, since compilers copy records that are inlined by value.
//   RT_INOUT(T)      a parameter that is read and written; RT_OUT(T) one that is only written.
//   RT_CONST         prefix of a constant that is no number, such as a set of features.
//   RT_SHARED_BEGIN  opens namespace rt::shared in C++; RT_SHARED_END closes it.
#ifndef RT_SHARED_SHIM_H
#define RT_SHARED_SHIM_H

#ifdef __cplusplus

#ifndef GLM_FORCE_INLINE
#error "define GLM_FORCE_INLINE for every translation unit: GLM's functions must not be emitted out of line"
#endif
#include <bit>
#include <cmath>
#include <cstdint>
#include <math.h>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#if !defined(RT_KERNEL) // elsewhere what is inlined by force doubles the time that compilers take
#define RT_METHOD_FN inline
#define RT_FN [[maybe_unused]] static inline
#define RT_CALL [[maybe_unused]] static
#elif defined(_MSC_VER) && !defined(__clang__)
#define RT_METHOD_FN __forceinline
#define RT_FN static __forceinline
#define RT_CALL static __declspec(noinline)
#else
#define RT_METHOD_FN [[gnu::always_inline]] inline
#define RT_FN [[maybe_unused, gnu::always_inline]] static inline
#define RT_CALL [[maybe_unused, gnu::noinline]] static
#endif
#define RT_IN(T) const T&
#define RT_INOUT(T) T&
#define RT_OUT(T) T&
#define RT_CONST constexpr
#define RT_SHARED_BEGIN namespace rt::shared {
#define RT_SHARED_END }

RT_SHARED_BEGIN

using uint = std::uint32_t;
using vec2 = glm::vec2;
using vec3 = glm::vec3;
using vec4 = glm::vec4;
using ivec2 = glm::ivec2;
using ivec3 = glm::ivec3;
using uvec2 = glm::uvec2;
using uvec3 = glm::uvec3;
using uvec4 = glm::uvec4;

using glm::clamp;
using glm::cross;
using glm::dot;
using glm::floor;
using glm::length;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using std::acos;
using std::asin;
using std::atan;
using std::exp;
using std::exp2;
using std::log;
using std::pow;

// std::sqrt is a weak function, of which compilers may leave a copy in the kernel of one instruction set.
RT_FN float sqrt(float x) {
    return ::sqrtf(x);
}
RT_FN float inversesqrt(float x) {
    return 1.0f / ::sqrtf(x);
}
// GLM's own is a comparison, which becomes a branch that no processor predicts.
RT_FN float abs(float x) {
    return std::fabs(x);
}
RT_FN vec3 abs(vec3 v) {
    return vec3(std::fabs(v.x), std::fabs(v.y), std::fabs(v.z));
}
RT_FN vec4 abs(vec4 v) {
    return vec4(std::fabs(v.x), std::fabs(v.y), std::fabs(v.z), std::fabs(v.w));
}
RT_FN uint floatBitsToUint(float x) {
    return std::bit_cast<uint>(x);
}
RT_FN float uintBitsToFloat(uint x) {
    return std::bit_cast<float>(x);
}
// Exchanges a and b where `is` holds. As bits, since a comparison would become a branch that no processor predicts.
RT_FN void conditionalSwap(bool is, float& a, float& b) {
    const uint bits = (floatBitsToUint(a) ^ floatBitsToUint(b)) & (0u - uint(is));
    a = uintBitsToFloat(floatBitsToUint(a) ^ bits);
    b = uintBitsToFloat(floatBitsToUint(b) ^ bits);
}
// GLSL spells atan2 with two arguments of atan.
RT_FN float atan(float y, float x) {
    return std::atan2(y, x);
}
RT_FN uint bitfieldReverse(uint x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}

// A set of features, see Features.h: three words of bits, which work as the components of GLSL's uvec3 do.
struct Features {
    uint scene = 0;
    uint materials = 0;
    uint methods = 0;

    constexpr Features() = default;
    constexpr Features(uint sceneBits, uint materialBits, uint methodBits)
        : scene(sceneBits), materials(materialBits), methods(methodBits) {}

    RT_METHOD_FN constexpr Features operator&(const Features& other) const {
        return {scene & other.scene, materials & other.materials, methods & other.methods};
    }
    RT_METHOD_FN constexpr Features operator|(const Features& other) const {
        return {scene | other.scene, materials | other.materials, methods | other.methods};
    }
    RT_METHOD_FN constexpr Features operator~() const { return {~scene, ~materials, ~methods}; }
    constexpr Features& operator|=(const Features& other) { return *this = *this | other; }
    constexpr Features& operator&=(const Features& other) { return *this = *this & other; }
    constexpr bool operator==(const Features&) const = default;
};

RT_SHARED_END

#else

#define Features uvec3

#define RT_FN
#define RT_CALL
#define RT_IN(T) T
#define RT_INOUT(T) inout T
#define RT_OUT(T) out T
#define RT_CONST const
#define RT_SHARED_BEGIN
#define RT_SHARED_END

void conditionalSwap(bool is, inout float a, inout float b) {
    float first = is ? b : a;
    b = is ? a : b;
    a = first;
}

#endif

#endif
