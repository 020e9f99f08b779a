#include "Common/Accel/Traverse/RayQuery.h"

#include <string>

#include "Common/Core/Error.h"

namespace rt::accel {

extern const RayQuery kRayQuery_generic;
extern const RayQuery kRayQuery_x86_64_v2;
extern const RayQuery kRayQuery_x86_64_v3;
extern const RayQuery kRayQuery_x86_64_v4;

const RayQuery* rayQuery(InstructionSet set) {
    switch (set) {
#ifdef RT_KERNELS_x86_64_v4
        case InstructionSet::X86_64_v4:
            return &kRayQuery_x86_64_v4;
#endif
#ifdef RT_KERNELS_x86_64_v3
        case InstructionSet::X86_64_v3:
            return &kRayQuery_x86_64_v3;
#endif
#ifdef RT_KERNELS_x86_64_v2
        case InstructionSet::X86_64_v2:
            return &kRayQuery_x86_64_v2;
#endif
#ifdef RT_KERNELS_generic
        case InstructionSet::Generic:
            return &kRayQuery_generic;
#endif
        default:
            return nullptr;
    }
}

InstructionSet usableInstructionSet() {
    for (int set = static_cast<int>(bestInstructionSet()); set >= 0; --set)
        if (rayQuery(static_cast<InstructionSet>(set)) != nullptr) return static_cast<InstructionSet>(set);
    throw UsageError(std::string("this program has no kernels for a processor of ") + name(bestInstructionSet()));
}

const RayQuery& rayQuery() {
    static const RayQuery& best = *rayQuery(usableInstructionSet());
    return best;
}

} // namespace rt::accel
