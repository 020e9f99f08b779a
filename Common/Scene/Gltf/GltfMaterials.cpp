#include "Common/Scene/Gltf/GltfMaterials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "Common/Scene/Json/JsonNode.h"

namespace rt::scene {

namespace {

// ---- values of extensions ------------------------------------------------------------------------------------------

const tinygltf::Value* member(const tinygltf::Value& object, const char* key) {
    return object.IsObject() && object.Has(key) ? &object.Get(key) : nullptr;
}

double numberOf(const tinygltf::Value& object, const char* key, double usual) {
    const tinygltf::Value* value = member(object, key);
    return value && value->IsNumber() ? value->GetNumberAsDouble() : usual;
}

double component(const tinygltf::Value& object, const char* key, int index, double usual) {
    const tinygltf::Value* value = member(object, key);
    if (!value || !value->IsArray() || value->ArrayLen() <= static_cast<std::size_t>(index)) return usual;
    const tinygltf::Value& entry = value->Get(index);
    return entry.IsNumber() ? entry.GetNumberAsDouble() : usual;
}

glm::dvec3 vectorOf(const tinygltf::Value& object, const char* key, double usual) {
    return {component(object, key, 0, usual), component(object, key, 1, usual), component(object, key, 2, usual)};
}

const tinygltf::Value* extension(const tinygltf::ExtensionMap& extensions, const char* name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

double share(double value) {
    return std::clamp(value, 0.0, 1.0);
}

glm::dvec3 colorOf(const std::vector<double>& components, double usual) {
    glm::dvec3 color(usual);
    for (std::size_t c = 0; c < std::min<std::size_t>(3, components.size()); ++c)
        color[static_cast<int>(c)] = components[c];
    return glm::clamp(color, 0.0, kLargest);
}

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

} // namespace

// ---- textures ------------------------------------------------------------------------------------------------------

struct GltfMaterials::Slot {
    int index = -1; // of a texture; -1: none
    int set = 0;
    const tinygltf::Value* transform = nullptr;

    Slot() = default;
    template <typename Info>
    explicit Slot(const Info& info)
        : index(info.index), set(info.texCoord), transform(extension(info.extensions, "KHR_texture_transform")) {
        overrideSet();
    }
    Slot(const tinygltf::Value& object, const char* key) {
        const tinygltf::Value* info = member(object, key);
        if (!info) return;
        index = index32(*info, "index", -1);
        set = index32(*info, "texCoord", 0);
        if (const tinygltf::Value* extensions = member(*info, "extensions"))
            transform = member(*extensions, "KHR_texture_transform");
        overrideSet();
    }

