#include "Common/Scene/MaterialX/MaterialXSurface.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "Common/Scene/IsAlways.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/MaterialX/MaterialXValues.h"

namespace rt::scene {

namespace {

const glm::dvec3 kLuminance(0.2126, 0.7152, 0.0722); // of Rec. 709

// What is no more than a simpler kind can be is of that kind, which renders quicker.
void simplify(MaterialDesc& material) {
    const PrincipledDesc& p = material.principled;
    const bool hasOneLayer = isAlways(p.metallic, 0) && isAlways(p.clearcoat, 0) && isAlways(p.sheenColor, 0) &&
                             isAlways(p.opacity, 1) && p.normalTexture.empty() && isAlways(p.iridescence, 0) &&
                             isAlways(p.anisotropy, 0);
    if (!hasOneLayer) return;
    if (isAlways(p.specular, 0) && isAlways(p.transmission, 0)) {
        material.kind = MaterialKind::Lambertian;
        material.principled = {};
    } else if (isAlways(p.transmission, 1) && isAlways(p.roughness, 0) && isAlways(p.specular, 1) &&
               isAlways(p.specularColor, 1) && isAlways(material.albedo, 1) && !p.isThin && !p.attenuationDistance &&
               p.dispersion == 0) {
        material.kind = MaterialKind::Dielectric;
        material.parameters[0] = p.ior;
        material.principled = {};
    }
}

} // namespace

void MaterialXSurface::leaveOut(const MaterialXInput& input, const std::string& what) {
    notices_.insert(materialXPlace(node_) + ": input " + input.name + ": " + what);
}

// ---- values of inputs ----------------------------------------------------------------------------------------------

std::optional<MaterialXSignal> MaterialXSurface::signal(const MaterialXInput& input) {
    if (input.name == nullptr) return std::nullopt;
    const XmlElement* given = node_.child("input", input.name);
    return given != nullptr ? graph_.signal(node_, *given) : std::nullopt;
}

double MaterialXSurface::constant(const MaterialXInput& input, double least, double most) {
    const auto found = signal(input);
    if (!found) return input.usual;
    if (found->image) {
        leaveOut(input, "its image is left out: only a constant is read");
        return std::clamp(input.usual, least, most);
    }
    const double value = std::clamp(found->factor.x, least, most);
    if (value != found->factor.x) leaveOut(input, "brought into its range");
    return value;
}

glm::dvec3 MaterialXSurface::constantColor(const MaterialXInput& input, double most) {
    const auto found = signal(input);
    if (!found) return glm::dvec3(input.usual);
    if (found->image) {
        leaveOut(input, "its image is left out: only a constant is read");
        return glm::dvec3(input.usual);
    }
    const glm::dvec3 value = glm::clamp(glm::dvec3(found->factor), 0.0, most);
    if (value != glm::dvec3(found->factor)) leaveOut(input, "brought into its range");
    return value;
}

NumberOrTexture MaterialXSurface::number(const MaterialXInput& input) {
    const auto found = signal(input);
    if (!found || !found->image) return {constant(input, 0, 1), {}, Channel::Red};
    NumberOrTexture result;
    result.channel = found->channel.value_or(Channel::Red);
    const double factor = found->factor[static_cast<glm::length_t>(result.channel)];
    result.factor = std::clamp(factor, 0.0, 1.0);
    if (result.factor != factor) leaveOut(input, "the factor of its image is brought into its range");
    if (found->isInverted && result.factor == 0) return {1, {}, Channel::Red};
    if (found->isInverted) result.factor = -result.factor;
    result.texture = texture(*found, glm::dvec3(1), ColorSpace::Linear);
    return result;
}

ColorOrTexture MaterialXSurface::color(const MaterialXInput& input, const glm::dvec3& weight) {
    const auto found = signal(input);
    if (!found || !found->image) return constantColor(input, 1) * weight;
    if (found->isInverted || found->channel) {
        leaveOut(input, "left out: a channel or an inverted image is no colour here");
        return glm::dvec3(input.usual) * weight;
    }
    const glm::dvec3 tint = glm::dvec3(found->factor) * weight;
    return texture(*found, glm::clamp(tint, 0.0, 1.0), found->image->colorSpace);
}

std::string MaterialXSurface::normals(const MaterialXInput& input, double& scale) {
    const auto found = signal(input);
    if (!found || !found->image) return {}; // constant ones are those of the surface
    if (!found->isNormalMap) {
        leaveOut(input, "left out: normals come from an image by a normalmap");
        return {};
    }
    scale = std::clamp(found->factor.x, -kLargest, kLargest);
    return texture(*found, glm::dvec3(1), ColorSpace::Linear);
}

// Images that are equal share a texture.
std::string MaterialXSurface::texture(const MaterialXSignal& found, const glm::dvec3& tint, ColorSpace space) {
    ImageTexture image = *found.image;
    image.tint = tint;
    image.colorSpace = space;
    for (const auto& [name, known] : scene_.textures)
        if (known == TextureDesc(image)) return name;
    std::string name = names_.unique(found.imageNode, "image", scene_.textures.size());
    scene_.textures[name] = image;
    return name;
}

// ---- layers --------------------------------------------------------------------------------------------------------

void MaterialXSurface::addBase(MaterialDesc& material) {
    PrincipledDesc& p = material.principled;
    const double base = model_.base.name != nullptr ? constant(model_.base, 0, 1) : 1;
    // A coat of a colour takes some of the light that goes through it.
    glm::dvec3 coat(1);
    if (model_.coatColor.name != nullptr)
        coat = glm::mix(glm::dvec3(1), constantColor(model_.coatColor, 1), std::abs(number(model_.coat).factor));
    material.albedo = color(model_.baseColor, base * coat);
    if (model_.subsurface.name != nullptr) {
        if (const double below = constant(model_.subsurface, 0, 1); below > 0) {
            leaveOut(model_.subsurface, "light that travels below the surface leaves it where it came in");
            const ColorOrTexture there = color(model_.subsurfaceColor, coat);
            const auto *a = std::get_if<glm::dvec3>(&material.albedo), *b = std::get_if<glm::dvec3>(&there);
            if (a != nullptr && b != nullptr)
                material.albedo = glm::mix(*a, *b, below);
            else if (below >= 0.5) // of two images the one that counts for more
                material.albedo = there;
        }
    }
    p.metallic = number(model_.metallic);
    p.roughness = number(model_.roughness);
    p.specular = number(model_.specular);
    p.specularColor = color(model_.specularColor, glm::dvec3(1));
    p.ior = constant(model_.ior, 1, kLargestIor);
    p.normalTexture = normals(model_.normal, p.normalScale);
    p.clearcoatNormalTexture = normals(model_.coatNormal, p.clearcoatNormalScale);
}

// As MaterialX itself translates between these models: what is transmitted is tinted at once where no depth is given.
void MaterialXSurface::addTransmission(MaterialDesc& material) {
    PrincipledDesc& p = material.principled;
    p.transmission = number(model_.transmission);
    if (p.transmission.factor == 0) return;
    if (model_.thickness.name != nullptr) { // that of glTF
        p.isThin = constant(model_.thickness, 0, kLargest) == 0;
        const double distance = constant(model_.attenuationDistance, 0, kLargest);
        if (p.isThin || distance == 0) return;
        p.attenuationColor = constantColor(model_.attenuationColor, 1);
        p.attenuationDistance = std::max(distance, 1 / kLargest);
        return;
    }
    if (const XmlElement* thin = node_.child("input", model_.thin.name)) p.isThin = graph_.flag(node_, *thin);
    const double depth = constant(model_.transmissionDepth, 0, kLargest);
    if (depth > 0 && !p.isThin) {
        p.attenuationColor = constantColor(model_.transmissionColor, 1);
        p.attenuationDistance = std::max(depth, 1 / kLargest);
    }
    // The base shows where light is not transmitted; both have one colour here.
    if (p.transmission.texture.empty() && p.transmission.factor < 1)
        leaveOut(model_.transmission, "what is transmitted and what is not have one colour");
    material.albedo =
        p.attenuationDistance ? ColorOrTexture(glm::dvec3(1)) : color(model_.transmissionColor, glm::dvec3(1));
}

void MaterialXSurface::addCoatAndSheen(MaterialDesc& material) {
    PrincipledDesc& p = material.principled;
    p.clearcoat = number(model_.coat);
    p.clearcoatRoughness = number(model_.coatRoughness);
    const double sheen = model_.sheen.name != nullptr ? constant(model_.sheen, 0, 1) : 1;
    p.sheenColor = sheen > 0 ? color(model_.sheenColor, glm::dvec3(sheen)) : ColorOrTexture(glm::dvec3(0));
    if (isAlways(p.sheenColor, 0)) return;
    p.sheenRoughness = number(model_.sheenRoughness);
    if (!model_.isSheenSquared) return;
    if (p.sheenRoughness.texture.empty())
        p.sheenRoughness.factor = std::sqrt(p.sheenRoughness.factor);
    else
        leaveOut(model_.sheenRoughness, "its image is read as that of glTF, whose square counts");
}

void MaterialXSurface::addEmission(MaterialDesc& material) {
    const double strength = constant(model_.emission, 0, kLargest);
    const auto found = signal(model_.emissionColor);
    if (strength == 0) return;
    if (!found || !found->image) {
        material.emission = glm::min(strength * constantColor(model_.emissionColor, kLargest), kLargest);
        return;
    }
    if (found->isInverted || found->channel)
        return leaveOut(model_.emissionColor, "left out: a channel or an inverted image is no colour here");
    material.emission = glm::clamp(strength * glm::dvec3(found->factor), 0.0, kLargest);
    material.emissionTexture = texture(*found, glm::dvec3(1), found->image->colorSpace);
}

void MaterialXSurface::addOpacity(PrincipledDesc& p) {
    constexpr double kOpaque = 0, kMask = 1;
    const bool hasMode = model_.alphaMode.name != nullptr;
    const double mode = hasMode ? constant(model_.alphaMode, 0, 2) : kOpaque;
    if (hasMode && mode == kOpaque) return;
    const auto found = signal(model_.opacity);
    if (found && !found->image) // a colour of standard_surface, by its luminance
        p.opacity.factor = std::clamp(glm::dot(kLuminance, glm::dvec3(found->factor)), 0.0, 1.0);
    else
        p.opacity = number(model_.opacity);
    if (hasMode && mode == kMask) p.alphaCutoff = constant(model_.alphaCutoff, 0, 1);
}

void MaterialXSurface::addFilm(PrincipledDesc& p) {
    const double thickness = model_.filmUnit * constant(model_.filmThickness, 0, kLargest / model_.filmUnit);
    if (model_.film.name != nullptr)
        p.iridescence = number(model_.film);
    else
        p.iridescence.factor = thickness > 0 ? 1 : 0;
    if (p.iridescence.factor == 0) return;
    p.iridescenceIor = constant(model_.filmIor, 1, kLargestFilmIor);
    p.iridescenceThicknessMaximum = thickness; // which counts while iridescenceThickness is 1
}

void MaterialXSurface::addDispersion(PrincipledDesc& p) {
    constexpr double kStrong = 20; // the Abbe number of a dispersion of 1
    if (p.transmission.factor == 0) return;
    p.dispersion = model_.dispersion.name != nullptr ? constant(model_.dispersion, 0, kLargest) : 1;
    if (model_.abbe.name == nullptr) return;
    const double abbe = constant(model_.abbe, 0, kLargest);
    p.dispersion = abbe > 0 ? std::min(p.dispersion * kStrong / abbe, kLargest) : 0;
}

void MaterialXSurface::addAnisotropy(PrincipledDesc& p) {
    if (model_.anisotropy.name == nullptr) return;
    p.anisotropy = number(model_.anisotropy);
    if (p.anisotropy.factor != 0) p.anisotropyRotation = constant(model_.anisotropyRotation, -kLargest, kLargest);
}

void MaterialXSurface::addNotices() {
    for (const MaterialXInput& input : model_.leftOut) {
        if (node_.child("input", input.name) == nullptr) continue;
        const auto found = signal(input);
        if (!found || found->image || glm::dvec3(found->factor) != glm::dvec3(input.usual)) leaveOut(input, "left out");
    }
}

MaterialDesc MaterialXSurface::material() {
    MaterialDesc material;
    material.kind = MaterialKind::Principled;
    addBase(material);
    addTransmission(material);
    addCoatAndSheen(material);
    addEmission(material);
    addOpacity(material.principled);
    addFilm(material.principled);
    addDispersion(material.principled);
    addAnisotropy(material.principled);
    addNotices();
    simplify(material);
    return material;
}

} // namespace rt::scene
