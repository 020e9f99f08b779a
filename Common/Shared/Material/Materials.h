// The table of materials. Everything else follows from a row: scene files and their schema, the compiled scene, feature
// bits and their names, what kernels and shaders sample, and the tests that hold for every material.
//
// SURFACE(Name, kind, name in scene files, what it is, how it scatters, (parameters)) scatters. Its header defines
//     bool isDelta<Name>(features, m)                                       whether every lobe of m is a delta
//     BsdfSample sample<Name>(features, m, n, frontFace, wo, u, uLobe)
//     vec4 eval<Name>(features, m, n, wo, wi)                               as evalBsdf; not called where isDelta<Name>
// and BLACK(Name, kind, name, what it is, (parameters)) only emits; any material may emit as well as scatter.
//
// How it scatters is what techniques and the preview go by, which know no material by its name:
//     kScattersEvenly     the same radiance into all directions, albedo / pi: pixels may share paths there, too
//     kScattersDiffusely  into all directions: lights are also connected to from there by way of smooth spheres
//     kScattersInLayers   likewise by one lobe, about the mirrored direction by others, where the preview shows the sky
//     kScattersGlossily   about the mirrored or the refracted direction only: connections would meet it by chance
//
// Parameters, see Common/Scene/MaterialTypes.h: at most one color(name, need, help), a constant or a texture, which is
// Bsdf::albedo; and at most kMaterialParameters of number(name, need, least, most, usual value, help), which are
// Bsdf::parameter in this order. What a principled material has beyond its base colour is in PrincipledParameters.h.
#ifndef RT_SHARED_MATERIALS_H
#define RT_SHARED_MATERIALS_H
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Material/Dielectric.h"
#include "Common/Shared/Material/Lambertian.h"
#include "Common/Shared/Material/Metal.h"
#include "Common/Shared/Material/Principled.h"

// clang-format off
#define RT_MATERIALS(SURFACE, BLACK) \
    SURFACE(Lambertian, 0u, "lambertian", "Diffuse", kScattersEvenly, (color("albedo", kRequired, ""))) \
    SURFACE(Metal, 1u, "metal", "A mirror, blurred by fuzz", kScattersGlossily, \
            (color("albedo", kRequired, ""), number("fuzz", kOptional, 0, 1, 0, ""))) \
    SURFACE(Dielectric, 2u, "dielectric", "Clear: albedo tints, ior is the index inside over that outside", \
            kScattersGlossily, \
            (color("albedo", kOptional, ""), number("ior", kRequired, 1e-9, 1e9, 1.5, ""))) \
    SURFACE(Principled, 4u, "principled", "Layers of glTF 2.0: metal, dielectric over diffuse, glass, clearcoat, sheen", \
            kScattersInLayers, (color("base_color", kOptional, ""))) \
    BLACK(Emitter, 3u, "emitter", "Emits and absorbs", ())
// clang-format on

RT_SHARED_BEGIN

const uint kScattersEvenly = 0u;
const uint kScattersDiffusely = 1u;
const uint kScattersInLayers = 2u;
const uint kScattersGlossily = 3u;

#define RT_SURFACE(Name, kind_, name, help, scatters, parameters) \
    const uint kMaterial##Name = kind_;                           \
    RT_CONST Features kFeature##Name = Features(0u, 1u << kind_, 0u);
#define RT_BLACK(Name, kind_, name, help, parameters) const uint kMaterial##Name = kind_;
RT_MATERIALS(RT_SURFACE, RT_BLACK)
#undef RT_SURFACE
#undef RT_BLACK

// The features of all materials that scatter, and of those that scatter evenly.
#define RT_OR_FEATURE(Name, kind_, name, help, scatters, parameters) | kFeature##Name
#define RT_OR_EVEN(Name, kind_, name, help, scatters, parameters) \
    | (scatters == kScattersEvenly ? kFeature##Name : kFeatureNone)
#define RT_NOTHING(Name, kind_, name, help, parameters)
RT_CONST Features kSurfaceFeatures = kFeatureNone RT_MATERIALS(RT_OR_FEATURE, RT_NOTHING);
RT_CONST Features kEvenSurfaceFeatures = kFeatureNone RT_MATERIALS(RT_OR_EVEN, RT_NOTHING);
#undef RT_OR_FEATURE
#undef RT_OR_EVEN
#undef RT_NOTHING

RT_SHARED_END

#endif
