// Textures of pbrt files as those of a scene.
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <variant>

#include <glm/vec3.hpp>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Pbrt/PbrtFiles.h"
#include "Common/Scene/Pbrt/PbrtNotices.h"
#include "Common/Scene/Pbrt/PbrtParameters.h"
#include "Common/Scene/SceneDesc.h"
#include "Common/Scene/UniqueNames.h"

namespace rt::scene {

// What a texture, or a parameter that may have one, comes to.
struct PbrtTexture {
    std::variant<glm::dvec3, TextureDesc> value;
    bool isInverted = false; // of numbers: 1 minus it
    bool isConstant() const { return std::holds_alternative<glm::dvec3>(value); }
};

enum class PbrtUse { Reflectance, Number }; // what a value is for

class PbrtTextures {
  public:
    // All must outlive this.
    PbrtTextures(SceneDesc& scene, PbrtFiles& files, PbrtNotices& notices)
        : scene_(scene), files_(files), notices_(notices) {}

    // A Texture directive of this name; `isColor`: of spectra, else of numbers. `toWorld`: where it is defined.
    void define(const std::string& name, bool isColor, const std::string& kind, const PbrtParameters& parameters,
                const Affine& toWorld);

    // A parameter that may be a constant or a texture; unset: `usual`.
    PbrtTexture value(const PbrtParameters& parameters, std::string_view name, PbrtUse use, const glm::dvec3& usual);
    // The constant colour of one; of textures what is most like it.
    glm::dvec3 constant(const PbrtParameter& parameter, PbrtUse use);

    ColorOrTexture color(const PbrtTexture& texture, const PbrtPlace& place);   // within [0,1]
    NumberOrTexture number(const PbrtTexture& texture, const PbrtPlace& place); // likewise
    // A number that has no texture here: of textures `instead`, with a notice.
    double plainNumber(const PbrtParameters& parameters, std::string_view name, double usual, double instead);
    // Name of an image as a texture; `file` as the scene file has it.
    std::string image(const std::string& file, ColorSpace space, const PbrtPlace& place);

  private:
    PbrtTexture imageMap(bool isColor, const PbrtParameters& parameters);
    PbrtTexture checkerboard(const PbrtParameters& parameters, PbrtUse use, const Affine& toWorld);
    PbrtTexture scaled(const PbrtParameters& parameters, PbrtUse use);
    PbrtTexture mixed(const PbrtParameters& parameters, PbrtUse use);
    PbrtTexture standIn(const std::string& kind, const PbrtParameters& parameters, PbrtUse use);
    bool multiply(TextureDesc& texture, const glm::dvec3& factor) const; // false: it cannot be
    ImageTexture imageTexture(const std::string& file, const PbrtPlace& place);
    std::string intern(const TextureDesc& texture);

    SceneDesc& scene_;
    PbrtFiles& files_;
    PbrtNotices& notices_;
    std::map<std::string, PbrtTexture> colors_, numbers_; // by name
    UniqueNames names_;
};

} // namespace rt::scene
