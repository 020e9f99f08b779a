// Runs every shared formula for the tests, see FormulaProbe.h.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#define RT_PROJECTED
#include "FormulaProbe.h"

layout(local_size_x = 64) in;
layout(buffer_reference, scalar) buffer Results { uvec4 at[]; };
layout(push_constant, scalar) uniform Launch {
    Results results; // count for each formula
    uint count;
};

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < count) results.at[gl_WorkGroupID.y * count + i] = probe(gl_WorkGroupID.y, i);
}
