// The feature mask: what a scene and its settings need. The scene compiler ORs the bits while it flattens; a bit that
// is absent means that the code, the buffers and the shader groups behind it are absent too. `features` is a plain
// first argument of shared functions: a template constant on the CPU, a specialization constant on the GPU.
#ifndef RT_SHARED_FEATURES_H
#define RT_SHARED_FEATURES_H
#include "Common/Shared/Base/Shim.h"

RT_SHARED_BEGIN

const uint kFeatureSpheres = 1u << 0u;
const uint kFeatureMovingSpheres = 1u << 1u; // then the time of a ray matters
const uint kFeatureQuads = 1u << 2u;
const uint kFeatureTriangles = 1u << 3u;
const uint kFeatureInstances = 1u << 4u;
// Bits of materials: see their table, Common/Shared/Material/Materials.h. 5, 6, 7 and 28 are taken.
const uint kFeatureEmissive = 1u << 8u; // some surface emits
const uint kFeatureChecker = 1u << 9u;
const uint kFeatureNoise = 1u << 10u;   // Perlin textures of every kind
const uint kFeatureImages = 1u << 11u;  // image textures
const uint kFeatureVolumes = 1u << 12u; // constant media
const uint kFeatureSky = 1u << 13u;     // a background that is not black
const uint kFeatureSkyImage = 1u << 14u;
const uint kFeatureThinLens = 1u << 15u;
const uint kFeatureLights = 1u << 16u;     // the light table is not empty
const uint kFeatureManyLights = 1u << 17u; // more lights than kContributionLights
const uint kFeatureSphereLights = 1u << 18u;
const uint kFeatureQuadLights = 1u << 19u;
const uint kFeatureTriangleLights = 1u << 20u;
const uint kFeatureSmoothNormals = 1u << 21u;
const uint kFeatureFuzz = 1u << 22u;        // metal with fuzz above kMirrorFuzz
const uint kFeatureReuse = 1u << 23u;       // a setting: pixels share what their paths bring
const uint kFeatureConnections = 1u << 24u; // a setting: lights connected to by way of smooth spheres
const uint kFeatureMixture = 1u << 25u;     // a setting: Shirley's mixture, where there are lights or targets
const uint kFeatureProjected = 1u << 26u;   // a setting: lights by projected solid angle
const uint kFeatureEllipsoidLights = 1u << 27u;
const uint kFeatureDetail = 1u << 28u;         // tangents, vertex colours, second uvs: the bit of principled materials
const uint kFeatureCoatNormal = 1u << 29u;     // clear coats over or under a map of normals
const uint kFeaturePunctualLights = 1u << 30u; // point, spot and directional lights
const uint kFeatureOpacity = 1u << 31u;        // principled surfaces that let a part of rays through
const uint kFeatureAll = 0xffffffffu;
const uint kTexturedFeatures = kFeatureChecker | kFeatureNoise | kFeatureImages;

RT_FN bool has(uint features, uint bits) {
    return (features & bits) != 0u;
}

RT_SHARED_END

#endif
