#pragma once

namespace rt {

// Instruction sets that hot kernels are compiled for, in rising order.
enum class InstructionSet { Generic, X86_64_v2, X86_64_v3, X86_64_v4 };

// The highest one that this processor and operating system run.
InstructionSet bestInstructionSet();

const char* name(InstructionSet set); // "x86-64-v3"

// Throws the UsageError that says so.
[[noreturn]] void failWithoutKernels(InstructionSet set);

// The processor's marketing name, or its architecture where that is unknown.
const char* processorName();

} // namespace rt
