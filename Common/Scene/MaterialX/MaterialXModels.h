// The surfaces of MaterialX that are read, by what they call the parameters of a principled material: the table that
// the reader follows. Names and values are those of version 1.39 (libraries/bxdf of MaterialX).
#pragma once
#include <span>
#include <string_view>

namespace rt::scene {

// An input of a node, and the value that it has where a document says nothing; of a colour of all components.
struct MaterialXInput {
    const char* name = nullptr; // null: the model has none
    double usual = 0;
};

struct MaterialXModel {
    const char* node;
    // Base colour, emission and sheen are products of a number and a colour.
    MaterialXInput base{}, baseColor{}, metallic{}, roughness{};
    MaterialXInput specular{}, specularColor{}, ior{};
    MaterialXInput transmission{}, transmissionColor{}, transmissionDepth{}; // by the depth it has become that colour
    MaterialXInput subsurface{}, subsurfaceColor{};
    MaterialXInput sheen{}, sheenColor{}, sheenRoughness{};
    MaterialXInput coat{}, coatColor{}, coatRoughness{};
    MaterialXInput emission{}, emissionColor{};
    MaterialXInput opacity{}, thin{}, normal{}, coatNormal{};
    MaterialXInput film{}, filmIor{}, filmThickness{}; // without a share of its own it is there where it is thick
    MaterialXInput dispersion{}, abbe{};               // with an Abbe number: times 20 over that
    MaterialXInput anisotropy{}, anisotropyRotation{};
    // Of glTF alone.
    MaterialXInput alphaMode{}, alphaCutoff{}, thickness{}, attenuationColor{}, attenuationDistance{};
    bool isSheenSquared = false; // its roughness is the square of ours
    double filmUnit = 1;         // of filmThickness, in nm
    // What no material here has: a notice says so where a document gives it another value.
    std::span<const MaterialXInput> leftOut{};
};

std::span<const MaterialXModel> materialXModels();
const MaterialXModel* materialXModel(std::string_view node); // null: there is none of that name
inline constexpr const char* kMaterialXModels = "open_pbr_surface, standard_surface, gltf_pbr";

} // namespace rt::scene
