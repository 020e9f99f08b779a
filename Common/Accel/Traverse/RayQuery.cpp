#include "Common/Accel/Traverse/RayQuery.h"

#include "Common/Core/KernelSets.h"

namespace rt::accel {

extern const RayQuery kRayQuery_generic;
extern const RayQuery kRayQuery_x86_64_v2;
extern const RayQuery kRayQuery_x86_64_v3;
extern const RayQuery kRayQuery_x86_64_v4;

const RayQuery* rayQuery(InstructionSet set) {
#define RT_CASE(set, suffix)  \
    case InstructionSet::set: \
        return &kRayQuery_##suffix;
    switch (set) {
        RT_KERNEL_SETS(RT_CASE)
        default:
            return nullptr;
    }
#undef RT_CASE
}

InstructionSet usableInstructionSet() {
    for (int set = static_cast<int>(bestInstructionSet()); set >= 0; --set)
        if (rayQuery(static_cast<InstructionSet>(set)) != nullptr) return static_cast<InstructionSet>(set);
    failWithoutKernels(bestInstructionSet());
}

const RayQuery& rayQuery() {
    static const RayQuery& best = *rayQuery(usableInstructionSet());
    return best;
}

} // namespace rt::accel
