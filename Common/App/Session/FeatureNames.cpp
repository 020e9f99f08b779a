#include "Common/App/Session/FeatureNames.h"

#include "Common/App/Options/OptionValues.h"
#include "Common/Shared/Material/Materials.h"

namespace rt::app {
namespace {

using namespace rt::shared;

// "textures" stands for three bits: present when any of them is.
constexpr Named<Features> kNames[] = {
#define RT_FEATURE(Name, bit, name) {name, kFeature##Name},
#define RT_METHOD(Name, bit, name) {name, kMethod##Name},
#define RT_SURFACE(Name, kind, name, help, scatters, parameters) {name, kFeature##Name},
#define RT_BLACK(Name, kind, name, help, parameters)
    {"textures", kTexturedFeatures},
    RT_SCENE_FEATURES(RT_FEATURE)      //
    RT_MATERIALS(RT_SURFACE, RT_BLACK) //
    RT_MATERIAL_FEATURES(RT_FEATURE)   //
    RT_METHODS(RT_METHOD)              //
#undef RT_FEATURE
#undef RT_METHOD
#undef RT_SURFACE
#undef RT_BLACK
};

constexpr bool areDistinct() {
    Features named;
    for (const Named<Features>& row : kNames) {
        if (row.value == kTexturedFeatures) continue;
        if ((named & row.value) != kFeatureNone) return false;
        named |= row.value;
    }
    return true;
}
static_assert(areDistinct(), "two features share a bit");

std::vector<std::string> namesWhere(Features features, bool present) {
    std::vector<std::string> names;
    for (const Named<Features>& row : kNames)
        if (has(features, row.value) == present) names.emplace_back(row.name);
    return names;
}

} // namespace

Features parseFeatures(const std::string& text) {
    if (text == "all") return kFeatureAll;
    Features features;
    for (const std::string& name : parseList("--features", text)) features |= parseChoice("--features", name, kNames);
    return features;
}

std::vector<std::string> featureNames(Features features) {
    return namesWhere(features, true);
}

std::vector<std::string> absentFeatureNames(Features features) {
    return namesWhere(features, false);
}

} // namespace rt::app
