// Reading of scene files: textures and materials.
#include <algorithm>

#include "Common/Scene/Json/PrincipledType.h"
#include "Common/Scene/Json/SceneParameter.h"
#include "Common/Scene/Json/SceneReader.h"
#include "Common/Scene/Json/TextureTypes.h"
#include "Common/Scene/MaterialTypes.h"

namespace rt::scene {

namespace {

// Reads the parameters of one texture or material.
class ParameterReader {
  public:
    ParameterReader(const JsonNode& record, const SceneReferences& references)
        : record_(record), references_(references) {}

    void read(const SceneParameter& p, double& value) const { value = at(p).within(p.minimum, p.maximum); }
    void read(const SceneParameter& p, std::optional<double>& value) const {
        value = at(p).within(p.minimum, p.maximum);
    }
    void read(const SceneParameter& p, bool& value) const { value = at(p).boolean(); }
    void read(const SceneParameter& p, std::uint32_t& value) const {
        value = at(p).unsignedInteger();
        at(p).within(p.minimum, p.maximum);
    }
    void read(const SceneParameter& p, std::optional<std::uint32_t>& value) const { read(p, value.emplace()); }
    void read(const SceneParameter& p, glm::dvec3& value) const { value = at(p).vectorWithin(0, 1); }
    void read(const SceneParameter& p, std::array<double, 6>& value) const {
        const std::vector<double> numbers = at(p).numbers(3);
        if (numbers.size() != value.size()) at(p).failValue("6 numbers: two rows of three");
        std::ranges::copy(numbers, value.begin());
    }
    void read(const SceneParameter& p, ColorOrTexture& value) const { value = references_.colorOrTexture(at(p)); }
    void read(const SceneParameter& p, NumberOrTexture& value) const {
        const JsonNode node = at(p);
        if (node.value().is_number()) {
            value.factor = node.within(0, 1);
            return;
        }
        node.expectKeys({"texture", "channel", "factor"});
        value.texture = references_.name(node.at("texture"), "textures");
        value.channel = enumeration<Channel>(node.at("channel"), channelNames());
        const auto factor = node.find("factor");
        value.factor = factor ? factor->within(-1, 1) : 1;
    }
    void read(const SceneParameter& p, std::string& value) const {
        value = p.choices   ? readChoice(at(p), p.choices())
                : p.section ? references_.name(at(p), p.section)
                            : references_.file(at(p), record_.has("stand_in"));
    }
    template <IsEnumeration Enumeration>
    void read(const SceneParameter& p, Enumeration& value) const {
        value = enumeration<Enumeration>(at(p), p.choices());
    }

  private:
    JsonNode at(const SceneParameter& p) const { return record_.at(p.name); }

    template <typename Enumeration>
    static Enumeration enumeration(const JsonNode& node, const std::vector<std::string>& names) {
        return static_cast<Enumeration>(std::ranges::find(names, readChoice(node, names)) - names.begin());
    }

    const JsonNode& record_;
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
        TextureType<Texture>::forEachParameter([&](const SceneParameter& p, auto) { keys.push_back(p.name); });
        node.expectKeys(keys);
        const ParameterReader reader(node, references);
        TextureType<Texture>::forEachParameter([&](const SceneParameter& p, auto member) {
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
    const bool isPrincipled = type.kind == MaterialKind::Principled;
    if (isPrincipled) forEachPrincipledParameter([&](const SceneParameter& p, auto) { keys.push_back(p.name); });
    node.expectKeys(keys);

    MaterialDesc material;
    material.kind = type.kind;
    const MaterialParameter* color = colorOf(type);
    if (color && (color->isRequired || node.has(color->name)))
        material.albedo = references.colorOrTexture(node.at(color->name));
    forEachNumber(type, [&](const MaterialParameter& parameter, std::size_t i) {
        if (parameter.isRequired || node.has(parameter.name))
            material.parameters[i] = node.at(parameter.name).within(parameter.minimum, parameter.maximum);
    });
    if (isPrincipled)
        forEachPrincipledParameter([&](const SceneParameter& p, auto member) {
            if (node.has(p.name)) ParameterReader(node, references).read(p, material.principled.*member);
        });
    if (!type.scatters || node.has("emission")) material.emission = node.at("emission").vectorWithin(0, kLargest);
    if (const auto texture = node.find("emission_texture"))
        material.emissionTexture = references.name(*texture, "textures");
    if (const auto sides = node.find("sides"))
        material.sides = sides->oneOf({"front", "both"}) == "front" ? Sides::Front : Sides::Both;
    return material;
}

} // namespace rt::scene
