// What every shader of a render is bound to, and its specialization constants: what is the same for all paths, so that
// nothing is compiled that a render does not need.
#ifndef RT_SHADERS_BINDINGS_GLSL
#define RT_SHADERS_BINDINGS_GLSL
#define RT_SPECIALIZED_FEATURES // of Features.h and Methods.h
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require

#include "Records.h"
#include "SpecializationIds.h"
#include "Common/Shared/Base/Features.h"

layout(constant_id = kSceneFeaturesId) const uint kSceneFeatures = 0xffffffffu;
layout(constant_id = kMaterialFeaturesId) const uint kMaterialFeatures = 0xffffffffu;
layout(constant_id = kMethodsId) const uint kMethods = 0xffffffffu;
const Features kFeatures = Features(kSceneFeatures, kMaterialFeatures, kMethods);
layout(constant_id = kLightSamplingId) const uint kLightSampling = kSampleMis;
layout(constant_id = kLightSelectionId) const uint kLightSelection = kSelectContribution;
layout(constant_id = kSphereLightId) const uint kSphereLight = kShapeAuto;
layout(constant_id = kQuadLightId) const uint kQuadLight = kShapeAuto;
layout(constant_id = kTriangleLightId) const uint kTriangleLight = kShapeAuto;
layout(constant_id = kSamplerKindId) const uint kSamplerKind = kSamplerSobol;
layout(constant_id = kRussianRouletteId) const uint kRussianRoulette = 1u;
layout(constant_id = kMethodsInUseId) const uint kMethodsInUse = 0u;
layout(constant_id = kLightCountId) const uint kLightCount = 0u; // 0: as the scene says

layout(set = 0, binding = 1, scalar) uniform Constants { RenderConstants constants; };

// The settings, those that are specialization constants as such.
RenderParams renderParams() {
    RenderParams params = constants.params;
    params.lightSampling = kLightSampling;
    params.lightSelection = kLightSelection;
    params.sphereLight = kSphereLight;
    params.quadLight = kQuadLight;
    params.triangleLight = kTriangleLight;
    params.samplerKind = kSamplerKind;
    params.russianRoulette = kRussianRoulette;
    params.methods = kMethodsInUse;
    return params;
}

#endif
