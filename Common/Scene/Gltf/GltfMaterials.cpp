#include "Common/Scene/Gltf/GltfMaterials.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "Common/Scene/Gltf/GltfExtras.h"
#include "Common/Scene/Gltf/GltfValues.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Reflectance.h"

namespace rt::scene {

namespace {

double share(double value) {
    return std::clamp(value, 0.0, 1.0);
}

glm::dvec3 colorOf(const std::vector<double>& components, double usual) {
    glm::dvec3 color(usual);
    for (std::size_t c = 0; c < std::min<std::size_t>(3, components.size()); ++c)
        color[static_cast<int>(c)] = components[c];
    return glm::clamp(color, 0.0, kLargest);
}

double largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

// Of a reflectance at normal incidence.
double iorOf(double reflectance) {
    const double root = std::sqrt(share(reflectance));
    return root < 1 ? std::min((1 + root) / (1 - root), kLargestIor) : kLargestIor;
}

MaterialDesc principled() {
    MaterialDesc material;
    material.kind = MaterialKind::Principled;
    material.sides = Sides::Both;
    return material;
}

// As files say that we have written.
bool emitsFromFront(const tinygltf::Material& source) {
    const tinygltf::Value* sides = member(source.extras, kGltfEmittingSides);
    return sides != nullptr && sides->IsString() && sides->Get<std::string>() == kGltfFront;
}

} // namespace

GltfMaterials::GltfMaterials(const GltfFile& file, SceneDesc& scene)
    : file_(file), scene_(scene), textures_(file, scene, names_) {
    for (std::size_t i = 0; i < file.model.materials.size(); ++i) add(i);
    textures_.addNotices();
}

void GltfMaterials::add(std::size_t index) {
    const tinygltf::Material& source = file_.model.materials[index];
    textures_.begin(index);
    const bool isUnlit = extension(source.extensions, "KHR_materials_unlit") != nullptr;
    const bool isOpaque = source.alphaMode != "MASK" && source.alphaMode != "BLEND";
    MaterialDesc material = isUnlit ? unlit(source) : lit(source);
    if (source.alphaMode == "MASK") material.principled.alphaCutoff = std::clamp(source.alphaCutoff, 0.0, kLargest);
    Use use{names_.unique(source.name, "material", index), isOpaque, isUnlit, std::nullopt, false};
    const PrincipledDesc& made = material.principled;
    use.isStretched = made.anisotropy.factor > 0;
    if (use.isStretched) use.tangentSet = 0;
    // The last outweighs the others.
    for (const std::string& map : {made.anisotropyTexture, made.clearcoatNormalTexture, made.normalTexture})
        if (!map.empty()) use.tangentSet = std::get<ImageTexture>(scene_.textures.at(map)).uvSet;
    scene_.materials[use.name] = std::move(material);
    uses_.push_back(std::move(use));
}

// Shows its base colour whatever light there is: black, and emitting it.
MaterialDesc GltfMaterials::unlit(const tinygltf::Material& source) {
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    MaterialDesc material = principled();
    material.albedo = glm::dvec3(0);
    material.principled.specular.factor = 0;
    material.principled.emitsColors = true;
    material.emission = colorOf(pbr.baseColorFactor, 1);
    material.emissionTexture = textures_.texture(GltfSlot(pbr.baseColorTexture), ColorSpace::Srgb, glm::dvec3(1));
    if (source.alphaMode == "MASK" || source.alphaMode == "BLEND")
        setOpacity(pbr.baseColorFactor.size() > 3 ? pbr.baseColorFactor[3] : 1, material.emissionTexture, material);
    return material;
}

MaterialDesc GltfMaterials::lit(const tinygltf::Material& source) {
    MaterialDesc material = principled();
    PrincipledDesc& p = material.principled;
    const auto* gloss = extension(source.extensions, "KHR_materials_pbrSpecularGlossiness");
    const double opacity = gloss ? addSpecularGlossiness(*gloss, material) : addMetallicRoughness(source, material);
    if (source.alphaMode == "MASK" || source.alphaMode == "BLEND") {
        const auto* texture = std::get_if<std::string>(&material.albedo);
        setOpacity(opacity, texture ? *texture : std::string(), material);
    }
    p.normalTexture = textures_.texture(GltfSlot(source.normalTexture), ColorSpace::Linear, glm::dvec3(1));
    p.normalScale = std::clamp(source.normalTexture.scale, -kLargest, kLargest);
    if (source.occlusionTexture.index >= 0)
        textures_.leaveOut("the occlusion map, which is no property of the surface,");
    material.emission = colorOf(source.emissiveFactor, 0);
    if (const auto* strength = extension(source.extensions, "KHR_materials_emissive_strength"))
        material.emission = glm::clamp(material.emission * numberOf(*strength, "emissiveStrength", 1), 0.0, kLargest);
    if (emitsFromFront(source)) material.sides = Sides::Front;
    if (material.emission != glm::dvec3(0))
        material.emissionTexture = textures_.texture(GltfSlot(source.emissiveTexture), ColorSpace::Srgb, glm::dvec3(1));
    if (const auto* coat = extension(source.extensions, "KHR_materials_clearcoat")) addClearcoat(*coat, p);
    if (const auto* sheen = extension(source.extensions, "KHR_materials_sheen")) {
        p.sheenColor = textures_.color(vectorOf(*sheen, "sheenColorFactor", 0), GltfSlot(*sheen, "sheenColorTexture"));
        p.sheenRoughness = textures_.number(numberOf(*sheen, "sheenRoughnessFactor", 0),
                                            GltfSlot(*sheen, "sheenRoughnessTexture"), Channel::Alpha);
    }
    if (const auto* anisotropy = extension(source.extensions, "KHR_materials_anisotropy"))
        addAnisotropy(*anisotropy, p);
    const auto* iridescence = extension(source.extensions, "KHR_materials_iridescence");
    if (iridescence && !gloss) addIridescence(*iridescence, p);
    if (!gloss) addDielectric(source.extensions, p); // the two say otherwise what reflects
    return material;
}

void GltfMaterials::setOpacity(double factor, const std::string& texture, MaterialDesc& material) {
    material.principled.opacity = {share(factor), texture, texture.empty() ? Channel::Red : Channel::Alpha};
}

// Returns the opacity of the base colour.
double GltfMaterials::addMetallicRoughness(const tinygltf::Material& source, MaterialDesc& material) {
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    const GltfSlot surface(pbr.metallicRoughnessTexture);
    material.albedo = textures_.color(colorOf(pbr.baseColorFactor, 1), GltfSlot(pbr.baseColorTexture));
    material.principled.metallic = textures_.number(pbr.metallicFactor, surface, Channel::Blue);
    material.principled.roughness = textures_.number(pbr.roughnessFactor, surface, Channel::Green);
    return pbr.baseColorFactor.size() > 3 ? pbr.baseColorFactor[3] : 1;
}

// A dielectric that could reflect everything, tinted by the specular colour; what it leaves is diffuse. Returns the
// opacity of the diffuse colour.
double GltfMaterials::addSpecularGlossiness(const tinygltf::Value& source, MaterialDesc& material) {
    PrincipledDesc& p = material.principled;
    material.albedo = textures_.color(vectorOf(source, "diffuseFactor", 1), GltfSlot(source, "diffuseTexture"));
    p.ior = kLargestIor;
    p.specularColor =
        textures_.color(vectorOf(source, "specularFactor", 1), GltfSlot(source, "specularGlossinessTexture"));
    const double gloss = share(numberOf(source, "glossinessFactor", 1));
    const auto* texture = std::get_if<std::string>(&p.specularColor);
    if (texture && gloss > 0)
        p.roughness = {-gloss, *texture, Channel::Alpha};
    else
        p.roughness.factor = 1 - gloss;
    return component(source, "diffuseFactor", 3, 1);
}

void GltfMaterials::addClearcoat(const tinygltf::Value& coat, PrincipledDesc& p) {
    p.clearcoat =
        textures_.number(numberOf(coat, "clearcoatFactor", 0), GltfSlot(coat, "clearcoatTexture"), Channel::Red);
    p.clearcoatRoughness = textures_.number(numberOf(coat, "clearcoatRoughnessFactor", 0),
                                            GltfSlot(coat, "clearcoatRoughnessTexture"), Channel::Green);
    p.clearcoatNormalTexture =
        textures_.texture(GltfSlot(coat, "clearcoatNormalTexture"), ColorSpace::Linear, glm::dvec3(1));
    if (const tinygltf::Value* info = member(coat, "clearcoatNormalTexture"))
        p.clearcoatNormalScale = std::clamp(numberOf(*info, "scale", 1), -kLargest, kLargest);
}

void GltfMaterials::addAnisotropy(const tinygltf::Value& anisotropy, PrincipledDesc& p) {
    const GltfSlot slot(anisotropy, "anisotropyTexture");
    p.anisotropy = textures_.number(numberOf(anisotropy, "anisotropyStrength", 0), slot, Channel::Blue);
    if (p.anisotropy.factor == 0) return;
    p.anisotropyRotation = std::clamp(numberOf(anisotropy, "anisotropyRotation", 0), -kLargest, kLargest);
    p.anisotropyTexture = p.anisotropy.texture;
}

void GltfMaterials::addIridescence(const tinygltf::Value& iridescence, PrincipledDesc& p) {
    p.iridescence = textures_.number(numberOf(iridescence, "iridescenceFactor", 0),
                                     GltfSlot(iridescence, "iridescenceTexture"), Channel::Red);
    if (p.iridescence.factor == 0) return;
    p.iridescenceThickness = textures_.number(1, GltfSlot(iridescence, "iridescenceThicknessTexture"), Channel::Green);
    p.iridescenceIor = std::clamp(numberOf(iridescence, "iridescenceIor", 1.3), 1.0, kLargestFilmIor);
    p.iridescenceThicknessMinimum =
        std::clamp(numberOf(iridescence, "iridescenceThicknessMinimum", 100), 0.0, kLargest);
    p.iridescenceThicknessMaximum =
        std::clamp(numberOf(iridescence, "iridescenceThicknessMaximum", 400), 0.0, kLargest);
}

void GltfMaterials::addDielectric(const tinygltf::ExtensionMap& extensions, PrincipledDesc& p) {
    if (const auto* ior = extension(extensions, "KHR_materials_ior")) {
        const double stated = numberOf(*ior, "ior", 1.5);
        if (stated == 0) // by the extension: all reflects
            p.ior = kLargestIor;
        else if (stated < 1)
            textures_.leaveOut("an index of refraction below 1");
        else
            p.ior = std::min(stated, kLargestIor);
    }
    if (const auto* transmission = extension(extensions, "KHR_materials_transmission")) {
        p.transmission = textures_.number(numberOf(*transmission, "transmissionFactor", 0),
                                          GltfSlot(*transmission, "transmissionTexture"), Channel::Red);
        p.isThin = true; // unless it has a volume
    }
    if (const auto* dispersion = extension(extensions, "KHR_materials_dispersion"))
        p.dispersion = std::clamp(numberOf(*dispersion, "dispersion", 0), 0.0, kLargest);
    if (const auto* diffuse = extension(extensions, "KHR_materials_diffuse_transmission")) {
        p.diffuseTransmission = textures_.number(numberOf(*diffuse, "diffuseTransmissionFactor", 0),
                                                 GltfSlot(*diffuse, "diffuseTransmissionTexture"), Channel::Alpha);
        p.diffuseTransmissionColor = textures_.color(vectorOf(*diffuse, "diffuseTransmissionColorFactor", 1),
                                                     GltfSlot(*diffuse, "diffuseTransmissionColorTexture"));
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
    if (const auto* specular = extension(extensions, "KHR_materials_specular")) addSpecular(*specular, p);
}

// Its colour has no upper limit, but what it makes of the reflectance at normal incidence has: 1. Colours here end at
// 1, so that the index of refraction takes over what is above, where nothing is refracted.
void GltfMaterials::addSpecular(const tinygltf::Value& specular, PrincipledDesc& p) {
    p.specular = textures_.number(numberOf(specular, "specularFactor", 1), GltfSlot(specular, "specularTexture"),
                                  Channel::Alpha);
    const GltfSlot slot(specular, "specularColorTexture");
    glm::dvec3 tint = glm::clamp(vectorOf(specular, "specularColorFactor", 1), 0.0, kLargest);
    const double max = largest(tint), reflectance = reflectanceOfIor(p.ior);
    if (max > 1 && p.transmission.factor > 0) {
        textures_.leaveOut("what exceeds 1 in the specular colour of glass");
    } else if (max > 1 && reflectance > 0) {
        if (slot.index < 0) tint = glm::min(tint, 1 / reflectance);
        p.ior = std::max(p.ior, iorOf(largest(tint) * reflectance));
        tint /= largest(tint);
    }
    p.specularColor = textures_.color(tint, slot);
}

const GltfMaterials::Use& GltfMaterials::use(int material) {
    if (material >= 0) return uses_[static_cast<std::size_t>(material)];
    if (!plain_) { // 3.9.1 of the specification: that of an empty material
        plain_ = Use{names_.unique("default", "material", 0), true, false, std::nullopt, false};
        MaterialDesc desc = principled();
        desc.principled.metallic.factor = desc.principled.roughness.factor = 1;
        scene_.materials[plain_->name] = desc;
    }
    return *plain_;
}

} // namespace rt::scene
