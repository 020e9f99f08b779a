#include "Common/Scene/Gltf/GltfTextures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <system_error>

#include <glm/common.hpp>

#include "Common/Core/OtherCase.h"
#include "Common/Core/Printable.h"
#include "Common/Core/ReadFile.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/Gltf/GltfUri.h"
#include "Common/Scene/Json/JsonNode.h"

namespace rt::scene {

namespace {

Wrap wrapOf(int mode) {
    switch (mode) {
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return Wrap::Clamp;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return Wrap::Mirror;
        default:
            return Wrap::Repeat;
    }
}

// KHR_texture_transform: scaled, rotated counter-clockwise as one sees the image, moved; between coordinates whose v
// runs upwards. With the extension's rows (a b x; d e y), which have v running downwards: 1 - v' = d u + e (1 - v) + y.
std::array<double, 6> uvRows(const tinygltf::Value& transform) {
    const double angle = numberOf(transform, "rotation", 0);
    const double c = std::cos(angle), s = std::sin(angle);
    const double scaleU = component(transform, "scale", 0, 1), scaleV = component(transform, "scale", 1, 1);
    const double x = component(transform, "offset", 0, 0), y = component(transform, "offset", 1, 0);
    const double a = c * scaleU, b = s * scaleV, d = -s * scaleU, e = c * scaleV;
    return {a, -b, b + x, -d, e, 1 - e - y};
}

int wholeOf(const tinygltf::Value& object, const char* key, int usual) {
    return static_cast<int>(std::clamp(numberOf(object, key, usual), -1.0, 1e9));
}

// Builds without WebP draw the image that a file has for them, if it has one.
int imageOf(const tinygltf::Texture& texture) {
    const auto webp = texture.extensions.find("EXT_texture_webp");
    if (webp == texture.extensions.end()) return texture.source;
#ifndef RT_HAS_WEBP
    if (texture.source >= 0) return texture.source;
#endif
    return wholeOf(webp->second, "source", texture.source);
}

} // namespace

GltfSlot::GltfSlot(const tinygltf::Value& object, const char* key) {
    const tinygltf::Value* info = member(object, key);
    if (!info) return;
    index = wholeOf(*info, "index", -1);
    set = wholeOf(*info, "texCoord", 0);
    if (const tinygltf::Value* extensions = member(*info, "extensions"))
        transform = member(*extensions, "KHR_texture_transform");
    overrideSet();
}

void GltfSlot::overrideSet() {
    if (transform) set = wholeOf(*transform, "texCoord", set);
}

// Where the image is; false: nowhere.
bool GltfTextures::locate(std::size_t index, ImageTexture& texture) {
    const GltfImage& image = file_.images[index];
    if (image.bufferView >= 0 || !image.content.empty()) {
        texture.file = std::filesystem::absolute(file_.path).lexically_normal().generic_string();
        texture.image = static_cast<std::uint32_t>(index);
        return true;
    }
    std::error_code none;
    if (!image.uri.empty()) {
        const std::filesystem::path path = besideGltf(file_.path, image.uri);
        texture.file = path.generic_string();
        // Of files that must not be read nobody learns whether they exist: they are refused when they are decoded.
        if (!mayRead(path) || std::filesystem::exists(path, none)) return true;
        if (!findInOtherCase(path).empty()) return true; // which the compiler of scenes takes, with a notice
    }
    missing_.insert(image.uri.empty() ? "/images/" + std::to_string(index) : '"' + printable(image.uri, 200) + '"');
    return false;
}

std::string GltfTextures::texture(const GltfSlot& slot, ColorSpace space, const glm::dvec3& tint) {
    if (slot.index < 0) return {};
    if (slot.set < 0 || slot.set > 1) {
        leaveOut("a texture of coordinates beyond the second set");
        return {};
    }
    const tinygltf::Texture& source = file_.model.textures[static_cast<std::size_t>(slot.index)];
    const int found = imageOf(source);
    if (found < 0) {
        leaveOut("a texture without a PNG, JPEG or WebP image");
        return {};
    }
    const auto image = static_cast<std::size_t>(found);
    ImageTexture texture;
    if (!locate(image, texture)) return {};
    texture.standIn = kWhiteStandIn;
    texture.tint = tint;
    texture.colorSpace = space;
    texture.wrapU = texture.wrapV = Wrap::Repeat;
    if (source.sampler >= 0) {
        const tinygltf::Sampler& sampler = file_.model.samplers[static_cast<std::size_t>(source.sampler)];
        texture.wrapU = wrapOf(sampler.wrapS);
        texture.wrapV = wrapOf(sampler.wrapT);
    }
    texture.uvSet = static_cast<std::uint32_t>(slot.set);
    if (slot.transform) texture.uvTransform = uvRows(*slot.transform);
    for (const double entry : texture.uvTransform)
        if (!(std::abs(entry) <= kLargest))
            file_.fail("/materials/" + std::to_string(material_),
                       "KHR_texture_transform: must be numbers from -1e9 to 1e9");
    for (const auto& [name, known] : scene_.textures)
        if (known == TextureDesc(texture)) return name;
    const std::string& own = file_.images[image].name;
    std::string name = names_.unique(own.empty() ? source.name : own, "image", image);
    scene_.textures[name] = texture;
    return name;
}

NumberOrTexture GltfTextures::number(double factor, const GltfSlot& slot, Channel channel) {
    const std::string name = texture(slot, ColorSpace::Linear, glm::dvec3(1));
    return {std::clamp(factor, 0.0, 1.0), name, name.empty() ? Channel::Red : channel};
}

ColorOrTexture GltfTextures::color(const glm::dvec3& factor, const GltfSlot& slot) {
    const glm::dvec3 tint = glm::clamp(factor, 0.0, 1.0);
    const std::string name = texture(slot, ColorSpace::Srgb, tint);
    if (name.empty()) return tint;
    return name;
}

void GltfTextures::addNotices() {
    for (const auto& [what, materials] : leftOut_)
        scene_.notices.push_back(what + " of " + counted(materials.size(), "material is", "materials are") +
                                 " left out");
    constexpr std::size_t kMaxNamed = 5;
    std::string names;
    std::size_t named = 0;
    for (const std::string& name : missing_)
        if (++named <= kMaxNamed) names += (names.empty() ? "" : ", ") + name;
    if (named > kMaxNamed) names += " and " + counted(named - kMaxNamed, "other", "others");
    if (named > 0) scene_.notices.push_back("images that do not exist are left out of materials: " + names);
}

} // namespace rt::scene
