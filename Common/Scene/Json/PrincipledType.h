// The principled material as scene files have it, beside what every material has and its base colour.
#pragma once
#include "Common/Scene/Json/SceneParameter.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// Calls visit(parameter, pointer to member of PrincipledDesc) in the order of scene files.
template <typename Visit>
void forEachPrincipledParameter(const Visit& visit) {
    using D = PrincipledDesc;
    visit(SceneParameter{"metallic", false, "0: dielectric, 1: metal of the base colour"}, &D::metallic);
    visit(SceneParameter{"roughness", false, "its square is the width of the GGX distribution; 0: smooth"},
          &D::roughness);
    visit(SceneParameter{"anisotropy", false, "widens the distribution along the tangent: 1 as far as roughness 1"},
          &D::anisotropy);
    visit(SceneParameter{"anisotropy_rotation", false, "of that direction, counter-clockwise, in radians"},
          &D::anisotropyRotation);
    visit(SceneParameter{.name = "anisotropy_texture",
                         .isRequired = false,
                         .help = "a name from textures: that direction between tangent and bitangent, 2 rg - 1",
                         .section = "textures"},
          &D::anisotropyTexture);
    visit(SceneParameter{"ior", false, "index of refraction, inside over outside", 1, kLargestIor}, &D::ior);
    visit(SceneParameter{"specular", false, "scales the reflection of the dielectric"}, &D::specular);
    visit(SceneParameter{"specular_color", false, "tints it at normal incidence"}, &D::specularColor);
    visit(SceneParameter{"iridescence", false, "share of the surface under a thin film"}, &D::iridescence);
    visit(SceneParameter{"iridescence_ior", false, "index of refraction of the film", 1, kLargestFilmIor},
          &D::iridescenceIor);
    visit(SceneParameter{"iridescence_thickness", false, "of the film, between the next two"},
          &D::iridescenceThickness);
    visit(SceneParameter{"iridescence_thickness_minimum", false, "in nm", 0}, &D::iridescenceThicknessMinimum);
    visit(SceneParameter{"iridescence_thickness_maximum", false, "in nm", 0}, &D::iridescenceThicknessMaximum);
    visit(SceneParameter{"transmission", false, "share of the dielectric that lets light through"}, &D::transmission);
    visit(SceneParameter{"dispersion", false, "of glass: 20 over its Abbe number; 0: none", 0}, &D::dispersion);
    visit(SceneParameter{"thin_walled", false, "transmits without bending"}, &D::isThin);
    visit(SceneParameter{"attenuation_color", false, "what is left of white after attenuation_distance inside"},
          &D::attenuationColor);
    visit(SceneParameter{"attenuation_distance", false, "missing: nothing is absorbed inside", kSmallest},
          &D::attenuationDistance);
    visit(SceneParameter{"diffuse_transmission", false, "share of the diffuse base that transmits instead"},
          &D::diffuseTransmission);
    visit(SceneParameter{"diffuse_transmission_color", false, "of what that lets through"},
          &D::diffuseTransmissionColor);
    visit(SceneParameter{"clearcoat", false, "share of the surface under a clear coat"}, &D::clearcoat);
    visit(SceneParameter{"clearcoat_roughness", false}, &D::clearcoatRoughness);
    visit(SceneParameter{.name = "clearcoat_normal_texture",
                         .isRequired = false,
                         .help = "a name from textures: normals of the clear coat alone, which else is smooth",
                         .section = "textures"},
          &D::clearcoatNormalTexture);
    visit(SceneParameter{"clearcoat_normal_scale", false, "of their x and y"}, &D::clearcoatNormalScale);
    visit(SceneParameter{"sheen_color", false, "of the fibres of cloth"}, &D::sheenColor);
    visit(SceneParameter{"sheen_roughness", false}, &D::sheenRoughness);
    visit(SceneParameter{.name = "normal_texture",
                         .isRequired = false,
                         .help = "a name from textures: tangent-space normals, 2 rgb - 1",
                         .section = "textures"},
          &D::normalTexture);
    visit(SceneParameter{"normal_scale", false, "of their x and y"}, &D::normalScale);
    visit(SceneParameter{"opacity", false, "share of rays that meet the surface"}, &D::opacity);
    visit(SceneParameter{"alpha_cutoff", false, "opacity below it is 0, else 1", 0}, &D::alphaCutoff);
    visit(SceneParameter{"emission_vertex_colors", false, "vertex colours multiply emission, too"}, &D::emitsColors);
}

inline const std::vector<std::string>& channelNames() {
    static const std::vector<std::string> names = {"red", "green", "blue", "alpha"};
    return names;
}

} // namespace rt::scene
