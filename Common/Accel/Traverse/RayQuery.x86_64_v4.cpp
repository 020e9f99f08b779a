#include "Common/Accel/Traverse/RayQueryKernel.h"

namespace rt::accel {

extern const RayQuery kRayQuery_x86_64_v4;
const RayQuery kRayQuery_x86_64_v4{tracer, closest, any};

} // namespace rt::accel
