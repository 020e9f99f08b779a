#include "Common/Scene/MaterialTypes.h"

#include <algorithm>
#include <array>

namespace rt::scene {

namespace {

// ---- the words that rows are written in ----------------------------------------------------------------------------

constexpr bool kRequired = true;
constexpr bool kOptional = false;

constexpr MaterialParameter color(const char* name, bool isRequired, const char* help) {
    return {MaterialParameter::Type::Color, name, isRequired, 0, 1, 1, help};
}
constexpr MaterialParameter number(const char* name, bool isRequired, double minimum, double maximum, double usual,
                                   const char* help) {
    return {MaterialParameter::Type::Number, name, isRequired, minimum, maximum, usual, help};
}

template <typename... Parameters>
constexpr std::array<MaterialParameter, sizeof...(Parameters)> listOf(const Parameters&... parameters) {
    return {parameters...};
}

constexpr bool fitsRecord(std::span<const MaterialParameter> parameters) {
    const auto isColor = [](const MaterialParameter& p) { return p.type == MaterialParameter::Type::Color; };
    const auto colors = static_cast<std::size_t>(std::ranges::count_if(parameters, isColor));
    return colors <= 1 && parameters.size() - colors <= shared::kMaterialParameters;
}

// ---- the rows ------------------------------------------------------------------------------------------------------

#define RT_PARAMETERS(Name, parameters)                     \
    constexpr auto kParametersOf##Name = listOf parameters; \
    static_assert(fitsRecord(kParametersOf##Name), "shared::Material has no room for the parameters of " #Name);
#define RT_SURFACE(Name, kind, name, help, scatters, parameters) RT_PARAMETERS(Name, parameters)
#define RT_BLACK(Name, kind, name, help, parameters) RT_PARAMETERS(Name, parameters)
RT_MATERIALS(RT_SURFACE, RT_BLACK)
#undef RT_SURFACE
#undef RT_BLACK

#define RT_SURFACE(Name, kind, name, help, scatters, parameters) \
    {MaterialKind::Name, name, help, true, shared::kFeature##Name, kParametersOf##Name},
#define RT_BLACK(Name, kind, name, help, parameters) \
    {MaterialKind::Name, name, help, false, shared::kFeatureNone, kParametersOf##Name},
constexpr MaterialType kTypes[] = {RT_MATERIALS(RT_SURFACE, RT_BLACK)};

constexpr bool areDistinct() {
    for (const MaterialType& a : kTypes)
        for (const MaterialType& b : kTypes)
            if (&a != &b && (a.kind == b.kind || (a.feature & b.feature) != shared::kFeatureNone)) return false;
    return true;
}
static_assert(areDistinct(), "two materials share a kind or a feature bit");

} // namespace

std::span<const MaterialType> materialTypes() {
    return kTypes;
}

const MaterialType& materialType(MaterialKind kind) {
    return *std::ranges::find(kTypes, kind, &MaterialType::kind);
}

const MaterialParameter* colorOf(const MaterialType& type) {
    const auto found = std::ranges::find(type.parameters, MaterialParameter::Type::Color, &MaterialParameter::type);
    return found == type.parameters.end() ? nullptr : &*found;
}

} // namespace rt::scene
