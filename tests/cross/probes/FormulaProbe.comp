// Runs the shared formulas of one family for the tests, see FormulaProbe.h.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "FormulaProbe.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kFamily = 0u;
layout(buffer_reference, scalar) buffer Results { uvec4 at[]; };
layout(push_constant, scalar) uniform Launch {
    Results results; // count for each formula
    uint count;
};

void main() {
    uint formula = gl_WorkGroupID.y;
    uint i = gl_GlobalInvocationID.x;
    if (i < count && familyOf(formula) == kFamily) results.at[formula * count + i] = probe(kFamily, formula, i);
}