  private:
    static int index32(const tinygltf::Value& object, const char* key, int usual) {
        return static_cast<int>(std::clamp(numberOf(object, key, usual), -1.0, 1e9));
    }
    void overrideSet() {
        if (transform) set = index32(*transform, "texCoord", set);
    }
};

GltfMaterials::GltfMaterials(const GltfFile& file, SceneDesc& scene) : file_(file), scene_(scene) {
    for (std::size_t i = 0; i < file.model.materials.size(); ++i) add(i);
    for (const auto& [what, count] : leftOut_)
        scene.notices.push_back(what + " of " + std::to_string(count) +
                                (count == 1 ? " material is" : " materials are") + " left out");
}

void GltfMaterials::leaveOut(const std::string& what) {
    ++leftOut_[what];
}

// Name of a texture of the scene; empty where the slot has none.
std::string GltfMaterials::texture(const Slot& slot, ColorSpace space, const glm::dvec3& tint,
                                   const std::string& place) {
    if (slot.index < 0) return {};
    if (slot.set < 0 || slot.set > 1) file_.fail(place, "texCoord: must be 0 or 1, as there are two sets here");
    const tinygltf::Texture& source = file_.model.textures[static_cast<std::size_t>(slot.index)];
    if (source.source < 0) {
        leaveOut("a texture without a PNG or JPEG image");
        return {};
    }
    const tinygltf::Image& image = file_.model.images[static_cast<std::size_t>(source.source)];
    ImageTexture texture;
    if (image.bufferView < 0 && image.image.empty()) {
        texture.file = besideGltf(file_.path, image.uri).generic_string();
    } else {
        texture.file = std::filesystem::absolute(file_.path).lexically_normal().generic_string();
        texture.image = static_cast<std::uint32_t>(source.source);
    }
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
            file_.fail(place, "KHR_texture_transform: must be numbers from -1e9 to 1e9");
    for (const auto& [name, known] : scene_.textures)
        if (known == TextureDesc(texture)) return name;
    const std::string usual = image.name.empty() ? source.name : image.name;
    const std::string name = names_.unique(usual, "image", static_cast<std::size_t>(source.source));
    scene_.textures[name] = texture;
    return name;
}

NumberOrTexture GltfMaterials::number(double factor, const Slot& slot, Channel channel, const std::string& place) {
    const std::string name = texture(slot, ColorSpace::Linear, glm::dvec3(1), place);
    return {share(factor), name, name.empty() ? Channel::Red : channel};
}

ColorOrTexture GltfMaterials::color(const glm::dvec3& factor, const Slot& slot, const std::string& place) {
    const glm::dvec3 tint = glm::clamp(factor, 0.0, 1.0);
    const std::string name = texture(slot, ColorSpace::Srgb, tint, place);
    if (name.empty()) return tint;
    return name;
}

// ---- materials -----------------------------------------------------------------------------------------------------

void GltfMaterials::add(std::size_t index) {
    const tinygltf::Material& source = file_.model.materials[index];
    const std::string place = "/materials/" + std::to_string(index);
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    MaterialDesc material;
    material.kind = MaterialKind::Principled;
    material.sides = Sides::Both;
    const Slot base(pbr.baseColorTexture), normal(source.normalTexture);
    const glm::dvec3 baseColor = colorOf(pbr.baseColorFactor, 1);
    material.albedo = color(baseColor, base, place);

    PrincipledDesc& p = material.principled;
    const Slot surface(pbr.metallicRoughnessTexture);
    p.metallic = number(pbr.metallicFactor, surface, Channel::Blue, place);
    p.roughness = number(pbr.roughnessFactor, surface, Channel::Green, place);
    p.normalTexture = texture(normal, ColorSpace::Linear, glm::dvec3(1), place);
    p.normalScale = std::clamp(source.normalTexture.scale, -100.0, 100.0);
    if (source.occlusionTexture.index >= 0) leaveOut("the occlusion map, which is no property of the surface,");

    const bool isOpaque = source.alphaMode != "MASK" && source.alphaMode != "BLEND";
    if (!isOpaque) {
        p.opacity.factor = share(pbr.baseColorFactor.size() > 3 ? pbr.baseColorFactor[3] : 1);
        if (const auto* name = std::get_if<std::string>(&material.albedo)) {
            p.opacity.texture = *name;
            p.opacity.channel = Channel::Alpha;
        }
        if (source.alphaMode == "MASK") p.alphaCutoff = share(source.alphaCutoff);
    }
    material.emission = colorOf(source.emissiveFactor, 0);
    if (const auto* strength = extension(source.extensions, "KHR_materials_emissive_strength"))
        material.emission = glm::clamp(material.emission * numberOf(*strength, "emissiveStrength", 1), 0.0, kLargest);
    if (material.emission != glm::dvec3(0))
        material.emissionTexture = texture(Slot(source.emissiveTexture), ColorSpace::Srgb, glm::dvec3(1), place);
    emitsAsLight_ = emitsAsLight_ || glm::any(glm::greaterThan(material.emission, glm::dvec3(1)));
    addExtensions(source, place, material);

    const bool isUnlit = extension(source.extensions, "KHR_materials_unlit") != nullptr;
    if (isUnlit) { // shows its base colour whatever light there is: black, and emitting it
        MaterialDesc unlit;
        unlit.kind = MaterialKind::Principled;
        unlit.sides = Sides::Both;
        unlit.albedo = glm::dvec3(0);
        unlit.principled.specular.factor = 0;
        unlit.principled.opacity = p.opacity;
        unlit.principled.alphaCutoff = p.alphaCutoff;
        unlit.emission = baseColor;
        unlit.emissionTexture = texture(base, ColorSpace::Srgb, glm::dvec3(1), place);
        material = unlit;
    }
    Use use{names_.unique(source.name, "material", index), isOpaque, isUnlit, std::nullopt};
    const PrincipledDesc& made = material.principled;
    for (const std::string& map : {made.clearcoatNormalTexture, made.normalTexture}) // the latter outweighs the other
        if (!map.empty()) use.tangentSet = std::get<ImageTexture>(scene_.textures.at(map)).uvSet;
    scene_.materials[use.name] = std::move(material);
    uses_.push_back(std::move(use));
}

void GltfMaterials::addExtensions(const tinygltf::Material& source, const std::string& place, MaterialDesc& material) {
    PrincipledDesc& p = material.principled;
    const auto& extensions = source.extensions;
    if (const auto* ior = extension(extensions, "KHR_materials_ior")) {
        constexpr double kLargestIor = 10;
        const double stated = numberOf(*ior, "ior", 1.5);
        if (stated < 1 || stated > kLargestIor)
            leaveOut("an index of refraction outside 1 to 10");
        else
            p.ior = stated;
    }
    if (const auto* transmission = extension(extensions, "KHR_materials_transmission")) {
        p.transmission = number(numberOf(*transmission, "transmissionFactor", 0),
                                Slot(*transmission, "transmissionTexture"), Channel::Red, place);
        p.isThin = true; // unless it has a volume
    }
    if (const auto* volume = extension(extensions, "KHR_materials_volume")) {
        const double thickness = numberOf(*volume, "thicknessFactor", 0);
        const double distance = numberOf(*volume, "attenuationDistance", 0);
        if (thickness > 0) {
            p.isThin = false;
            p.attenuationColor = glm::clamp(vectorOf(*volume, "attenuationColor", 1), 0.0, 1.0);
            if (distance > 0) p.attenuationDistance = std::clamp(distance, 1 / kLargest, kLargest);
        }
    }
    if (const auto* specular = extension(extensions, "KHR_materials_specular")) {
        p.specular =
            number(numberOf(*specular, "specularFactor", 1), Slot(*specular, "specularTexture"), Channel::Alpha, place);
        const glm::dvec3 tint = vectorOf(*specular, "specularColorFactor", 1);
        if (glm::any(glm::greaterThan(tint, glm::dvec3(1)))) leaveOut("what exceeds 1 in the specular colour");
        p.specularColor = color(tint, Slot(*specular, "specularColorTexture"), place);
    }
    if (const auto* coat = extension(extensions, "KHR_materials_clearcoat")) {
        p.clearcoat =
            number(numberOf(*coat, "clearcoatFactor", 0), Slot(*coat, "clearcoatTexture"), Channel::Red, place);
        p.clearcoatRoughness = number(numberOf(*coat, "clearcoatRoughnessFactor", 0),
                                      Slot(*coat, "clearcoatRoughnessTexture"), Channel::Green, place);
        p.clearcoatNormalTexture =
            texture(Slot(*coat, "clearcoatNormalTexture"), ColorSpace::Linear, glm::dvec3(1), place);
        if (const tinygltf::Value* info = member(*coat, "clearcoatNormalTexture"))
            p.clearcoatNormalScale = std::clamp(numberOf(*info, "scale", 1), -100.0, 100.0);
    }
    if (const auto* sheen = extension(extensions, "KHR_materials_sheen")) {
        p.sheenColor = color(vectorOf(*sheen, "sheenColorFactor", 0), Slot(*sheen, "sheenColorTexture"), place);
        p.sheenRoughness = number(numberOf(*sheen, "sheenRoughnessFactor", 0), Slot(*sheen, "sheenRoughnessTexture"),
                                  Channel::Alpha, place);
    }
}

const GltfMaterials::Use& GltfMaterials::use(int material) {
    if (material >= 0) return uses_[static_cast<std::size_t>(material)];
    if (!plain_) { // 3.9.1 of the specification: that of an empty material
        plain_ = Use{names_.unique("default", "material", 0), true, false, std::nullopt};
        MaterialDesc desc;
        desc.kind = MaterialKind::Principled;
        desc.sides = Sides::Both;
        desc.principled.metallic.factor = desc.principled.roughness.factor = 1;
        scene_.materials[plain_->name] = desc;
    }
    return *plain_;
}

} // namespace rt::scene
