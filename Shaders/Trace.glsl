// How compute shaders trace rays.
#ifdef RT_QUERY
#include "RayQuery.glsl"
#else
#include "Traverse.glsl"
#endif
