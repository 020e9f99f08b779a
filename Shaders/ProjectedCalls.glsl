// What the ray generation shader exchanges with the callable shaders of lights by projected solid angle.
#include "Common/Shared/Light/Projected/ProjectedQuery.h"

struct FanCall {
    FanQuery query;
    FanSample result;
};

struct CapCall {
    CapQuery query;
    CapSample result;
};
