#include "Common/App/Session/FeatureNames.h"

#include "Common/App/Options/OptionValues.h"
#include "Common/Shared/Material/Materials.h"

namespace rt::app {
namespace {

using namespace rt::shared;

// "textures" stands for three bits: present when any of them is.
constexpr Named<std::uint32_t> kFeatures[] = {
    {"spheres", kFeatureSpheres},
    {"moving-spheres", kFeatureMovingSpheres},
    {"quads", kFeatureQuads},
    {"triangles", kFeatureTriangles},
    {"instances", kFeatureInstances},
    {"smooth-normals", kFeatureSmoothNormals},
#define RT_SURFACE(Name, kind, bit, name, help, parameters) {name, kFeature##Name},
#define RT_BLACK(Name, kind, name, help, parameters)
    RT_MATERIALS(RT_SURFACE, RT_BLACK)
#undef RT_SURFACE
#undef RT_BLACK
        {"fuzz", kFeatureFuzz},
    {"opacity", kFeatureOpacity},
    {"coat-normal", kFeatureCoatNormal},
    {"emissive", kFeatureEmissive},
    {"textures", kTexturedFeatures},
    {"checker", kFeatureChecker},
    {"noise", kFeatureNoise},
    {"images", kFeatureImages},
    {"volumes", kFeatureVolumes},
    {"sky", kFeatureSky},
    {"sky-image", kFeatureSkyImage},
    {"thin-lens", kFeatureThinLens},
    {"lights", kFeatureLights},
    {"many-lights", kFeatureManyLights},
    {"sphere-lights", kFeatureSphereLights},
    {"quad-lights", kFeatureQuadLights},
    {"triangle-lights", kFeatureTriangleLights},
    {"ellipsoid-lights", kFeatureEllipsoidLights},
    {"punctual-lights", kFeaturePunctualLights},
    {"mixture", kFeatureMixture},
    {"projected", kFeatureProjected},
    {"connections", kFeatureConnections},
    {"path-reuse", kFeatureReuse},
};

constexpr bool haveOneNameEach() {
    std::uint32_t named = 0;
    for (const auto& row : kFeatures) {
        if (row.value == kTexturedFeatures) continue;
        if ((named & row.value) != 0) return false;
        named |= row.value;
    }
    return named == kFeatureAll;
}
static_assert(haveOneNameEach(), "a feature lacks a name, or two share a bit");

std::vector<std::string> namesWhere(std::uint32_t features, bool present) {
    std::vector<std::string> names;
    for (const auto& row : kFeatures)
        if (has(features, row.value) == present) names.emplace_back(row.name);
    return names;
}

} // namespace

std::uint32_t parseFeatures(const std::string& text) {
    if (text == "all") return kFeatureAll;
    std::uint32_t features = 0;
    for (const std::string& name : parseList("--features", text))
        features |= parseChoice("--features", name, kFeatures);
    return features;
}

std::vector<std::string> featureNames(std::uint32_t features) {
    return namesWhere(features, true);
}

std::vector<std::string> absentFeatureNames(std::uint32_t features) {
    return namesWhere(features, false);
}

} // namespace rt::app
