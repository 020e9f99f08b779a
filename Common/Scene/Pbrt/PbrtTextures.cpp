#include "Common/Scene/Pbrt/PbrtTextures.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "Common/Core/Printable.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Pbrt/PbrtValues.h"

namespace rt::scene {

namespace {

constexpr const char* kKnownTextures =
    "constant, imagemap, scale, mix, directionmix, checkerboard, bilerp, dots, fbm, wrinkled, windy, marble, ptex";

Wrap wrapOf(const std::string& wrap) {
    return wrap == "repeat" ? Wrap::Repeat : Wrap::Clamp;
}

glm::dvec3 greyLike(const PbrtTexture& texture) {
    const auto* constant = std::get_if<glm::dvec3>(&texture.value);
    return constant ? *constant : glm::dvec3(0.5);
}

} // namespace

void PbrtTextures::define(const std::string& name, bool isColor, const std::string& kind,
                          const PbrtParameters& parameters, const Affine& toWorld) {
    const PbrtUse use = isColor ? PbrtUse::Reflectance : PbrtUse::Number;
    PbrtTexture made;
    if (kind == "constant")
        made = value(parameters, "value", use, glm::dvec3(1));
    else if (kind == "imagemap")
        made = imageMap(isColor, parameters);
    else if (kind == "scale")
        made = scaled(parameters, use);
    else if (kind == "mix" || kind == "directionmix")
        made = mixed(parameters, use);
    else if (kind == "checkerboard")
        made = checkerboard(parameters, use, toWorld);
    else
        made = standIn(kind, parameters, use);
    (isColor ? colors_ : numbers_)[name] = std::move(made);
}

PbrtTexture PbrtTextures::value(const PbrtParameters& parameters, std::string_view name, PbrtUse use,
                                const glm::dvec3& usual) {
    const PbrtParameter* found = parameters.find(name);
    if (!found) return {usual};
    if (found->type != PbrtType::Texture) return {constant(*found, use)};
    if (found->texts.size() != 1) found->fail("must name one texture");
    const auto& known = use == PbrtUse::Number ? numbers_ : colors_;
    const auto texture = known.find(found->texts.front());
    if (texture != known.end()) return texture->second;
    std::string names;
    for (const auto& [other, ignored] : known)
        if (names.size() < 200) names += (names.empty() ? "" : ", ") + printable(other, 100);
    found->fail('"' + printable(found->texts.front(), 100) + "\" is no texture of " +
                (use == PbrtUse::Number ? "floats" : "spectra") +
                (names.empty() ? ", of which there is none" : "; known are " + names));
}

glm::dvec3 PbrtTextures::constant(const PbrtParameter& parameter, PbrtUse use) {
    return use == PbrtUse::Number ? glm::dvec3(pbrtNumber(parameter)) : pbrtReflectance(parameter, files_);
}

ColorOrTexture PbrtTextures::color(const PbrtTexture& texture, const PbrtPlace& place) {
    if (const auto* constant = std::get_if<glm::dvec3>(&texture.value)) return glm::clamp(*constant, 0.0, 1.0);
    if (texture.isInverted) notices_.add("\"invert\" of a texture of colours is left out", place);
    return intern(std::get<TextureDesc>(texture.value));
}

NumberOrTexture PbrtTextures::number(const PbrtTexture& texture, const PbrtPlace& place) {
    if (const auto* constant = std::get_if<glm::dvec3>(&texture.value))
        return {std::clamp(texture.isInverted ? 1 - constant->x : constant->x, 0.0, 1.0), {}, Channel::Red};
    TextureDesc desc = std::get<TextureDesc>(texture.value);
    auto* image = std::get_if<ImageTexture>(&desc);
    if (!image) {
        notices_.add("numbers from textures that are no images count as 0.5", place);
        return {0.5, {}, Channel::Red};
    }
    const double factor = image->tint.x;
    image->tint = glm::dvec3(1);
    return {texture.isInverted ? -factor : factor, intern(desc), Channel::Red};
}

double PbrtTextures::plainNumber(const PbrtParameters& parameters, std::string_view name, double usual,
                                 double instead) {
    const PbrtTexture texture = value(parameters, name, PbrtUse::Number, glm::dvec3(usual));
    if (const auto* constant = std::get_if<glm::dvec3>(&texture.value))
        return texture.isInverted ? 1 - constant->x : constant->x;
    notices_.add(parameters.what + ": the texture of \"" + std::string(name) + "\" is left out", parameters.place);
    return instead;
}

ImageTexture PbrtTextures::imageTexture(const std::string& file, const PbrtPlace& place) {
    ImageTexture texture;
    texture.file = files_.locate(file, place).generic_string();
    texture.standIn = kWhiteStandIn;
    texture.wrapU = texture.wrapV = Wrap::Repeat;
    return texture;
}

std::string PbrtTextures::image(const std::string& file, ColorSpace space, const PbrtPlace& place) {
    ImageTexture texture = imageTexture(file, place);
    texture.colorSpace = space;
    return intern(texture);
}

// Images of 8 bits are encoded unless they say that they are not, also those of numbers.
PbrtTexture PbrtTextures::imageMap(bool isColor, const PbrtParameters& parameters) {
    const std::string file = parameters.string("filename", "");
    if (file.empty()) parameters.fail("\"string filename\" is missing");
    ImageTexture texture = imageTexture(file, parameters.find("filename")->place);
    const std::string encoding = parameters.string("encoding", "sRGB");
    if (encoding == "linear")
        texture.colorSpace = ColorSpace::Linear;
    else if (encoding != "sRGB")
        notices_.add("images of encoding \"" + printable(encoding, 100) + "\" are read as sRGB", parameters.place);
    const std::string wrap = parameters.oneOf("wrap", "repeat", {"repeat", "clamp", "black", "octahedralsphere"});
    if (wrap != "repeat" && wrap != "clamp")
        notices_.add("images of wrap mode \"" + wrap + "\" go on as with clamp", parameters.place);
    texture.wrapU = texture.wrapV = wrapOf(wrap);
    const std::string mapping = parameters.oneOf("mapping", "uv", {"uv", "spherical", "cylindrical", "planar"});
    if (mapping != "uv")
        notices_.add("textures of mapping \"" + mapping + "\" follow texture coordinates", parameters.place);
    for (const char* vector : {"v1", "v2"}) parameters.find(vector);
    texture.uvTransform = {parameters.number("uscale", 1), 0,
                           parameters.number("udelta", 0), 0,
                           parameters.number("vscale", 1), parameters.number("vdelta", 0)};
    for (const char* quality : {"filter", "maxanisotropy"}) parameters.find(quality);
    const double scale = parameters.number("scale", 1); // negative ones are of bumps
    if (scale > 1) notices_.add("textures that are scaled up keep 1 as their factor", parameters.place);
    texture.tint = glm::dvec3(std::clamp(scale, 0.0, 1.0));
    PbrtTexture made;
    made.value = texture;
    made.isInverted = parameters.boolean("invert", false);
    if (made.isInverted && isColor) notices_.add("\"invert\" of a texture of colours is left out", parameters.place);
    return made;
}

bool PbrtTextures::multiply(TextureDesc& texture, const glm::dvec3& factor) const {
    const glm::dvec3 kept = glm::clamp(factor, 0.0, 1.0);
    if (auto* image = std::get_if<ImageTexture>(&texture)) {
        image->tint *= kept;
        return true;
    }
    if (auto* noise = std::get_if<NoiseTexture>(&texture)) {
        noise->tint *= kept;
        return true;
    }
    auto* checker = std::get_if<CheckerTexture>(&texture);
    if (!checker) return false;
    auto* even = std::get_if<glm::dvec3>(&checker->even);
    auto* odd = std::get_if<glm::dvec3>(&checker->odd);
    if (!even || !odd) return false;
    *even *= kept;
    *odd *= kept;
    return true;
}

PbrtTexture PbrtTextures::scaled(const PbrtParameters& parameters, PbrtUse use) {
    PbrtTexture texture = value(parameters, "tex", use, glm::dvec3(1));
    PbrtTexture scale = value(parameters, "scale", PbrtUse::Number, glm::dvec3(1));
    if (texture.isConstant()) std::swap(texture, scale);
    const glm::dvec3 factor = greyLike(scale);
    if (!scale.isConstant())
        notices_.add("of textures that multiply each other the second counts as 0.5", parameters.place);
    if (auto* constant = std::get_if<glm::dvec3>(&texture.value)) {
        *constant *= factor;
        return texture;
    }
    if (std::max({factor.x, factor.y, factor.z}) > 1)
        notices_.add("textures that are scaled up keep 1 as their factor", parameters.place);
    if (texture.isInverted || !multiply(std::get<TextureDesc>(texture.value), factor))
        notices_.add("the scale of an inverted or composed texture is left out", parameters.place);
    return texture;
}

PbrtTexture PbrtTextures::mixed(const PbrtParameters& parameters, PbrtUse use) {
    const PbrtTexture first = value(parameters, "tex1", use, glm::dvec3(0));
    const PbrtTexture second = value(parameters, "tex2", use, glm::dvec3(1));
    const PbrtTexture amount = value(parameters, "amount", PbrtUse::Number, glm::dvec3(0.5));
    const double share = greyLike(amount).x;
    parameters.find("dir"); // of directionmix
    if (first.isConstant() && second.isConstant() && amount.isConstant())
        return {glm::mix(std::get<glm::dvec3>(first.value), std::get<glm::dvec3>(second.value), share)};
    if (share > 0 && share < 1)
        notices_.add("of mixed textures the one of the larger amount stands for both", parameters.place);
    return share < 0.5 ? first : second;
}

PbrtTexture PbrtTextures::checkerboard(const PbrtParameters& parameters, PbrtUse use, const Affine& toWorld) {
    const PbrtTexture first = value(parameters, "tex1", use, glm::dvec3(1));
    const PbrtTexture second = value(parameters, "tex2", use, glm::dvec3(0));
    if (parameters.integer("dimension", 2) != 3) {
        for (const char* name : {"uscale", "vscale", "udelta", "vdelta", "mapping", "v1", "v2"}) parameters.find(name);
        notices_.add("checkerboards in texture coordinates are of the mean of both colours", parameters.place);
        return {0.5 * (greyLike(first) + greyLike(second))};
    }
    CheckerTexture checker;
    checker.even = color(first, parameters.place);
    checker.odd = color(second, parameters.place);
    const double scale = std::abs(toWorld.linear[0][0]);
    const bool isScale = glm::abs(toWorld.linear[0][0]) == scale && toWorld.linear == glm::dmat3(scale);
    if (!isScale || toWorld.offset != glm::dvec3(0))
        notices_.add("of a solid texture's place only its scale counts", parameters.place);
    checker.scale = std::clamp(scale, 1 / kLargest, kLargest);
    PbrtTexture made;
    made.value = checker;
    return made;
}

// What has no texture of its kind here.
PbrtTexture PbrtTextures::standIn(const std::string& kind, const PbrtParameters& parameters, PbrtUse use) {
    PbrtTexture made{glm::dvec3(0.5)};
    std::string instead = "grey";
    if (kind == "dots") {
        made = value(parameters, "outside", use, glm::dvec3(0));
        parameters.find("inside");
        instead = "what is outside of its dots";
    } else if (kind == "bilerp") {
        glm::dvec3 sum(0);
        for (const char* corner : {"v00", "v01", "v10", "v11"})
            sum += greyLike(value(parameters, corner, use, glm::dvec3(corner[1] == '1' ? 1 : 0)));
        made = {0.25 * sum};
        instead = "the mean of its corners";
    } else if (kind == "marble") {
        NoiseTexture noise;
        noise.scale = std::clamp(parameters.number("scale", 1), 1 / kLargest, kLargest);
        made.value = noise;
        instead = "marble of ours";
    } else if (kind != "fbm" && kind != "wrinkled" && kind != "windy" && kind != "ptex" && kind != "uv") {
        parameters.place.fail("Texture \"" + printable(kind, 100) + "\" is unknown; known are " + kKnownTextures);
    }
    for (const PbrtParameter& parameter : parameters.list) parameter.isUsed = true;
    notices_.add("textures \"" + kind + "\" are left out: " + instead + " instead", parameters.place);
    return made;
}

std::string PbrtTextures::intern(const TextureDesc& texture) {
    for (const auto& [name, known] : scene_.textures)
        if (known == texture) return name;
    const auto* image = std::get_if<ImageTexture>(&texture);
    const std::string base = image ? std::filesystem::path(image->file).filename().string() : std::string();
    std::string name = names_.unique(base, "texture", scene_.textures.size());
    scene_.textures[name] = texture;
    return name;
}

} // namespace rt::scene
