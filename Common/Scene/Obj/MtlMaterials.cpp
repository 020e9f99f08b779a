#include "Common/Scene/Obj/MtlMaterials.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <glm/common.hpp>

#include "Common/Scene/Compiler/MaterialTable.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Obj/MtlModels.h"
#include "Common/Scene/Obj/ObjText.h"
#include "Common/Scene/Reflectance.h"

namespace rt::scene {

namespace {

namespace fs = std::filesystem;

constexpr double kUsualIor = 1.5;         // where a file says none, or the index of a vacuum
constexpr double kLargestCoatIor = 10;    // a stronger reflection is a mirror
constexpr double kUsualRoughness = 0.5;   // of the PBR extension
constexpr double kSheenRoughness = 0.5;   // which the PBR extension does not have
constexpr double kLargestExponent = 1000; // of the format

double fraction(double value) {
    return std::clamp(value, 0.0, 1.0);
}

// ---- the reflection of dielectrics ---------------------------------------------------------------------------------

double iorOf(const MtlMaterial& m) {
    return m.ior.value_or(1) > 1 ? std::min(*m.ior, kLargestCoatIor) : kUsualIor;
}

double iorOfReflectance(double reflectance) {
    const double amplitude = std::sqrt(reflectance);
    return amplitude < 1 ? std::min((1 + amplitude) / (1 - amplitude), kLargestCoatIor) : kLargestCoatIor;
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

const std::string& MtlMaterials::white() {
    if (white_.empty()) {
        white_ = prefix_ + names_.unique("vertex colours", "material", keys_.size());
        model_.materials[white_] = withVertexColors({});
    }
    return white_;
}

// ---- textures ------------------------------------------------------------------------------------------------------

// Name of a texture of the model; empty where there is no image.
std::string MtlMaterials::texture(const MtlMap& map, const char* keyword, ColorSpace space, const glm::dvec3& tint) {
    if (!map) return {};
    fs::path path = files_.find(map.file, modelFolder_);
    if (path.empty()) path = files_.findMoved(map.file, folder_);
    if (path.empty()) path = files_.findMoved(map.file, modelFolder_);
    if (path.empty()) {
        missing_.emplace(withoutComment(map.file));
        return {};
    }
    ImageTexture texture;
    texture.file = fs::absolute(path).lexically_normal().generic_string();
    texture.standIn = kWhiteStandIn;
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
    const std::vector<MtlMaterial> materials = readMtl(file, model_.notices);
    if (materials.empty()) model_.notices.push_back(file.string() + ": there is no material in it");
    folder_ = file.parent_path();
    for (const MtlMaterial& source : materials) {
        const auto [entry, isNew] = keys_.try_emplace(source.name);
        if (isNew) entry->second = prefix_ + names_.unique(source.name, "material", keys_.size());
        key_ = entry->second;
        if (const std::string_view bare = withoutComment(source.name); !bare.empty()) bareKeys_.emplace(bare, key_);
        lowerKeys_.emplace(lowerCase(source.name), key_);
        model_.materials[key_] = surface(source);
        sources_[key_] = source;
    }
}

const std::string* MtlMaterials::find(const std::string& name) {
    const auto use = [this](const std::string& key) { return &*used_.insert(key).first; };
    if (const auto found = keys_.find(name); found != keys_.end()) return use(found->second);
    const std::string bare(withoutComment(name));
    const auto& others = bare == name ? bareKeys_ : keys_;
    if (const auto found = others.find(bare); found != others.end()) return use(found->second);
    for (const std::string& meant : {name, bare})
        if (const auto found = lowerKeys_.find(lowerCase(meant)); found != lowerKeys_.end()) {
            inOtherCase_.insert(meant);
            return use(found->second);
        }
    return nullptr;
}

const std::string& MtlMaterials::withoutMaps(const std::string& key) {
    const auto [entry, isNew] = withoutMaps_.try_emplace(key, key);
    const auto source = sources_.find(key);
    if (!isNew || source == sources_.end()) return entry->second;
    bool hasTextures = false;
    forEachTexture(model_.materials.at(key), [&](const std::string&) { hasTextures = true; });
    if (!hasTextures) return entry->second;
    key_ = prefix_ + names_.unique(key.substr(prefix_.size()) + " without images", "material", keys_.size());
    entry->second = key_;
    model_.materials[key_] = surface(bareOf(source->second));
    return entry->second;
}

void MtlMaterials::appendNotices() {
    if (!missing_.empty())
        model_.notices.push_back("images that do not exist are left out of materials: " + listed(missing_));
    std::map<std::string, std::size_t> leftOut; // materials, by what
    std::set<std::string> invisible;
    for (const std::string& key : used_) {
        const MtlMaterial& source = sources_.at(key);
        const MaterialDesc& made = model_.materials.at(key);
        std::set<std::string> lost(source.leftOut.begin(), source.leftOut.end());
        if (isFiltered(source) && !isGlass(source)) lost.insert("the colour of what passes through (Tf)");
        for (const std::string& what : lost) ++leftOut[what];
        if (made.kind == MaterialKind::Principled && made.principled.opacity.factor == 0) invisible.insert(source.name);
    }
    for (const auto& [what, count] : leftOut)
        model_.notices.push_back(what + " of " + counted(count, "material is", "materials are") + " left out");
    if (!invisible.empty())
        model_.notices.push_back("materials that nothing is seen of, as d is 0 or Tr 1: " + listed(invisible));
    if (!inOtherCase_.empty())
        model_.notices.push_back("materials that are named in other case: " + listed(inOtherCase_));
}

MaterialDesc MtlMaterials::surface(const MtlMaterial& source) {
    unlit_.erase(key_);
    if (saysUnlit(source)) return unlit(source);
    MaterialDesc material = isGlass(source) ? glass(source) : isMirror(source) ? mirror(source) : opaque(source);
    material.emission = glm::clamp(source.emission.value_or(glm::dvec3(0)), 0.0, kLargest);
    material.emissionTexture = texture(source.emissionMap, "map_Ke", ColorSpace::Srgb, glm::dvec3(1));
    if (!material.emissionTexture.empty() && material.emission == glm::dvec3(0)) material.emission = glm::dvec3(1);
    return material;
}

// As bright as Kd, times the colours of vertices, whatever light there is: black, and emitting it.
MaterialDesc MtlMaterials::unlit(const MtlMaterial& source) {
    unlit_.insert(key_);
    MaterialDesc material;
    material.kind = MaterialKind::Principled;
    material.sides = Sides::Both;
    material.albedo = glm::dvec3(0);
    material.principled.specular.factor = 0;
    material.principled.emitsColors = true;
    material.emissionTexture = texture(source.diffuseMap, "map_Kd", ColorSpace::Srgb, glm::dvec3(1));
    const bool hasMap = !material.emissionTexture.empty();
    material.emission = colorOf(source.diffuse, hasMap ? glm::dvec3(1) : std::get<glm::dvec3>(plainMaterial().albedo));
    if (hasMap && material.emission == glm::dvec3(0)) material.emission = glm::dvec3(1);
    addOpacity(source, material);
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
    const glm::dvec3 tint = specularOf(source);
    if (hasDiffuse(source) && maxComponent(tint) <= reflectanceOfIor(kLargestCoatIor)) return coated(source);
    MaterialDesc material;
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

// What Kd says under a mirror that reflects Ks at normal incidence.
MaterialDesc MtlMaterials::coated(const MtlMaterial& source) {
    MaterialDesc material;
    material.kind = MaterialKind::Principled;
    material.albedo = diffuse(source);
    PrincipledDesc& p = material.principled;
    const glm::dvec3 specular = specularOf(source);
    p.ior = iorOfReflectance(maxComponent(specular));
    p.specularColor = color(specular / maxComponent(specular), source.specularMap, "map_Ks", ColorSpace::Srgb);
    p.roughness = number(source.roughness, 0, source.roughnessMap, "map_Pr");
    addLayers(source, material);
    addNormals(source, material);
    addOpacity(source, material);
    return material;
}

// Kd, or what is usual where a material says none.
ColorOrTexture MtlMaterials::diffuse(const MtlMaterial& source) {
    const bool saysColor = source.specular || source.emission || source.emissionMap;
    const glm::dvec3 usual = saysColor ? glm::dvec3(0) : std::get<glm::dvec3>(plainMaterial().albedo);
    return color(colorOf(source.diffuse, source.diffuseMap ? glm::dvec3(1) : usual), source.diffuseMap, "map_Kd",
                 ColorSpace::Srgb);
}

MaterialDesc MtlMaterials::opaque(const MtlMaterial& source) {
    MaterialDesc material;
    material.albedo = diffuse(source);
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
        const glm::dvec3 specular = specularOf(source);
        const double twice = 2 * maxComponent(specular); // of 0.5, which the index of refraction stands for
        p.specular.factor = std::min(twice, 1.0);
        if (twice > 1) p.ior = iorOfReflectance(twice * reflectanceOfIor(p.ior));
        p.specularColor = color(specular / maxComponent(specular), source.specularMap, "map_Ks", ColorSpace::Srgb);
    } else if (source.specular || !usesPbr(source) || hasNoHighlight(source)) {
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
    const bool isColors = withoutComment(source.opacityMap.file) == withoutComment(source.diffuseMap.file);
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
