// The feature mask: what a scene has and what the settings ask for. The scene compiler ORs the bits while it flattens, the
// settings add theirs; a bit that is absent means that the code, the buffers and the shader groups behind it are absent
// too. `features` is a plain first argument of shared functions: a template constant on the CPU, a specialization
// constant on the GPU. Its three words, see Shim.h: what the scene is made of, its materials, and methods.
//
// A row is a bit and its name for --features and the statistics; all else follows from the tables.
#ifndef RT_SHARED_FEATURES_H
#define RT_SHARED_FEATURES_H
#include "Common/Shared/Base/Shim.h"

// clang-format off
// The kinds of texture that are looked up at a point.
//   Noise  Perlin textures of every kind
#define RT_TEXTURE_FEATURES(FEATURE)  \
    FEATURE(Checker, 8u, "checker")   \
    FEATURE(Noise, 9u, "noise")       \
    FEATURE(Images, 10u, "images")

// What the scene is made of, with its textures.
//   MovingSpheres     then the time of a ray matters
//   VertexAttributes  tangents, colours, second texture coordinates
//   Emissive          some surface emits
//   Volumes           constant media
//   Sky               a background that is not black
//   Lights            the light table is not empty
//   ManyLights        more lights than kContributionLights
//   PunctualLights    point, spot and directional lights
#define RT_SCENE_FEATURES(FEATURE)                    \
    FEATURE(Spheres, 0u, "spheres")                   \
    FEATURE(MovingSpheres, 1u, "moving-spheres")      \
    FEATURE(Quads, 2u, "quads")                       \
    FEATURE(Triangles, 3u, "triangles")               \
    FEATURE(Instances, 4u, "instances")               \
    FEATURE(SmoothNormals, 5u, "smooth-normals")      \
    FEATURE(VertexAttributes, 6u, "vertex-attributes") \
    FEATURE(Emissive, 7u, "emissive")                 \
    RT_TEXTURE_FEATURES(FEATURE)                      \
    FEATURE(Volumes, 11u, "volumes")                  \
    FEATURE(Sky, 12u, "sky")                          \
    FEATURE(SkyImage, 13u, "sky-image")               \
    FEATURE(ThinLens, 14u, "thin-lens")               \
    FEATURE(Lights, 15u, "lights")                    \
    FEATURE(ManyLights, 16u, "many-lights")           \
    FEATURE(SphereLights, 17u, "sphere-lights")       \
    FEATURE(QuadLights, 18u, "quad-lights")           \
    FEATURE(TriangleLights, 19u, "triangle-lights")   \
    FEATURE(EllipsoidLights, 20u, "ellipsoid-lights") \
    FEATURE(PunctualLights, 21u, "punctual-lights")   \
    FEATURE(Disks, 23u, "disks")                      \
    FEATURE(Cylinders, 24u, "cylinders")              \
    FEATURE(DiskLights, 25u, "disk-lights")           \
    FEATURE(CylinderLights, 26u, "cylinder-lights")

// What only some materials of a kind have: bits from the upper end of a word whose bit k stands for materials of kind k,
// see their table, Common/Shared/Material/Materials.h.
//   Fuzz        metal with fuzz above kMirrorFuzz
//   CoatNormal  clear coats over or under a map of normals
//   Opacity     surfaces that let a part of rays through
//   Anisotropy  facets that are rougher along one direction of the surface
//   Iridescence thin films
//   DiffuseTransmission  surfaces that transmit light into all directions
//   Dispersion  glass that bends each colour channel its own way
#define RT_MATERIAL_FEATURES(FEATURE)          \
    FEATURE(Fuzz, 31u, "fuzz")                 \
    FEATURE(CoatNormal, 30u, "coat-normal")    \
    FEATURE(Opacity, 29u, "opacity")           \
    FEATURE(Anisotropy, 28u, "anisotropy")     \
    FEATURE(Iridescence, 27u, "iridescence")   \
    FEATURE(DiffuseTransmission, 26u, "diffuse-transmission") \
    FEATURE(Dispersion, 25u, "dispersion")

// Methods that settings ask for.
//   Mixture      Shirley's mixture, where there are lights or targets
//   Projected    lights by projected solid angle
//   Connections  lights connected to by way of smooth spheres
//   Reuse        pixels share what their paths bring
//   EdgeRays     several camera rays a sample where a light's edge crosses a pixel
//   Aiming       paths that are shared also scatter towards a sphere of glass
#define RT_METHODS(METHOD)                        \
    METHOD(Mixture, 0u, "mixture")                \
    METHOD(Projected, 1u, "projected")            \
    METHOD(Connections, 2u, "connections")        \
    METHOD(Reuse, 3u, "path-reuse")               \
    METHOD(EdgeRays, 4u, "edge-rays")             \
    METHOD(Aiming, 5u, "aimed-scattering")
// clang-format on

RT_SHARED_BEGIN

RT_CONST Features kFeatureNone = Features(0u, 0u, 0u);
RT_CONST Features kFeatureAll = Features(0xffffffffu, 0xffffffffu, 0xffffffffu);

#define RT_SCENE_FEATURE(Name, bit, name) RT_CONST Features kFeature##Name = Features(1u << bit, 0u, 0u);
#define RT_MATERIAL_FEATURE(Name, bit, name) RT_CONST Features kFeature##Name = Features(0u, 1u << bit, 0u);
#define RT_METHOD(Name, bit, name) RT_CONST Features kMethod##Name = Features(0u, 0u, 1u << bit);
RT_SCENE_FEATURES(RT_SCENE_FEATURE)
RT_MATERIAL_FEATURES(RT_MATERIAL_FEATURE)
RT_METHODS(RT_METHOD)
#undef RT_SCENE_FEATURE
#undef RT_MATERIAL_FEATURE
#undef RT_METHOD

#define RT_OR_FEATURE(Name, bit, name) | kFeature##Name
RT_CONST Features kTexturedFeatures = kFeatureNone RT_TEXTURE_FEATURES(RT_OR_FEATURE);
#undef RT_OR_FEATURE

// Of principled materials, what few have and no loop over samples knows.
RT_CONST Features kRareFeatures = kFeatureAnisotropy | kFeatureIridescence | kFeatureDiffuseTransmission;

RT_CONST Features kRoundFeatures = kFeatureDisks | kFeatureCylinders;

#ifndef RT_SPECIALIZED_FEATURES
RT_FN bool has(Features features, Features bits) {
    return (features & bits) != kFeatureNone;
}
#else
// In the shaders of renders `features` are specialization constants, and so is this: what it rules out is found without
// inlining functions (ShaderPruning.h).
#define has(features, bits) \
    (((kSceneFeatures & (bits).x) | (kMaterialFeatures & (bits).y) | (kMethods & (bits).z)) != 0u)
#endif

RT_SHARED_END

#endif
