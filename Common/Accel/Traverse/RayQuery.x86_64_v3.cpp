#include "Common/Accel/Traverse/RayQueryKernel.h"

namespace rt::accel {

extern const RayQuery kRayQuery_x86_64_v3;
const RayQuery kRayQuery_x86_64_v3{tracer, closest, any};

} // namespace rt::accel
