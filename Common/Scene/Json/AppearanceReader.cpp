// Reading of scene files: textures and materials.

#include "Common/Scene/Builtin/StandIns.h"
#include "Common/Scene/Json/SceneReader.h"

namespace rt::scene {

namespace {

NoiseTexture readNoise(const JsonNode& node) {
    node.expectKeys({"type", "kind", "scale", "frequency", "tint", "seed"});
    NoiseTexture noise;
    const std::string kind = node.at("kind").oneOf({"marble", "turbulence", "smooth"});
    if (kind == "turbulence") noise.kind = NoiseKind::Turbulence;
    if (kind == "smooth") noise.kind = NoiseKind::Smooth;
    if (const auto value = node.find("scale")) noise.scale = value->positive();
    if (const auto value = node.find("frequency")) noise.frequency = value->number();
    if (const auto value = node.find("tint")) noise.tint = value->vectorWithin(0, 1);
    if (const auto value = node.find("seed")) noise.seed = value->unsignedInteger();
    return noise;
}

ImageTexture readImage(const JsonNode& node, const SceneReferences& references) {
    node.expectKeys({"type", "file", "stand_in", "tint"});
    ImageTexture image;
    if (const auto standIn = node.find("stand_in")) image.standIn = readChoice(*standIn, planetMapNames());
    image.file = references.file(node.at("file"), !image.standIn.empty());
    if (const auto tint = node.find("tint")) image.tint = tint->vectorWithin(0, 1);
    return image;
}

// The keys that only this kind of material has, and a check for unknown ones.
MaterialDesc readKind(const JsonNode& node) {
    MaterialDesc material;
    const std::string type = node.at("type").oneOf({"lambertian", "metal", "dielectric", "emitter"});
    if (type == "lambertian") {
        node.expectKeys({"type", "albedo", "emission", "emission_texture", "sides"});
    } else if (type == "metal") {
        node.expectKeys({"type", "albedo", "fuzz", "emission", "emission_texture", "sides"});
        material.kind = MaterialKind::Metal;
        if (const auto fuzz = node.find("fuzz")) material.fuzz = fuzz->within(0, 1);
    } else if (type == "dielectric") {
        node.expectKeys({"type", "albedo", "ior", "emission", "emission_texture", "sides"});
        material.kind = MaterialKind::Dielectric;
        material.ior = node.at("ior").positive();
    } else {
        node.expectKeys({"type", "emission", "emission_texture", "sides"});
        material.kind = MaterialKind::Emitter;
    }
    return material;
}

} // namespace

TextureDesc readTexture(const JsonNode& node, const SceneReferences& references) {
    const std::string type = node.at("type").oneOf({"solid", "checker", "noise", "image"});
    if (type == "noise") return readNoise(node);
    if (type == "image") return readImage(node, references);
    if (type == "solid") {
        node.expectKeys({"type", "color"});
        return SolidTexture{node.at("color").vectorWithin(0, 1)};
    }
    node.expectKeys({"type", "scale", "even", "odd"});
    return CheckerTexture{node.at("scale").positive(), references.colorOrTexture(node.at("even")),
                          references.colorOrTexture(node.at("odd"))};
}

MaterialDesc readMaterial(const JsonNode& node, const SceneReferences& references) {
    MaterialDesc material = readKind(node);
    const bool needsAlbedo = material.kind == MaterialKind::Lambertian || material.kind == MaterialKind::Metal;
    if (needsAlbedo || node.has("albedo")) material.albedo = references.colorOrTexture(node.at("albedo"));
    if (material.kind == MaterialKind::Emitter || node.has("emission"))
        material.emission = node.at("emission").vectorWithin(0, kLargest);
    if (const auto texture = node.find("emission_texture"))
        material.emissionTexture = references.name(*texture, "textures");
    if (const auto sides = node.find("sides"))
        material.sides = sides->oneOf({"front", "both"}) == "front" ? Sides::Front : Sides::Both;
    return material;
}

} // namespace rt::scene
