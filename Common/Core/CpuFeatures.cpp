#include "Common/Core/CpuFeatures.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <string>

#include "Common/Core/Error.h"

#if defined(__x86_64__) || defined(_M_X64)
#define RT_X86 1
#if defined(_MSC_VER)
#include <immintrin.h>
#include <intrin.h>
#else
#include <cpuid.h>
#endif
#endif

namespace rt {
namespace {

#ifdef RT_X86

struct CpuidRegisters {
    std::uint32_t eax = 0, ebx = 0, ecx = 0, edx = 0;
};

CpuidRegisters cpuid(std::uint32_t leaf, std::uint32_t subleaf = 0) {
    CpuidRegisters r;
#if defined(_MSC_VER)
    int out[4];
    __cpuidex(out, static_cast<int>(leaf), static_cast<int>(subleaf));
    r = {static_cast<std::uint32_t>(out[0]), static_cast<std::uint32_t>(out[1]), static_cast<std::uint32_t>(out[2]),
         static_cast<std::uint32_t>(out[3])};
#else
    __get_cpuid_count(leaf, subleaf, &r.eax, &r.ebx, &r.ecx, &r.edx);
#endif
    return r;
}

// Which register states the operating system saves.
std::uint64_t enabledStates() {
#if defined(_MSC_VER)
    return _xgetbv(0);
#else
    std::uint32_t low = 0, high = 0;
    __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return std::uint64_t{high} << 32 | low;
#endif
}

bool all(std::uint32_t value, std::initializer_list<int> bits) {
    for (int bit : bits) {
        if ((value >> bit & 1u) == 0) return false;
    }
    return true;
}

// Levels as defined by the x86-64 psABI.
InstructionSet detect() {
    const CpuidRegisters basic = cpuid(1);
    if (!all(basic.ecx, {0, 9, 13, 19, 20, 23})) return InstructionSet::Generic; // SSE3 SSSE3 CX16 SSE4.1 SSE4.2 POPCNT
    const bool saved = all(basic.ecx, {27});                                     // OSXSAVE
    const std::uint64_t states = saved ? enabledStates() : 0;
    const CpuidRegisters extended = cpuid(7);
    const bool v3 = (states & 0x6) == 0x6 && all(basic.ecx, {12, 22, 28, 29}) // FMA MOVBE AVX F16C
                    && all(extended.ebx, {3, 5, 8});                          // BMI1 AVX2 BMI2
    if (!v3) return InstructionSet::X86_64_v2;
    const bool v4 = (states & 0xe6) == 0xe6 && all(extended.ebx, {16, 17, 28, 30, 31}); // AVX512 F DQ CD BW VL
    return v4 ? InstructionSet::X86_64_v4 : InstructionSet::X86_64_v3;
}

std::string detectName() {
    std::array<char, 49> text{};
    for (std::uint32_t i = 0; i < 3; ++i) {
        const CpuidRegisters r = cpuid(0x80000002u + i);
        std::memcpy(text.data() + 16 * i, &r, 16);
    }
    const std::string name = text.data();
    const std::size_t first = name.find_first_not_of(' ');
    return first == std::string::npos ? "x86-64 processor" : name.substr(first, name.find_last_not_of(' ') + 1 - first);
}

#else

InstructionSet detect() {
    return InstructionSet::Generic;
}

std::string detectName() {
#if defined(__aarch64__) || defined(_M_ARM64)
    return "arm64 processor";
#else
    return "processor";
#endif
}

#endif

} // namespace

InstructionSet bestInstructionSet() {
    static const InstructionSet best = detect();
    return best;
}

const char* name(InstructionSet set) {
    switch (set) {
        case InstructionSet::X86_64_v2:
            return "x86-64-v2";
        case InstructionSet::X86_64_v3:
            return "x86-64-v3";
        case InstructionSet::X86_64_v4:
            return "x86-64-v4";
        case InstructionSet::Generic:
            break;
    }
    return "generic";
}

void failWithoutKernels(InstructionSet set) {
    throw UsageError(std::string("this program was built without kernels for a processor of ") + name(set) +
                     "; build it here, or for all processors (cmake -DRT_KERNELS=all)");
}

const char* processorName() {
    static const std::string text = detectName();
    return text.c_str();
}

} // namespace rt
