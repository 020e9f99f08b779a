// What every shader of a render is bound to. One specialisation constant for each decision that is the same for all paths, so
// that nothing is compiled that a render does not need.
#ifndef RT_SHADERS_BINDINGS_GLSL
#define RT_SHADERS_BINDINGS_GLSL
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require

#include "Records.h"
#include "Common/Shared/Base/Features.h"

layout(constant_id = 0) const uint kFeatures = kFeatureAll;
layout(constant_id = 1) const uint kLightSampling = kSampleMis;
layout(constant_id = 2) const uint kLightSelection = kSelectContribution;
layout(constant_id = 3) const uint kSphereLight = kShapeAuto;
layout(constant_id = 4) const uint kQuadLight = kShapeAuto;
layout(constant_id = 5) const uint kTriangleLight = kShapeAuto;
layout(constant_id = 6) const uint kSamplerKind = kSamplerSobol;
layout(constant_id = 7) const uint kRussianRoulette = 1u;

layout(set = 0, binding = 1, scalar) uniform Constants { RenderConstants constants; };

// The settings, those that are specialisation constants as such.
RenderParams renderParams() {
    RenderParams params = constants.params;
    params.lightSampling = kLightSampling;
    params.lightSelection = kLightSelection;
    params.sphereLight = kSphereLight;
    params.quadLight = kQuadLight;
    params.triangleLight = kTriangleLight;
    params.samplerKind = kSamplerKind;
    params.russianRoulette = kRussianRoulette;
    return params;
}

#endif
