// The table of materials, Common/Shared/Material/Materials.h, as C++ reads it: names, parameters and what they may be.
#pragma once
#include <span>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

struct MaterialParameter {
    enum class Type { Color, Number };
    Type type; // Color: a constant or a texture, components in [0,1]
    const char* name;
    bool isRequired; // in scene files
    double minimum;  // numbers: the range, and the value where nothing is said
    double maximum;
    double usual;
    const char* help; // may be empty
};

struct MaterialType {
    MaterialKind kind;
    const char* name; // in scene files
    const char* help;
    bool scatters;
    shared::Features feature; // none: it does not scatter
    std::span<const MaterialParameter> parameters;
};

std::span<const MaterialType> materialTypes();
const MaterialType& materialType(MaterialKind kind);

// Calls visit(parameter, index in MaterialDesc::parameters) for the numbers of a kind.
template <typename Visit>
void forEachNumber(const MaterialType& type, const Visit& visit) {
    std::size_t index = 0;
    for (const MaterialParameter& parameter : type.parameters)
        if (parameter.type == MaterialParameter::Type::Number) visit(parameter, index++);
}

// The colour of a kind; null: it has none.
const MaterialParameter* colorOf(const MaterialType& type);

} // namespace rt::scene
