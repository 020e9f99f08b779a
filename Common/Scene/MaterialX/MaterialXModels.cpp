#include "Common/Scene/MaterialX/MaterialXModels.h"

#include <array>

namespace rt::scene {

namespace {

// Indices of coats are 1.5 here; distributions of facets are stretched otherwise than glTF has it.
constexpr MaterialXInput kOpenPbrLeftOut[] = {{"base_diffuse_roughness", 0},
                                              {"specular_roughness_anisotropy", 0},
                                              {"transmission_scatter", 0},
                                              {"coat_roughness_anisotropy", 0},
                                              {"coat_ior", 1.6},
                                              {"coat_darkening", 1},
                                              {"geometry_tangent", 0},
                                              {"geometry_coat_tangent", 0}};
constexpr MaterialXInput kStandardLeftOut[] = {{"diffuse_roughness", 0},
                                               {"specular_anisotropy", 0},
                                               {"specular_rotation", 0},
                                               {"transmission_scatter", 0},
                                               {"transmission_extra_roughness", 0},
                                               {"coat_anisotropy", 0},
                                               {"coat_rotation", 0},
                                               {"coat_IOR", 1.5},
                                               {"coat_affect_color", 0},
                                               {"coat_affect_roughness", 0},
                                               {"tangent", 0}};
constexpr MaterialXInput kGltfLeftOut[] = {{"tangent", 0}};

// An input of ours, and what open_pbr_surface, standard_surface and gltf_pbr call it.
struct InputRow {
    MaterialXInput MaterialXModel::*input;
    MaterialXInput openPbr, standard, gltf;
};
constexpr InputRow kInputs[] = {
    {&MaterialXModel::base, {"base_weight", 1}, {"base", 1}, {}},
    {&MaterialXModel::baseColor, {"base_color", 0.8}, {"base_color", 0.8}, {"base_color", 1}},
    {&MaterialXModel::metallic, {"base_metalness", 0}, {"metalness", 0}, {"metallic", 1}},
    {&MaterialXModel::roughness, {"specular_roughness", 0.3}, {"specular_roughness", 0.2}, {"roughness", 1}},
    {&MaterialXModel::specular, {"specular_weight", 1}, {"specular", 1}, {"specular", 1}},
    {&MaterialXModel::specularColor, {"specular_color", 1}, {"specular_color", 1}, {"specular_color", 1}},
    {&MaterialXModel::ior, {"specular_ior", 1.5}, {"specular_IOR", 1.5}, {"ior", 1.5}},
    {&MaterialXModel::transmission, {"transmission_weight", 0}, {"transmission", 0}, {"transmission", 0}},
    {&MaterialXModel::transmissionColor, {"transmission_color", 1}, {"transmission_color", 1}, {}},
    {&MaterialXModel::transmissionDepth, {"transmission_depth", 0}, {"transmission_depth", 0}, {}},
    {&MaterialXModel::subsurface, {"subsurface_weight", 0}, {"subsurface", 0}, {}},
    {&MaterialXModel::subsurfaceColor, {"subsurface_color", 0.8}, {"subsurface_color", 1}, {}},
    {&MaterialXModel::sheen, {"fuzz_weight", 0}, {"sheen", 0}, {}},
    {&MaterialXModel::sheenColor, {"fuzz_color", 1}, {"sheen_color", 1}, {"sheen_color", 0}},
    {&MaterialXModel::sheenRoughness, {"fuzz_roughness", 0.5}, {"sheen_roughness", 0.3}, {"sheen_roughness", 0}},
    {&MaterialXModel::coat, {"coat_weight", 0}, {"coat", 0}, {"clearcoat", 0}},
    {&MaterialXModel::coatColor, {"coat_color", 1}, {"coat_color", 1}, {}},
    {&MaterialXModel::coatRoughness, {"coat_roughness", 0}, {"coat_roughness", 0.1}, {"clearcoat_roughness", 0}},
    {&MaterialXModel::emission, {"emission_luminance", 0}, {"emission", 0}, {"emissive_strength", 1}},
    {&MaterialXModel::emissionColor, {"emission_color", 1}, {"emission_color", 1}, {"emissive", 0}},
    {&MaterialXModel::opacity, {"geometry_opacity", 1}, {"opacity", 1}, {"alpha", 1}},
    {&MaterialXModel::thin, {"geometry_thin_walled", 0}, {"thin_walled", 0}, {}},
    {&MaterialXModel::normal, {"geometry_normal", 0}, {"normal", 0}, {"normal", 0}},
    {&MaterialXModel::coatNormal, {"geometry_coat_normal", 0}, {"coat_normal", 0}, {"clearcoat_normal", 0}},
    {&MaterialXModel::film, {"thin_film_weight", 0}, {}, {"iridescence", 0}},
    {&MaterialXModel::filmIor, {"thin_film_ior", 1.4}, {"thin_film_IOR", 1.5}, {"iridescence_ior", 1.3}},
    {&MaterialXModel::filmThickness,
     {"thin_film_thickness", 0.5},
     {"thin_film_thickness", 0},
     {"iridescence_thickness", 100}},
    {&MaterialXModel::dispersion, {"transmission_dispersion_scale", 0}, {}, {"dispersion", 0}},
    {&MaterialXModel::abbe, {"transmission_dispersion_abbe_number", 20}, {"transmission_dispersion", 0}, {}},
    {&MaterialXModel::anisotropy, {}, {}, {"anisotropy_strength", 0}},
    {&MaterialXModel::anisotropyRotation, {}, {}, {"anisotropy_rotation", 0}},
    {&MaterialXModel::alphaMode, {}, {}, {"alpha_mode", 0}},
    {&MaterialXModel::alphaCutoff, {}, {}, {"alpha_cutoff", 0.5}},
    {&MaterialXModel::thickness, {}, {}, {"thickness", 0}},
    {&MaterialXModel::attenuationColor, {}, {}, {"attenuation_color", 1}},
    {&MaterialXModel::attenuationDistance, {}, {}, {"attenuation_distance", 0}},
};

constexpr std::array<MaterialXModel, 3> makeModels() {
    MaterialXModel openPbr{"open_pbr_surface"}, standard{"standard_surface"}, gltf{"gltf_pbr"};
    for (const InputRow& row : kInputs) {
        openPbr.*row.input = row.openPbr;
        standard.*row.input = row.standard;
        gltf.*row.input = row.gltf;
    }
    openPbr.isSheenSquared = standard.isSheenSquared = true;
    openPbr.filmUnit = 1000;
    openPbr.leftOut = kOpenPbrLeftOut;
    standard.leftOut = kStandardLeftOut;
    gltf.leftOut = kGltfLeftOut;
    return {openPbr, standard, gltf};
}

constexpr std::array<MaterialXModel, 3> kModels = makeModels();

} // namespace

std::span<const MaterialXModel> materialXModels() {
    return kModels;
}

const MaterialXModel* materialXModel(std::string_view node) {
    for (const MaterialXModel& model : kModels)
        if (model.node == node) return &model;
    return nullptr;
}

} // namespace rt::scene
