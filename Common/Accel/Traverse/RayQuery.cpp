#include "Common/Accel/Traverse/RayQuery.h"

namespace rt::accel {

#if defined(__x86_64__) || defined(_M_X64)

extern const RayQuery kRayQuery_x86_64_v2;
extern const RayQuery kRayQuery_x86_64_v3;
extern const RayQuery kRayQuery_x86_64_v4;

const RayQuery* rayQuery(InstructionSet set) {
    switch (set) {
        case InstructionSet::X86_64_v4:
            return &kRayQuery_x86_64_v4;
        case InstructionSet::X86_64_v3:
            return &kRayQuery_x86_64_v3;
        case InstructionSet::X86_64_v2:
            return &kRayQuery_x86_64_v2;
        case InstructionSet::Generic:
            break;
    }
    return nullptr;
}

const RayQuery& rayQuery() {
    const RayQuery* best = rayQuery(bestInstructionSet());
    return best != nullptr ? *best : kRayQuery_x86_64_v2; // the least that this project runs on
}

#else

extern const RayQuery kRayQuery_generic;

const RayQuery* rayQuery(InstructionSet set) {
    return set == InstructionSet::Generic ? &kRayQuery_generic : nullptr;
}

const RayQuery& rayQuery() {
    return kRayQuery_generic;
}

#endif

} // namespace rt::accel
