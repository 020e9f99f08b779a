// The names of textures that an authored description mentions.
#pragma once
#include <string>
#include <type_traits>

#include "Common/Scene/Json/PrincipledType.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// Calls visit(name), which may change it where the source is not const.
template <typename Source, typename Visit>
void visitTextureName(Source& source, const Visit& visit) { // a ColorOrTexture
    if (auto* name = std::get_if<std::string>(&source)) visit(*name);
}

// Likewise for all that a material has, whether its kind uses them or not.
template <typename Material, typename Visit>
void forEachTextureName(Material& material, const Visit& visit) {
    visitTextureName(material.albedo, visit);
    if (!material.emissionTexture.empty()) visit(material.emissionTexture);
    forEachPrincipledParameter([&](const SceneParameter&, auto member) {
        auto& value = material.principled.*member;
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, ColorOrTexture>) {
            visitTextureName(value, visit);
        } else if constexpr (std::is_same_v<Value, NumberOrTexture>) {
            if (!value.texture.empty()) visit(value.texture);
        } else if constexpr (std::is_same_v<Value, std::string>) {
            if (!value.empty()) visit(value);
        }
    });
}

// Of textures that a texture is made of.
template <typename Texture, typename Visit>
void forEachInnerTexture(Texture& texture, const Visit& visit) { // a TextureDesc
    if (auto* checker = std::get_if<CheckerTexture>(&texture)) {
        visitTextureName(checker->even, visit);
        visitTextureName(checker->odd, visit);
    }
}

} // namespace rt::scene
