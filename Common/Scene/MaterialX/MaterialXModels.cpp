#include "Common/Scene/MaterialX/MaterialXModels.h"

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

constexpr MaterialXModel kModels[] = {{.node = "open_pbr_surface",
                                       .base = {"base_weight", 1},
                                       .baseColor = {"base_color", 0.8},
                                       .metallic = {"base_metalness", 0},
                                       .roughness = {"specular_roughness", 0.3},
                                       .specular = {"specular_weight", 1},
                                       .specularColor = {"specular_color", 1},
                                       .ior = {"specular_ior", 1.5},
                                       .transmission = {"transmission_weight", 0},
                                       .transmissionColor = {"transmission_color", 1},
                                       .transmissionDepth = {"transmission_depth", 0},
                                       .subsurface = {"subsurface_weight", 0},
                                       .subsurfaceColor = {"subsurface_color", 0.8},
                                       .sheen = {"fuzz_weight", 0},
                                       .sheenColor = {"fuzz_color", 1},
                                       .sheenRoughness = {"fuzz_roughness", 0.5},
                                       .coat = {"coat_weight", 0},
                                       .coatColor = {"coat_color", 1},
                                       .coatRoughness = {"coat_roughness", 0},
                                       .emission = {"emission_luminance", 0},
                                       .emissionColor = {"emission_color", 1},
                                       .opacity = {"geometry_opacity", 1},
                                       .thin = {"geometry_thin_walled", 0},
                                       .normal = {"geometry_normal", 0},
                                       .coatNormal = {"geometry_coat_normal", 0},
                                       .film = {"thin_film_weight", 0},
                                       .filmIor = {"thin_film_ior", 1.4},
                                       .filmThickness = {"thin_film_thickness", 0.5},
                                       .dispersion = {"transmission_dispersion_scale", 0},
                                       .abbe = {"transmission_dispersion_abbe_number", 20},
                                       .isSheenSquared = true,
                                       .filmUnit = 1000,
                                       .leftOut = kOpenPbrLeftOut},
                                      {.node = "standard_surface",
                                       .base = {"base", 1},
                                       .baseColor = {"base_color", 0.8},
                                       .metallic = {"metalness", 0},
                                       .roughness = {"specular_roughness", 0.2},
                                       .specular = {"specular", 1},
                                       .specularColor = {"specular_color", 1},
                                       .ior = {"specular_IOR", 1.5},
                                       .transmission = {"transmission", 0},
                                       .transmissionColor = {"transmission_color", 1},
                                       .transmissionDepth = {"transmission_depth", 0},
                                       .subsurface = {"subsurface", 0},
                                       .subsurfaceColor = {"subsurface_color", 1},
                                       .sheen = {"sheen", 0},
                                       .sheenColor = {"sheen_color", 1},
                                       .sheenRoughness = {"sheen_roughness", 0.3},
                                       .coat = {"coat", 0},
                                       .coatColor = {"coat_color", 1},
                                       .coatRoughness = {"coat_roughness", 0.1},
                                       .emission = {"emission", 0},
                                       .emissionColor = {"emission_color", 1},
                                       .opacity = {"opacity", 1},
                                       .thin = {"thin_walled", 0},
                                       .normal = {"normal", 0},
                                       .coatNormal = {"coat_normal", 0},
                                       .filmIor = {"thin_film_IOR", 1.5},
                                       .filmThickness = {"thin_film_thickness", 0},
                                       .abbe = {"transmission_dispersion", 0},
                                       .isSheenSquared = true,
                                       .leftOut = kStandardLeftOut},
                                      {.node = "gltf_pbr",
                                       .baseColor = {"base_color", 1},
                                       .metallic = {"metallic", 1},
                                       .roughness = {"roughness", 1},
                                       .specular = {"specular", 1},
                                       .specularColor = {"specular_color", 1},
                                       .ior = {"ior", 1.5},
                                       .transmission = {"transmission", 0},
                                       .sheenColor = {"sheen_color", 0},
                                       .sheenRoughness = {"sheen_roughness", 0},
                                       .coat = {"clearcoat", 0},
                                       .coatRoughness = {"clearcoat_roughness", 0},
                                       .emission = {"emissive_strength", 1},
                                       .emissionColor = {"emissive", 0},
                                       .opacity = {"alpha", 1},
                                       .normal = {"normal", 0},
                                       .coatNormal = {"clearcoat_normal", 0},
                                       .film = {"iridescence", 0},
                                       .filmIor = {"iridescence_ior", 1.3},
                                       .filmThickness = {"iridescence_thickness", 100},
                                       .dispersion = {"dispersion", 0},
                                       .anisotropy = {"anisotropy_strength", 0},
                                       .anisotropyRotation = {"anisotropy_rotation", 0},
                                       .alphaMode = {"alpha_mode", 0},
                                       .alphaCutoff = {"alpha_cutoff", 0.5},
                                       .thickness = {"thickness", 0},
                                       .attenuationColor = {"attenuation_color", 1},
                                       .attenuationDistance = {"attenuation_distance", 0},
                                       .leftOut = kGltfLeftOut}};

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
