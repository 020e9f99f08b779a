#include "Common/Scene/Obj/MtlMaterials.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Obj/ObjText.h"

namespace rt::scene {

namespace {

namespace fs = std::filesystem;

constexpr double kUsualIor = 1.5;         // where a file says none, or the index of a vacuum
constexpr double kLargestIor = 10;        // of principled materials
constexpr double kUsualRoughness = 0.5;   // of the PBR extension
constexpr double kSheenRoughness = 0.5;   // which the PBR extension does not have
constexpr double kLargestExponent = 1000; // of the format

double fraction(double value) {
    return std::clamp(value, 0.0, 1.0);
}

double maxComponent(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

glm::dvec3 colorOf(const std::optional<glm::dvec3>& stated, const glm::dvec3& usual) {
    return glm::clamp(stated.value_or(usual), 0.0, 1.0);
}

// ---- what a material says ------------------------------------------------------------------------------------------

// The reflection models of the format's specification that are not diffuse.
bool isGlass(const MtlMaterial& m) {
    const int model = m.illumination.value_or(0);
    return model == 4 || model == 6 || model == 7 || model == 9;
}
bool isMirror(const MtlMaterial& m) {
    const int model = m.illumination.value_or(0);
    return model == 3 || model == 5 || model == 8;
}

bool saysMetallic(const MtlMaterial& m) {
    return m.metallic || m.metallicMap;
}
bool isLayered(const MtlMaterial& m) {
    return m.sheen.value_or(0) > 0 || m.sheenMap || m.clearcoat.value_or(0) > 0;
}
bool isBumpy(const MtlMaterial& m) {
    return m.normalMap || m.bumpMap;
}
bool isSeeThrough(const MtlMaterial& m) {
    return m.opacity.value_or(1) < 1 || m.opacityMap;
}
bool usesPbr(const MtlMaterial& m) {
    return saysMetallic(m) || m.roughness || m.roughnessMap || isLayered(m);
}
bool isShiny(const MtlMaterial& m) {
    constexpr int kDiffuse = 1; // diffuse and ambient alone
    return m.specular && maxComponent(*m.specular) > 0 && m.illumination.value_or(0) != kDiffuse;
}

// ---- the reflection of dielectrics ---------------------------------------------------------------------------------

double iorOf(const MtlMaterial& m) {
    return m.ior.value_or(1) > 1 ? std::min(*m.ior, kLargestIor) : kUsualIor;
}

// Index with `times` the reflectance at normal incidence of another.
double scaledIor(double ior, double times) {
    const double amplitude = std::sqrt(times) * (ior - 1) / (ior + 1);
    return amplitude < 1 ? std::min((1 + amplitude) / (1 - amplitude), kLargestIor) : kLargestIor;
}

} // namespace

// ---- colours of vertices -------------------------------------------------------------------------------------------

bool takesVertexColors(const MaterialDesc& material) {
    return material.kind == MaterialKind::Lambertian || material.kind == MaterialKind::Principled;
}

MaterialDesc withVertexColors(MaterialDesc material) {
    if (material.kind == MaterialKind::Principled) return material;
    material.kind = MaterialKind::Principled;
    material.principled.specular.factor = 0;
    return material;
}

std::string MtlMaterials::addWhite() {
    const std::string key = prefix_ + names_.unique("vertex colours", "material", keys_.size());
    model_.materials[key] = withVertexColors({});
    return key;
}

// ---- textures ------------------------------------------------------------------------------------------------------

// Name of a texture of the model; empty where there is no image.
std::string MtlMaterials::texture(const MtlMap& map, const char* keyword, ColorSpace space, const glm::dvec3& tint) {
    if (!map) return {};
    fs::path path = findNamed(map.file, modelFolder_);
    if (path.empty()) path = findMoved(map.file, folder_);
    if (path.empty()) path = findMoved(map.file, modelFolder_);
    if (path.empty()) {
        missing_.insert(map.file);
        return {};
    }
    ImageTexture texture;
    texture.file = fs::absolute(path).lexically_normal().generic_string();
    texture.tint = tint;
    texture.colorSpace = space;
    texture.wrapU = texture.wrapV = map.isClamped ? Wrap::Clamp : Wrap::Repeat;
    const glm::dvec2 scale = glm::clamp(map.scale, -kLargest, kLargest);
    const glm::dvec2 offset = glm::clamp(map.offset, -kLargest, kLargest);
    texture.uvTransform = {scale.x, 0, offset.x, 0, scale.y, offset.y};
    std::string name = key_ + "/" + keyword;
    model_.textures[name] = std::move(texture);
    return name;
}

// Of a factor and the map that it multiplies. Programs that write maps often write a factor of 0 beside them.
ColorOrTexture MtlMaterials::color(const glm::dvec3& factor, const MtlMap& map, const char* keyword, ColorSpace space) {
    const glm::dvec3 tint = factor == glm::dvec3(0) ? glm::dvec3(1) : factor;
    const std::string name = texture(map, keyword, space, tint);
    if (name.empty()) return factor;
    return name;
}

NumberOrTexture MtlMaterials::number(std::optional<double> factor, double usual, const MtlMap& map,
                                     const char* keyword) {
    const std::string name = texture(map, keyword, ColorSpace::Linear, glm::dvec3(1));
    if (name.empty()) return {fraction(factor.value_or(usual)), {}, Channel::Red};
    const double scale = fraction(factor.value_or(1));
    return {scale == 0 ? 1 : scale, name, Channel::Red};
}

// ---- materials -----------------------------------------------------------------------------------------------------

void MtlMaterials::addFile(const fs::path& file) {
    const std::vector<MtlMaterial> materials = readMtl(file);
    if (materials.empty()) model_.notices.push_back(file.string() + ": there is no material in it");
    folder_ = file.parent_path();
    for (const MtlMaterial& source : materials) {
        const auto [entry, isNew] = keys_.try_emplace(source.name);
        if (isNew) entry->second = prefix_ + names_.unique(source.name, "material", keys_.size());
        key_ = entry->second;
        model_.materials[key_] = surface(source);
        const std::set<std::string> leftOut(source.leftOut.begin(), source.leftOut.end());
        for (const std::string& what : leftOut) ++leftOut_[what];
    }
}

const std::string* MtlMaterials::find(std::string_view name) const {
    const auto found = keys_.find(name);
    return found == keys_.end() ? nullptr : &found->second;
}

void MtlMaterials::appendNotices() {
    if (!missing_.empty())
        model_.notices.push_back("images that do not exist are left out of materials: " + listed(missing_));
    for (const auto& [what, count] : leftOut_)
        model_.notices.push_back(what + " of " + std::to_string(count) +
                                 (count == 1 ? " material is" : " materials are") + " left out");
}

MaterialDesc MtlMaterials::surface(const MtlMaterial& source) {
    MaterialDesc material = isGlass(source) ? glass(source) : isMirror(source) ? mirror(source) : opaque(source);
    material.emission = glm::clamp(source.emission.value_or(glm::dvec3(0)), 0.0, kLargest);
    material.emissionTexture = texture(source.emissionMap, "map_Ke", ColorSpace::Srgb, glm::dvec3(1));
    if (!material.emissionTexture.empty() && material.emission == glm::dvec3(0)) material.emission = glm::dvec3(1);
    return material;
}

MaterialDesc MtlMaterials::glass(const MtlMaterial& source) {
    MaterialDesc material;
    const glm::dvec3 filter = colorOf(source.filter, glm::dvec3(0));
    material.albedo = filter == glm::dvec3(0) ? glm::dvec3(1) : filter; // many write 0 where they mean none
    if (!(source.roughness.value_or(0) > 0 || source.roughnessMap || isBumpy(source) || isLayered(source))) {
        material.kind = MaterialKind::Dielectric;
        material.parameters[shared::kDielectricIor] =
            source.ior.value_or(1) > 1 ? std::min(*source.ior, kLargest) : kUsualIor;
        return material;
    }
    material.kind = MaterialKind::Principled;
    material.principled.transmission.factor = 1;
    material.principled.ior = iorOf(source);
    material.principled.roughness = number(source.roughness, 0, source.roughnessMap, "map_Pr");
    addLayers(source, material);
    addNormals(source, material);
    return material;
}

MaterialDesc MtlMaterials::mirror(const MtlMaterial& source) {
    if (saysMetallic(source)) return opaque(source);
    MaterialDesc material;
    const glm::dvec3 tint = colorOf(source.specular, glm::dvec3(0));
    const bool isPlain =
        !(source.specularMap || source.roughnessMap || isLayered(source) || isBumpy(source) || isSeeThrough(source));
    if (isPlain) {
        material.kind = MaterialKind::Metal;
        material.albedo = tint;
        material.parameters[shared::kMetalFuzz] = fraction(source.roughness.value_or(0));
        return material;
    }
    material.kind = MaterialKind::Principled;
    material.albedo = color(tint, source.specularMap, "map_Ks", ColorSpace::Srgb);
    material.principled.metallic.factor = 1;
    material.principled.roughness = number(source.roughness, 0, source.roughnessMap, "map_Pr");
    addLayers(source, material);
    addNormals(source, material);
    addOpacity(source, material);
    return material;
}

MaterialDesc MtlMaterials::opaque(const MtlMaterial& source) {
    MaterialDesc material;
    const bool saysColor = source.specular || source.emission || source.emissionMap;
    const glm::dvec3 usual = saysColor ? glm::dvec3(0) : std::get<glm::dvec3>(plainMaterial().albedo);
    material.albedo = color(colorOf(source.diffuse, source.diffuseMap ? glm::dvec3(1) : usual), source.diffuseMap,
                            "map_Kd", ColorSpace::Srgb);
    const bool isShinyHere = isShiny(source);
    if (!(isShinyHere || usesPbr(source) || isBumpy(source) || isSeeThrough(source))) return material;

    material.kind = MaterialKind::Principled;
    PrincipledDesc& p = material.principled;
    p.metallic = number(source.metallic, 0, source.metallicMap, "map_Pm");
    p.ior = iorOf(source);
    double roughness = usesPbr(source) ? kUsualRoughness : 1;
    if (source.exponent) roughness = 1 - std::sqrt(fraction(*source.exponent / kLargestExponent));
    p.roughness = number(source.roughness, roughness, source.roughnessMap, "map_Pr");
    if (isShinyHere) {
        const glm::dvec3 specular = colorOf(source.specular, glm::dvec3(0));
        const double twice = 2 * maxComponent(specular); // of 0.5, which the index of refraction stands for
        p.specular.factor = std::min(twice, 1.0);
        if (twice > 1) p.ior = scaledIor(p.ior, twice);
        p.specularColor = color(specular / maxComponent(specular), source.specularMap, "map_Ks", ColorSpace::Srgb);
    } else if (source.specular || !usesPbr(source)) {
        p.specular.factor = 0;
    }
    addLayers(source, material);
    addNormals(source, material);
    addOpacity(source, material);
    return material;
}

// Sheen and clear coat.
void MtlMaterials::addLayers(const MtlMaterial& source, MaterialDesc& material) {
    PrincipledDesc& p = material.principled;
    if (!isLayered(source)) return;
    p.clearcoat.factor = fraction(source.clearcoat.value_or(0));
    p.clearcoatRoughness.factor = fraction(source.clearcoatRoughness.value_or(0));
    p.sheenColor = color(glm::dvec3(fraction(source.sheen.value_or(0))), source.sheenMap, "map_Ps", ColorSpace::Linear);
    p.sheenRoughness.factor = kSheenRoughness;
}

void MtlMaterials::addNormals(const MtlMaterial& source, MaterialDesc& material) {
    constexpr double kLargestScale = 100;
    const MtlMap& map = source.normalMap ? source.normalMap : source.bumpMap;
    PrincipledDesc& p = material.principled;
    p.normalTexture = texture(map, source.normalMap ? "norm" : "map_Bump", ColorSpace::Linear, glm::dvec3(1));
    if (!p.normalTexture.empty()) p.normalScale = std::clamp(map.strength, -kLargestScale, kLargestScale);
}

void MtlMaterials::addOpacity(const MtlMaterial& source, MaterialDesc& material) {
    NumberOrTexture& opacity = material.principled.opacity;
    opacity = number(source.opacity, 1, source.opacityMap, "map_d");
    if (opacity.texture.empty()) return;
    // The map of colours again: then its opacity is meant. Other maps of opacity are grey.
    const bool isColors = source.opacityMap.file == source.diffuseMap.file;
    switch (source.opacityMap.channel) {
        case 'r':
        case 'l':
            opacity.channel = Channel::Red;
            break;
        case 'g':
            opacity.channel = Channel::Green;
            break;
        case 'b':
            opacity.channel = Channel::Blue;
            break;
        case 'm':
            opacity.channel = Channel::Alpha;
            break;
        default:
            opacity.channel = isColors ? Channel::Alpha : Channel::Red;
    }
}

} // namespace rt::scene
