#include "Common/Accel/Traverse/RayQueryKernel.h"

namespace rt::accel {

extern const RayQuery kRayQuery_generic;
const RayQuery kRayQuery_generic{tracer, closest, any};

} // namespace rt::accel
