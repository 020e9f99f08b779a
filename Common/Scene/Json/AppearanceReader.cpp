// Reading of scene files: textures and materials.
#include <algorithm>

#include "Common/Scene/Json/SceneReader.h"
#include "Common/Scene/Json/TextureTypes.h"
#include "Common/Scene/MaterialTypes.h"

namespace rt::scene {

namespace {

// Reads the parameters of one texture.
class ParameterReader {
  public:
    ParameterReader(const JsonNode& texture, const SceneReferences& references)
        : texture_(texture), references_(references) {}

    void read(const TextureParameter& p, double& value) const { value = at(p).within(p.least, p.most); }
    void read(const TextureParameter& p, std::uint32_t& value) const { value = at(p).unsignedInteger(); }
    void read(const TextureParameter& p, glm::dvec3& value) const { value = at(p).vectorWithin(0, 1); }
    void read(const TextureParameter& p, ColorOrTexture& value) const { value = references_.colorOrTexture(at(p)); }
    void read(const TextureParameter& p, std::string& value) const {
        value = p.choices ? readChoice(at(p), p.choices()) : references_.file(at(p), texture_.has("stand_in"));
    }
    void read(const TextureParameter& p, NoiseKind& value) const {
        const auto& names = p.choices();
        value = static_cast<NoiseKind>(std::ranges::find(names, readChoice(at(p), names)) - names.begin());
    }

  private:
    JsonNode at(const TextureParameter& p) const { return texture_.at(p.name); }

    const JsonNode& texture_;
    const SceneReferences& references_;
};

} // namespace

TextureDesc readTexture(const JsonNode& node, const SceneReferences& references) {
    std::vector<std::string> names;
    forEachTextureType([&]<typename Texture>(const Texture&) { names.emplace_back(TextureType<Texture>::name); });
    const std::string name = readChoice(node.at("type"), names);
    TextureDesc read;
    forEachTextureType([&]<typename Texture>(Texture texture) {
        if (name != TextureType<Texture>::name) return;
        std::vector<const char*> keys = {"type"};
        TextureType<Texture>::forEachParameter([&](const TextureParameter& p, auto) { keys.push_back(p.name); });
        node.expectKeys(keys);
        const ParameterReader reader(node, references);
        TextureType<Texture>::forEachParameter([&](const TextureParameter& p, auto member) {
            if (p.isRequired || node.has(p.name)) reader.read(p, texture.*member);
        });
        read = std::move(texture);
    });
    return read;
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
