// Reading of scene files: textures and materials.
#include <algorithm>

#include "Common/Scene/Builtin/StandIns.h"
#include "Common/Scene/Json/SceneReader.h"
#include "Common/Scene/MaterialTypes.h"

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
    std::vector<std::string> names;
    for (const MaterialType& type : materialTypes()) names.emplace_back(type.name);
    const std::string name = readChoice(node.at("type"), names);
    const MaterialType& type =
        *std::ranges::find_if(materialTypes(), [&](const MaterialType& t) { return name == t.name; });
    std::vector<const char*> keys = {"type"};
    for (const MaterialParameter& parameter : type.parameters) keys.push_back(parameter.name);
    keys.insert(keys.end(), {"emission", "emission_texture", "sides"});
    node.expectKeys(keys);

    MaterialDesc material;
    material.kind = type.kind;
    const MaterialParameter* color = colorOf(type);
    if (color && (color->isRequired || node.has(color->name)))
        material.albedo = references.colorOrTexture(node.at(color->name));
    forEachNumber(type, [&](const MaterialParameter& parameter, std::size_t i) {
        if (parameter.isRequired || node.has(parameter.name))
            material.parameters[i] = node.at(parameter.name).within(parameter.least, parameter.most);
    });
    if (!type.scatters || node.has("emission")) material.emission = node.at("emission").vectorWithin(0, kLargest);
    if (const auto texture = node.find("emission_texture"))
        material.emissionTexture = references.name(*texture, "textures");
    if (const auto sides = node.find("sides"))
        material.sides = sides->oneOf({"front", "both"}) == "front" ? Sides::Front : Sides::Both;
    return material;
}

} // namespace rt::scene
