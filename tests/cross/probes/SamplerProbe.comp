// Draws from the samplers of one family for the tests, see SamplerProbe.h.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "SamplerProbe.h"

Light loadLight(SceneRef scene, uint i) { return probeTableLight(i); }
LightBound loadLightBound(SceneRef scene, uint i) { return probeTableBound(i); }
LightCluster loadLightCluster(SceneRef scene, uint node, uint i) { // there is no tree
    LightCluster none;
    return none;
}
uint loadLightLeaf(SceneRef scene, uint light) { return kNone; }
SceneGlobals loadGlobals(SceneRef scene) {
    SceneGlobals none;
    return none;
}

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kFamily = 0u;
layout(buffer_reference, scalar) buffer Results { uvec4 at[]; };
layout(push_constant, scalar) uniform Launch {
    Results results; // count for each mode of each case
    uint count;
};

void main() {
    uint part = gl_WorkGroupID.y;
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    SceneRef scene;
    results.at[part * count + i] = probeSampler(scene, kFamily, part / kProbeModes, part % kProbeModes, i);
}
