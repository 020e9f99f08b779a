// The ids of the shaders' specialization constants, valid as C++20 and as GLSL.
#ifndef RT_SHADERS_SPECIALIZATION_IDS_H
#define RT_SHADERS_SPECIALIZATION_IDS_H
#include "Common/Shared/Base/Shim.h"

RT_SHARED_BEGIN

// Of every shader of a render, see Bindings.glsl.
const uint kSceneFeaturesId = 0u; // the three words of Features
const uint kMaterialFeaturesId = 23u;
const uint kMethodsId = 24u;
const uint kLightSamplingId = 1u;
const uint kLightSelectionId = 2u;
const uint kSphereLightId = 3u;
const uint kQuadLightId = 4u;
const uint kTriangleLightId = 5u;
const uint kSamplerKindId = 6u;
const uint kRussianRouletteId = 7u;
const uint kMethodsInUseId = 22u; // RenderParams::methods
const uint kLightCountId = 8u;
// Of compute shaders that trace rays, see Traverse.glsl.
const uint kGroupSizeId = 9u;
const uint kTreeDepthId = 10u;
const uint kIsLinearId = 11u;
const uint kListedNearSpheresId = 20u;
const uint kListedSpheresId = 12u;
const uint kListedXQuadsId = 13u;
const uint kListedYQuadsId = 14u;
const uint kListedZQuadsId = 15u;
const uint kListedQuadsId = 16u;
const uint kListedTrianglesId = 17u;
const uint kListedRoundsId = 25u;
const uint kTreeIsWideId = 19u;
const uint kListedCuboidsId = 21u;
// Of the preview, see Preview.glsl.
const uint kShapeId = 18u;

RT_SHARED_END

#endif
