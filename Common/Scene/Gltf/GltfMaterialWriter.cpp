#include "Common/Scene/Gltf/GltfMaterialWriter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Scene/AsPrincipled.h"
#include "Common/Scene/Gltf/GltfExtras.h"
#include "Common/Scene/Gltf/GltfPower.h"
#include "Common/Scene/IsAlways.h"
#include "Common/Scene/TextureNames.h"

namespace rt::scene {

namespace {

template <typename Value>
void setUnusual(OrderedJson& target, const char* key, const Value& value, const Value& usual) {
    if (value != usual) target[key] = value;
}

double clearIor(const MaterialDesc& material) {
    return material.kind == MaterialKind::Dielectric ? material.parameters[0].value_or(1.5) : 1.5;
}

// As the reader makes it of KHR_materials_unlit, whose colour ends at 1.
bool isWrittenUnlit(const MaterialDesc& material) {
    const glm::dvec3& e = material.emission;
    const PrincipledDesc& p = material.principled;
    return p.emitsColors && isAlways(material.albedo, 0) && isAlways(p.specular, 0) && isAlways(p.metallic, 0) &&
           std::max({e.x, e.y, e.z}) <= 1;
}

// As the reader makes it of KHR_materials_pbrSpecularGlossiness with a texture, whose opacity is glossiness.
bool isGlossy(const PrincipledDesc& p) {
    const auto* texture = std::get_if<std::string>(&p.specularColor);
    return texture != nullptr && p.ior == kLargestIor && p.roughness.factor < 0 && p.roughness.texture == *texture &&
           p.roughness.channel == Channel::Alpha && isAlways(p.metallic, 0) && isAlways(p.transmission, 0) &&
           isAlways(p.specular, 1) && isAlways(p.iridescence, 0) && isAlways(p.diffuseTransmission, 0);
}

} // namespace

// ---- which ---------------------------------------------------------------------------------------------------------

void GltfMaterialWriter::add(const std::map<std::string, MaterialDesc>& materials,
                             const std::map<std::string, TextureDesc>& textures) {
    more_.insert(materials.begin(), materials.end());
    textures_.add(textures);
}

const MaterialDesc& GltfMaterialWriter::find(const std::string& name) const {
    const auto own = scene_.materials.find(name);
    if (own != scene_.materials.end()) return own->second;
    const auto other = more_.find(name);
    if (other != more_.end()) return other->second;
    throw InputError(scene_.id + ": material \"" + name + "\" is not defined");
}

bool GltfMaterialWriter::isTurned(const std::string& name) const {
    return clearIor(find(name)) < 1;
}

bool GltfMaterialWriter::showsImage(const std::string& name) const {
    bool shows = false;
    forEachTextureName(find(name),
                       [&](const std::string& texture) { shows = shows || textures_.imageOf(texture) != nullptr; });
    return shows;
}

int GltfMaterialWriter::index(const std::string& name, bool blends) {
    const auto [entry, isNew] = written_.try_emplace({name, blends}, 0);
    if (!isNew) return entry->second;
    MaterialDesc material = find(name);
    if (const double ior = clearIor(material); ior < 1) material.parameters[0] = 1 / ior;
    std::vector<std::string> notices;
    material = asPrincipled(material, notices);
    for (const std::string& notice : notices) notices_.add("material", name, notice);
    OrderedJson out = {{"name", name}};
    out.update(write(material, blends));
    return entry->second = document_.add("materials", std::move(out));
}

// ---- values --------------------------------------------------------------------------------------------------------

double GltfMaterialWriter::number(const NumberOrTexture& source, Channel slot, GltfChannels& channels) {
    if (source.texture.empty()) return source.factor;
    const double least = source.factor < 0 ? 1 : 0;
    const ImageTexture* image = textures_.imageOf(source.texture);
    if (image == nullptr) {
        const glm::dvec3 color = textures_.colorOf(source.texture);
        const bool isOpacity = source.channel == Channel::Alpha;
        return least + source.factor * (isOpacity ? 1 : color[static_cast<glm::length_t>(source.channel)]);
    }
    double scale = source.factor;
    if (source.channel != Channel::Alpha) scale *= image->tint[static_cast<glm::length_t>(source.channel)];
    GltfChannel& channel = channels[static_cast<std::size_t>(slot)].emplace();
    channel = {image, source.channel, 1, 0};
    if (scale >= 0) return scale;
    channel.scale = scale;
    channel.offset = 1;
    return 1;
}

// Factor and the first three channels.
glm::dvec3 GltfMaterialWriter::color(const ColorOrTexture& source, GltfChannels& channels) {
    if (const auto* constant = std::get_if<glm::dvec3>(&source)) return *constant;
    const auto& name = std::get<std::string>(source);
    const ImageTexture* image = textures_.imageOf(name);
    if (image == nullptr) return textures_.colorOf(name);
    for (const Channel c : {Channel::Red, Channel::Green, Channel::Blue})
        channels[static_cast<std::size_t>(c)] = GltfChannel{image, c, 1, 0};
    return image->tint;
}

void GltfMaterialWriter::setTexture(OrderedJson& target, const char* texture, const GltfChannels& channels,
                                    ColorSpace space) {
    const bool hasImage = std::any_of(channels.begin(), channels.end(),
                                      [](const auto& channel) { return channel && channel->image != nullptr; });
    if (!hasImage) return;
    if (auto info = textures_.info(channels, space)) target[texture] = std::move(*info);
}

void GltfMaterialWriter::setNumber(OrderedJson& target, const char* factor, const char* texture,
                                   const NumberOrTexture& source, Channel slot, double usual) {
    GltfChannels channels;
    setUnusual(target, factor, number(source, slot, channels), usual);
    setTexture(target, texture, channels, ColorSpace::Linear);
}

void GltfMaterialWriter::setColor(OrderedJson& target, const char* factor, const char* texture,
                                  const ColorOrTexture& source, double usual) {
    GltfChannels channels;
    const glm::dvec3 value = color(source, channels);
    if (value != glm::dvec3(usual)) target[factor] = arrayOf(value);
    setTexture(target, texture, channels, ColorSpace::Srgb);
}

void GltfMaterialWriter::setNormals(OrderedJson& target, const char* texture, const std::string& name, double scale) {
    if (name.empty() || textures_.imageOf(name) == nullptr) return;
    GltfChannels channels;
    (void)color(name, channels);
    setTexture(target, texture, channels, ColorSpace::Linear);
    if (target.contains(texture) && scale != 1) target[texture]["scale"] = scale;
}

void GltfMaterialWriter::extend(OrderedJson& out, const char* extension, OrderedJson values) {
    if (values.is_null()) values = OrderedJson::object();
    document_.use(extension);
    out["extensions"][extension] = std::move(values);
}

// ---- materials -----------------------------------------------------------------------------------------------------

OrderedJson GltfMaterialWriter::write(const MaterialDesc& material, bool blends) {
    const PrincipledDesc& p = material.principled;
    const bool emits = material.emission != glm::dvec3(0);
    const bool emitsFrontOnly = emits && material.sides.value_or(Sides::Front) == Sides::Front;
    OrderedJson out = OrderedJson::object();
    if (isWrittenUnlit(material)) {
        out = writeUnlit(material);
    } else {
        writeBase(material, out);
        setNormals(out, "normalTexture", p.normalTexture, p.normalScale);
        writeEmission(material, out);
        writeLayers(p, out);
        if (isGlossy(p))
            writeGlossiness(material, out);
        else
            writeDielectric(p, out);
    }
    writeAlpha(p, blends, out);
    if (!emitsFrontOnly) out["doubleSided"] = true;
    if (emitsFrontOnly && !isWrittenUnlit(material)) out["extras"] = {{kGltfEmittingSides, kGltfFront}};
    return out;
}

OrderedJson GltfMaterialWriter::writeUnlit(const MaterialDesc& material) {
    const PrincipledDesc& p = material.principled;
    GltfChannels channels;
    glm::dvec3 factor = material.emission;
    if (!material.emissionTexture.empty()) factor *= color(material.emissionTexture, channels);
    const double opacity = number(p.opacity, Channel::Alpha, channels);
    OrderedJson pbr = OrderedJson::object();
    pbr["baseColorFactor"] = {factor.x, factor.y, factor.z, opacity};
    setTexture(pbr, "baseColorTexture", channels, ColorSpace::Srgb);
    OrderedJson out = {{"pbrMetallicRoughness", std::move(pbr)}};
    extend(out, "KHR_materials_unlit", {});
    return out;
}

void GltfMaterialWriter::writeBase(const MaterialDesc& material, OrderedJson& out) {
    const PrincipledDesc& p = material.principled;
    OrderedJson pbr = OrderedJson::object();
    GltfChannels base, surface;
    const glm::dvec3 factor = color(material.albedo, base);
    const double opacity = number(p.opacity, Channel::Alpha, base);
    if (base[3] && !base[0]) // white, of the factor's colour
        for (std::size_t c = 0; c < 3; ++c) base[c] = GltfChannel{nullptr, Channel::Red, 0, 1};
    if (factor != glm::dvec3(1) || opacity != 1) pbr["baseColorFactor"] = {factor.x, factor.y, factor.z, opacity};
    setTexture(pbr, "baseColorTexture", base, ColorSpace::Srgb);
    const double metallic = number(p.metallic, Channel::Blue, surface);
    const double roughness = isGlossy(p) ? 1 + p.roughness.factor / 2 : number(p.roughness, Channel::Green, surface);
    if (surface[1] || surface[2]) // what is constant counts alone
        for (const std::size_t c : {1, 2})
            if (!surface[c]) surface[c] = GltfChannel{nullptr, Channel::Red, 0, 1};
    setUnusual(pbr, "metallicFactor", metallic, 1.0);
    setUnusual(pbr, "roughnessFactor", roughness, 1.0);
    setTexture(pbr, "metallicRoughnessTexture", surface, ColorSpace::Linear);
    out["pbrMetallicRoughness"] = std::move(pbr);
}

void GltfMaterialWriter::writeAlpha(const PrincipledDesc& p, bool blends, OrderedJson& out) const {
    if (p.alphaCutoff) {
        out["alphaMode"] = "MASK";
        setUnusual(out, "alphaCutoff", *p.alphaCutoff, 0.5);
    } else if (blends || p.opacity != PrincipledDesc().opacity) {
        out["alphaMode"] = "BLEND";
    }
}

// The colour ends at 1, and the strength is what exceeds it.
void GltfMaterialWriter::writeEmission(const MaterialDesc& material, OrderedJson& out) {
    if (material.emission == glm::dvec3(0)) return;
    GltfChannels channels;
    glm::dvec3 emission = material.emission;
    if (!material.emissionTexture.empty()) emission *= color(material.emissionTexture, channels);
    const GltfPower power = toPower(emission, 1);
    if (material.principled.emitsColors)
        notices_.add("vertex colours multiply what a material emits, which glTF does not do: left out");
    out["emissiveFactor"] = arrayOf(power.color);
    setTexture(out, "emissiveTexture", channels, ColorSpace::Srgb);
    if (power.strength != 1) extend(out, "KHR_materials_emissive_strength", {{"emissiveStrength", power.strength}});
}

// Beside what other programs take, who do not know the extension.
void GltfMaterialWriter::writeGlossiness(const MaterialDesc& material, OrderedJson& out) {
    const PrincipledDesc& p = material.principled;
    OrderedJson gloss = OrderedJson::object();
    const OrderedJson& pbr = out["pbrMetallicRoughness"];
    if (pbr.contains("baseColorFactor")) gloss["diffuseFactor"] = pbr["baseColorFactor"];
    if (pbr.contains("baseColorTexture")) gloss["diffuseTexture"] = pbr["baseColorTexture"];
    GltfChannels channels;
    const glm::dvec3 specular = color(p.specularColor, channels);
    channels[3] = GltfChannel{channels[0] ? channels[0]->image : nullptr, Channel::Alpha, 1, 0};
    if (specular != glm::dvec3(1)) gloss["specularFactor"] = arrayOf(specular);
    setUnusual(gloss, "glossinessFactor", -p.roughness.factor, 1.0);
    setTexture(gloss, "specularGlossinessTexture", channels, ColorSpace::Srgb);
    extend(out, "KHR_materials_pbrSpecularGlossiness", std::move(gloss));
}

void GltfMaterialWriter::writeDielectric(const PrincipledDesc& p, OrderedJson& out) {
    if (p.ior != 1.5) extend(out, "KHR_materials_ior", {{"ior", p.ior >= kLargestIor ? 0 : p.ior}}); // 0: all reflects
    if (!isAlways(p.specular, 1) || !isAlways(p.specularColor, 1)) {
        OrderedJson values;
        setNumber(values, "specularFactor", "specularTexture", p.specular, Channel::Alpha, 1);
        setColor(values, "specularColorFactor", "specularColorTexture", p.specularColor, 1);
        extend(out, "KHR_materials_specular", std::move(values));
    }
    writeTransmission(p, out);
    writeIridescence(p, out);
}

void GltfMaterialWriter::writeTransmission(const PrincipledDesc& p, OrderedJson& out) {
    const bool transmits = !isAlways(p.transmission, 0);
    if (transmits || p.isThin) {
        OrderedJson values = {{"transmissionFactor", 0}};
        setNumber(values, "transmissionFactor", "transmissionTexture", p.transmission, Channel::Red, 0);
        extend(out, "KHR_materials_transmission", std::move(values));
    }
    const bool absorbs = p.attenuationDistance || p.attenuationColor != glm::dvec3(1);
    if (!p.isThin && (transmits || absorbs)) {
        OrderedJson values = {{"thicknessFactor", 1}}; // of programs that do not follow light through the mesh
        if (p.attenuationDistance) values["attenuationDistance"] = *p.attenuationDistance;
        if (p.attenuationColor != glm::dvec3(1)) values["attenuationColor"] = arrayOf(p.attenuationColor);
        extend(out, "KHR_materials_volume", std::move(values));
    }
    if (p.dispersion != 0) extend(out, "KHR_materials_dispersion", {{"dispersion", p.dispersion}});
    if (!isAlways(p.diffuseTransmission, 0)) {
        OrderedJson values;
        setNumber(values, "diffuseTransmissionFactor", "diffuseTransmissionTexture", p.diffuseTransmission,
                  Channel::Alpha, 0);
        setColor(values, "diffuseTransmissionColorFactor", "diffuseTransmissionColorTexture",
                 p.diffuseTransmissionColor, 1);
        extend(out, "KHR_materials_diffuse_transmission", std::move(values));
    }
}

void GltfMaterialWriter::writeLayers(const PrincipledDesc& p, OrderedJson& out) {
    if (!isAlways(p.clearcoat, 0)) {
        OrderedJson values;
        setNumber(values, "clearcoatFactor", "clearcoatTexture", p.clearcoat, Channel::Red, 0);
        setNumber(values, "clearcoatRoughnessFactor", "clearcoatRoughnessTexture", p.clearcoatRoughness, Channel::Green,
                  0);
        setNormals(values, "clearcoatNormalTexture", p.clearcoatNormalTexture, p.clearcoatNormalScale);
        extend(out, "KHR_materials_clearcoat", std::move(values));
    }
    if (!isAlways(p.sheenColor, 0)) {
        OrderedJson values;
        setColor(values, "sheenColorFactor", "sheenColorTexture", p.sheenColor, 0);
        setNumber(values, "sheenRoughnessFactor", "sheenRoughnessTexture", p.sheenRoughness, Channel::Alpha, 0);
        extend(out, "KHR_materials_sheen", std::move(values));
    }
    writeAnisotropy(p, out);
}

// Strength and direction are channels of one image; a direction along the tangent is (1, 1/2).
void GltfMaterialWriter::writeAnisotropy(const PrincipledDesc& p, OrderedJson& out) {
    if (isAlways(p.anisotropy, 0)) return;
    OrderedJson values;
    GltfChannels channels;
    setUnusual(values, "anisotropyStrength", number(p.anisotropy, Channel::Blue, channels), 0.0);
    setUnusual(values, "anisotropyRotation", p.anisotropyRotation, 0.0);
    const ImageTexture* direction = p.anisotropyTexture.empty() ? nullptr : textures_.imageOf(p.anisotropyTexture);
    if (direction != nullptr || channels[2]) {
        channels[0] = GltfChannel{direction, Channel::Red, 1, direction != nullptr ? 0.0 : 1.0};
        channels[1] = GltfChannel{direction, Channel::Green, 1, direction != nullptr ? 0.0 : 0.5};
        if (!channels[2]) channels[2] = GltfChannel{nullptr, Channel::Blue, 0, 1};
    }
    setTexture(values, "anisotropyTexture", channels, ColorSpace::Linear);
    extend(out, "KHR_materials_anisotropy", std::move(values));
}

// The thickness has no factor in glTF: it is between two others.
void GltfMaterialWriter::writeIridescence(const PrincipledDesc& p, OrderedJson& out) {
    if (isAlways(p.iridescence, 0)) return;
    OrderedJson values;
    setNumber(values, "iridescenceFactor", "iridescenceTexture", p.iridescence, Channel::Red, 0);
    setUnusual(values, "iridescenceIor", p.iridescenceIor, 1.3);
    const double least = p.iridescenceThicknessMinimum, range = p.iridescenceThicknessMaximum - least;
    NumberOrTexture share = p.iridescenceThickness;
    const double start = share.factor < 0 ? 1 : 0, factor = share.factor;
    share.factor = 1;
    GltfChannels channels;
    const double scale = number(share, Channel::Green, channels);
    const bool isWhole = start == 0 && factor * scale == 1;
    setUnusual(values, "iridescenceThicknessMinimum", least + start * range, 100.0);
    setUnusual(values, "iridescenceThicknessMaximum",
               isWhole ? p.iridescenceThicknessMaximum : least + (start + factor * scale) * range, 400.0);
    setTexture(values, "iridescenceThicknessTexture", channels, ColorSpace::Linear);
    extend(out, "KHR_materials_iridescence", std::move(values));
}

} // namespace rt::scene
