// The table of light shapes, and the kinds of lights without one. From a row follow the constants kLight<Name> and
// kFeature<Name>Lights, the feature mask and its names, and what samples lights.
//
// SHAPE(Name, kind, feature bit, name of the feature, whether it is planar): its header, which Lights.h includes, defines
//     LightSample sample<Name>Light(features, params, light, position, normal, time, u)
//     float pdf<Name>Light(features, params, light, position, normal, time, wi, distance, lightNormal)
//     LightIntersection intersect<Name>Light(light, position, time, wi)
// as sampleLight, lightPdf and LightSample.h say, and LightTable.cpp
//     shared::LightBound bound<Name>(light)
// A planar shape has a front, by Light::normal, and may emit to that side only.
#ifndef RT_SHARED_LIGHT_SHAPES_H
#define RT_SHARED_LIGHT_SHAPES_H
#include "Common/Shared/Base/Shim.h"

// clang-format off
#define RT_LIGHT_SHAPES(SHAPE) \
    SHAPE(Sphere, 0u, 18u, "sphere-lights", false) \
    SHAPE(Quad, 1u, 19u, "quad-lights", true) \
    SHAPE(Triangle, 2u, 20u, "triangle-lights", true) \
    SHAPE(Ellipsoid, 4u, 27u, "ellipsoid-lights", false) /* the unit sphere under an affine map */
// clang-format on

RT_SHARED_BEGIN

#define RT_LIGHT_SHAPE(Name, kind_, bit, feature, isPlanar) \
    const uint kLight##Name = kind_;                        \
    const uint kFeature##Name##Lights = 1u << bit;
RT_LIGHT_SHAPES(RT_LIGHT_SHAPE)
#undef RT_LIGHT_SHAPE

const uint kLightSky = 3u; // the sky image
// Punctual lights, which no ray can hit: kinds from here on.
const uint kLightPoint = 5u;
const uint kLightSpot = 6u;
const uint kLightDirectional = 7u;

RT_SHARED_END

#endif
