#include "Common/Accel/RayQueryKernel.h"

namespace rt::accel {

extern const RayQuery kRayQuery_generic;
const RayQuery kRayQuery_generic{closest, any};

}  // namespace rt::accel
