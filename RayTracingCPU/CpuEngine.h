// The CPU renderer: tiles of the film, pulled by workers under a std::execution policy.
#pragma once
#include <cstdint>
#include <memory>

#include "Common/Accel/Traverse/RayQuery.h"
#include "Common/Core/CpuFeatures.h"
#include "Common/Render/Engine.h"

namespace rt::cpu {

enum class Policy { Seq, Par, ParUnseq };

struct CpuEngineOptions {
    Policy policy = Policy::Par;
    std::uint32_t threads = 0; // 0: as many as the machine has; 1 under Seq
    // Highest instruction set to use; lower ones are for tests and comparisons.
    InstructionSet instructionSet = accel::usableInstructionSet();
};

// The same image bit for bit for any policy and number of threads. Throws UsageError where the build has no
// kernels for the instruction set.
std::unique_ptr<app::Engine> makeCpuEngine(const CpuEngineOptions& options);

} // namespace rt::cpu
