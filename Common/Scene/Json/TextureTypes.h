// The table of textures as scene files have them: the reader, the writer and the tests of the schema follow from a row.
#pragma once
#include <string>
#include <variant>
#include <vector>

#include "Common/Scene/Builtin/Placeholders.h"
#include "Common/Scene/Json/SceneParameter.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// A row: the name and the help of a texture, and visit(parameter, pointer to member) in the order of scene files.
template <typename Texture>
struct TextureType;

template <>
struct TextureType<SolidTexture> {
    static constexpr const char* name = "solid";
    static constexpr const char* help = "One colour";
    template <typename Visit>
    static void forEachParameter(const Visit& visit) {
        visit(SceneParameter{"color", true}, &SolidTexture::color);
    }
};

template <>
struct TextureType<CheckerTexture> {
    static constexpr const char* name = "checker";
    static constexpr const char* help =
        "Cubes of two textures in world space; checkers of checkers may be nested 8 deep";
    template <typename Visit>
    static void forEachParameter(const Visit& visit) {
        visit(SceneParameter{"scale", true, "edge of a cube", kSmallest}, &CheckerTexture::scale);
        visit(SceneParameter{"even", true}, &CheckerTexture::even);
        visit(SceneParameter{"odd", true}, &CheckerTexture::odd);
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
        visit(SceneParameter{.name = "kind", .isRequired = true, .choices = noiseKindNames}, &NoiseTexture::kind);
        visit(SceneParameter{"scale", false, "multiplies the point", kSmallest}, &NoiseTexture::scale);
        visit(SceneParameter{"frequency", false, "marble: of the stripes along z"}, &NoiseTexture::frequency);
        visit(SceneParameter{"tint", false}, &NoiseTexture::tint);
        visit(SceneParameter{"seed", false, "", 0, 4294967295.0}, &NoiseTexture::seed);
    }
};

inline constexpr double kMaxImages = 1e6; // of one file

inline const std::vector<std::string>& wrapNames() {
    static const std::vector<std::string> names = {"clamp", "repeat", "mirror"};
    return names;
}
inline const std::vector<std::string>& colorSpaceNames() {
    static const std::vector<std::string> names = {"srgb", "linear"};
    return names;
}

template <>
struct TextureType<ImageTexture> {
    static constexpr const char* name = "image";
    static constexpr const char* help = "An image file";
    template <typename Visit>
    static void forEachParameter(const Visit& visit) {
        visit(SceneParameter{"file", true}, &ImageTexture::file);
        visit(
            SceneParameter{.name = "stand_in",
                           .isRequired = false,
                           .help = "what takes over when the file is missing: a generated map; or white, also when it "
                                   "cannot be read",
                           .choices = imageStandInNames},
            &ImageTexture::standIn);
        visit(SceneParameter{"tint", false}, &ImageTexture::tint);
        visit(SceneParameter{"image", false, "its number, where the file is one of glTF", 0, kMaxImages},
              &ImageTexture::image);
        visit(SceneParameter{.name = "color_space",
                             .isRequired = false,
                             .help = "of 8 and 16 bits; files of floats are linear",
                             .choices = colorSpaceNames},
              &ImageTexture::colorSpace);
        visit(SceneParameter{.name = "wrap_u", .isRequired = false, .choices = wrapNames}, &ImageTexture::wrapU);
        visit(SceneParameter{.name = "wrap_v", .isRequired = false, .choices = wrapNames}, &ImageTexture::wrapV);
        visit(SceneParameter{"uv_set", false, "0: uvs of a mesh, 1: uvs2", 0, 1}, &ImageTexture::uvSet);
        visit(SceneParameter{"uv_transform", false, "two rows of three: the place is rows . (u, v, 1)"},
              &ImageTexture::uvTransform);
    }
};

// Calls visit(a new texture) for every type of texture.
template <typename Visit>
void forEachTextureType(const Visit& visit) {
    const auto visitAll = [&]<typename... Textures>(const std::variant<Textures...>&) { (visit(Textures()), ...); };
    visitAll(TextureDesc());
}

} // namespace rt::scene
