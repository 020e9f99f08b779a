// The traversal in plain C++, which x86 builds otherwise lack, and the list of all that this processor runs.
#define RT_SIMD_GENERIC
#include "Common/Accel/Traverse/RayQueryKernel.h"
#include "tests/unit/AccelScene.h"

namespace rt::accel::testing {

std::vector<NamedQuery> runnableQueries() {
    static const RayQuery generic{tracer, closest, any};
    std::vector<NamedQuery> queries{{"generic", &generic}};
    for (InstructionSet set : {InstructionSet::X86_64_v2, InstructionSet::X86_64_v3, InstructionSet::X86_64_v4}) {
        const RayQuery* query = set <= bestInstructionSet() ? rayQuery(set) : nullptr;
        if (query != nullptr) queries.push_back({rt::name(set), query});
    }
    return queries;
}

} // namespace rt::accel::testing
