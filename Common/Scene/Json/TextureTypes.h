// The table of textures as scene files have them: the reader, the writer and the tests of the schema follow from a row.
#pragma once
#include <string>
#include <variant>
#include <vector>

#include "Common/Scene/Builtin/StandIns.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// The type of the member says what else it may be: components of a colour lie in [0,1], a string is the name of a file.
struct TextureParameter {
    const char* name;
    bool isRequired; // else a new texture's value stands where a file says nothing
    const char* help = "";
    double least = -kLargest; // numbers
    double most = kLargest;
    const std::vector<std::string>& (*choices)() = nullptr; // strings; enumerations, in the order of their values
};

inline constexpr double kSmallest = 1 / kLargest;

// A row: the name and the help of a texture, and visit(parameter, pointer to member) in the order of scene files.
template <typename Texture>
struct TextureType;

template <>
struct TextureType<SolidTexture> {
    static constexpr const char* name = "solid";
    static constexpr const char* help = "One colour";
    template <typename Visit>
    static void forEachParameter(const Visit& visit) {
        visit(TextureParameter{"color", true}, &SolidTexture::color);
    }
};

template <>
struct TextureType<CheckerTexture> {
    static constexpr const char* name = "checker";
    static constexpr const char* help =
        "Cubes of two textures in world space; checkers of checkers may be nested 8 deep";
    template <typename Visit>
    static void forEachParameter(const Visit& visit) {
        visit(TextureParameter{"scale", true, "edge of a cube", kSmallest}, &CheckerTexture::scale);
        visit(TextureParameter{"even", true}, &CheckerTexture::even);
        visit(TextureParameter{"odd", true}, &CheckerTexture::odd);
    }
};

inline const std::vector<std::string>& noiseKindNames() {
    static const std::vector<std::string> names = {"marble", "turbulence", "smooth"};
    return names;
}

template <>
struct TextureType<NoiseTexture> {
    static constexpr const char* name = "noise";
    static constexpr const char* help = "Perlin noise in world space";
    template <typename Visit>
    static void forEachParameter(const Visit& visit) {
        visit(TextureParameter{.name = "kind", .isRequired = true, .choices = noiseKindNames}, &NoiseTexture::kind);
        visit(TextureParameter{"scale", false, "multiplies the point", kSmallest}, &NoiseTexture::scale);
        visit(TextureParameter{"frequency", false, "marble: of the stripes along z"}, &NoiseTexture::frequency);
        visit(TextureParameter{"tint", false}, &NoiseTexture::tint);
        visit(TextureParameter{"seed", false}, &NoiseTexture::seed);
    }
};

template <>
struct TextureType<ImageTexture> {
    static constexpr const char* name = "image";
    static constexpr const char* help = "An image file";
    template <typename Visit>
    static void forEachParameter(const Visit& visit) {
        visit(TextureParameter{"file", true}, &ImageTexture::file);
        visit(TextureParameter{.name = "stand_in",
                               .isRequired = false,
                               .help = "a generated map for when the file is missing",
                               .choices = planetMapNames},
              &ImageTexture::standIn);
        visit(TextureParameter{"tint", false}, &ImageTexture::tint);
    }
};

// Calls visit(a new texture) for every type of texture.
template <typename Visit>
void forEachTextureType(const Visit& visit) {
    const auto visitAll = [&]<typename... Textures>(const std::variant<Textures...>&) { (visit(Textures()), ...); };
    visitAll(TextureDesc());
}

} // namespace rt::scene
