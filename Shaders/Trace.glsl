// How shaders that begin rays trace them, and which invocation they are: ray generation shaders of the pipeline, or
// compute shaders by ray queries or through our own tree.
#ifdef RT_PIPELINE
#include "PipelineTrace.glsl"

uint invocationNumber() {
    return gl_LaunchIDEXT.x;
}
#else
#ifdef RT_QUERY
#include "RayQuery.glsl"
#else
#include "Traverse.glsl"
#endif

layout(local_size_x_id = kGroupSizeId) in;

uint invocationNumber() {
    return gl_GlobalInvocationID.x;
}
#endif
