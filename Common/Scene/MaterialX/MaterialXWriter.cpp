#include "Common/Scene/MaterialX/MaterialXWriter.h"

#include <algorithm>
#include <cmath>
#include <locale>
#include <map>
#include <sstream>
#include <tuple>
#include <utility>

#include "Common/Scene/AsPrincipled.h"
#include "Common/Scene/MaterialX/XmlText.h"

namespace rt::scene {

namespace {

std::string decimal(double number) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(9);
    out << number;
    return out.str();
}
std::string decimal(const glm::dvec3& color) {
    return decimal(color.x) + ", " + decimal(color.y) + ", " + decimal(color.z);
}

// A name that elements may have: letters of ASCII, digits and underscores.
std::string elementName(const std::string& name) {
    std::string text;
    for (const char c : name) {
        const bool isPlain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        text += isPlain ? c : '_';
    }
    return text.empty() || (text.front() >= '0' && text.front() <= '9') ? "m_" + text : text;
}

XmlElement valueInput(const std::string& name, const std::string& type, const std::string& value) {
    return {"input", {{"name", name}, {"type", type}, {"value", value}}, {}, 0};
}
XmlElement nodeInput(const std::string& name, const std::string& type, const std::string& node) {
    return {"input", {{"name", name}, {"type", type}, {"nodename", node}}, {}, 0};
}

class MaterialXWriter {
  public:
    MaterialXWriter(const SceneDesc& scene, const std::filesystem::path& folder, std::vector<std::string>& notices)
        : scene_(scene), folder_(folder), notices_(notices) {
        root_ = {"materialx", {{"version", "1.38"}, {"colorspace", "lin_rec709"}}, {}, 0};
    }

    XmlElement write(const std::string& name, const MaterialDesc& material) {
        const std::string own = elementName(name), shader = "SR_" + own;
        surface_ = {"gltf_pbr", {{"name", shader}, {"type", "surfaceshader"}}, {}, 0};
        writeSurface(material);
        root_.children.push_back(std::move(surface_));
        XmlElement top{"surfacematerial", {{"name", own}, {"type", "material"}}, {}, 0};
        if (own != name) top.attributes.emplace_back("uiname", name);
        top.children.push_back(nodeInput("surfaceshader", "surfaceshader", shader));
        root_.children.push_back(std::move(top));
        return std::move(root_);
    }

  private:
    void writeSurface(const MaterialDesc& material) {
        const PrincipledDesc& p = material.principled;
        color("base_color", material.albedo, 1);
        number("metallic", p.metallic, 1);
        number("roughness", p.roughness, 1);
        number("specular", p.specular, 1);
        color("specular_color", p.specularColor, 1);
        value("ior", p.ior, 1.5);
        number("transmission", p.transmission, 0);
        if (p.transmission.factor != 0 && !p.isThin) value("thickness", 1, 0);
        if (p.attenuationDistance) {
            value("attenuation_distance", *p.attenuationDistance, 0);
            color("attenuation_color", p.attenuationColor, 1);
        }
        number("clearcoat", p.clearcoat, 0);
        number("clearcoat_roughness", p.clearcoatRoughness, 0);
        color("sheen_color", p.sheenColor, 0);
        number("sheen_roughness", p.sheenRoughness, 0);
        normals("normal", p.normalTexture, p.normalScale);
        normals("clearcoat_normal", p.clearcoatNormalTexture, p.clearcoatNormalScale);
        writeFilm(p);
        number("anisotropy_strength", p.anisotropy, 0);
        value("anisotropy_rotation", p.anisotropyRotation, 0);
        value("dispersion", p.dispersion, 0);
        if (!p.anisotropyTexture.empty()) notices_.emplace_back("the image of directions of anisotropy is left out");
        if (p.diffuseTransmission.factor != 0) notices_.emplace_back("diffuse transmission is left out");
        writeOpacity(p);
        writeEmission(material);
    }

    void writeFilm(const PrincipledDesc& p) {
        if (p.iridescence.factor == 0) return;
        number("iridescence", p.iridescence, 0);
        value("iridescence_ior", p.iridescenceIor, 1.3);
        if (!p.iridescenceThickness.texture.empty())
            notices_.emplace_back("the image of the film's thickness is left out: it is as thick everywhere");
        const double share = std::abs(p.iridescenceThickness.factor);
        const double least = p.iridescenceThicknessMinimum, most = p.iridescenceThicknessMaximum;
        value("iridescence_thickness", least + share * (most - least), 100);
    }

    void writeOpacity(const PrincipledDesc& p) {
        constexpr int kMask = 1, kBlend = 2;
        if (p.opacity == PrincipledDesc().opacity) return;
        number("alpha", p.opacity, 1);
        const int mode = p.alphaCutoff ? kMask : kBlend;
        surface_.children.push_back(valueInput("alpha_mode", "integer", std::to_string(mode)));
        if (p.alphaCutoff) value("alpha_cutoff", *p.alphaCutoff, 0.5);
    }

    // The colour at most 1, as the input's range is, and its strength.
    void writeEmission(const MaterialDesc& material) {
        const glm::dvec3& e = material.emission;
        if (e == glm::dvec3(0)) return;
        const double strength = std::max({e.x, e.y, e.z, 1.0});
        ColorOrTexture source = e / strength;
        glm::dvec3 tint(1);
        if (!material.emissionTexture.empty()) {
            source = material.emissionTexture;
            tint = e / strength;
        }
        color("emissive", source, 0, tint);
        value("emissive_strength", strength, 1);
    }

    void value(const char* name, double number, double usual) {
        if (number != usual) surface_.children.push_back(valueInput(name, "float", decimal(number)));
    }

    void color(const char* name, const ColorOrTexture& source, double usual, const glm::dvec3& tint = glm::dvec3(1)) {
        if (const auto* constant = std::get_if<glm::dvec3>(&source)) {
            if (*constant * tint != glm::dvec3(usual))
                surface_.children.push_back(valueInput(name, "color3", decimal(*constant * tint)));
            return;
        }
        const ImageTexture* image = imageOf(std::get<std::string>(source));
        if (image == nullptr) {
            surface_.children.push_back(
                valueInput(name, "color3", decimal(tint * stand(std::get<std::string>(source)))));
            return;
        }
        std::string node = imageNode(*image, "color3", image->colorSpace);
        if (const glm::dvec3 product = image->tint * tint; product != glm::dvec3(1))
            node = operation("multiply", "color3", nodeInput("in1", "color3", node),
                             valueInput("in2", "color3", decimal(product)));
        surface_.children.push_back(nodeInput(name, "color3", node));
    }

    void number(const char* name, const NumberOrTexture& source, double usual) {
        if (source.texture.empty()) return value(name, source.factor, usual);
        const ImageTexture* image = imageOf(source.texture);
        if (image == nullptr) return value(name, std::abs(source.factor) * stand(source.texture).x, usual);
        const bool isAlpha = source.channel == Channel::Alpha;
        const std::string type = isAlpha ? "color4" : "color3";
        const auto index = std::to_string(static_cast<int>(source.channel));
        std::string node = imageNode(*image, type, ColorSpace::Linear);
        node = operation("extract", "float", nodeInput("in", type, node), valueInput("index", "integer", index));
        const double factor =
            std::abs(source.factor) * (isAlpha ? 1 : image->tint[static_cast<glm::length_t>(source.channel)]);
        if (factor != 1)
            node = operation("multiply", "float", nodeInput("in1", "float", node),
                             valueInput("in2", "float", decimal(factor)));
        if (source.factor < 0)
            node = operation("invert", "float", nodeInput("in", "float", node), valueInput("amount", "float", "1"));
        surface_.children.push_back(nodeInput(name, "float", node));
    }

    void normals(const char* name, const std::string& texture, double scale) {
        if (texture.empty()) return;
        const ImageTexture* image = imageOf(texture);
        if (image == nullptr) return;
        const std::string node = operation("normalmap", "vector3",
                                           nodeInput("in", "vector3", imageNode(*image, "vector3", ColorSpace::Linear)),
                                           valueInput("scale", "float", decimal(scale)));
        surface_.children.push_back(nodeInput(name, "vector3", node));
    }

    // Null: the texture is of a formula, or an image within another file, which a notice tells.
    const ImageTexture* imageOf(const std::string& texture) {
        const auto found = scene_.textures.find(texture);
        const auto* image = found != scene_.textures.end() ? std::get_if<ImageTexture>(&found->second) : nullptr;
        if (image != nullptr && !image->image) return image;
        notices_.push_back("texture \"" + texture + "\" is left out: only images in files of their own are written");
        return nullptr;
    }

    // A colour in the place of such a texture.
    glm::dvec3 stand(const std::string& texture) const {
        constexpr double kGrey = 0.5;
        const auto found = scene_.textures.find(texture);
        if (found != scene_.textures.end())
            if (const auto* solid = std::get_if<SolidTexture>(&found->second)) return solid->color;
        return glm::dvec3(kGrey);
    }

    // Its name: one node for all that show the same.
    std::string imageNode(const ImageTexture& image, const std::string& type, ColorSpace space) {
        ImageTexture key = image;
        key.tint = glm::dvec3(1);
        key.colorSpace = space;
        for (const auto& [known, knownType, name] : images_)
            if (known == key && knownType == type) return name;
        const bool isLinear = space == ColorSpace::Linear;
        XmlElement file = valueInput("file", "filename", fileName(image.file));
        if (type != "vector3") file.attributes.emplace_back("colorspace", isLinear ? "lin_rec709" : "srgb_texture");
        const std::array<double, 6>& m = image.uvTransform;
        const bool isTiled = m != ImageTexture().uvTransform;
        std::vector<XmlElement> inputs = {std::move(file)};
        if (isTiled) {
            inputs.push_back(valueInput("uvtiling", "vector2", decimal(m[0]) + ", " + decimal(m[4])));
            inputs.push_back(valueInput("uvoffset", "vector2", decimal(-m[2]) + ", " + decimal(-m[5])));
            if (m[1] != 0 || m[3] != 0) notices_.emplace_back("the rotation of an image is left out");
        }
        for (const auto& [input, wrap] : {std::pair("uaddressmode", image.wrapU), {"vaddressmode", image.wrapV}})
            if (wrap != Wrap::Repeat)
                inputs.push_back(valueInput(input, "string", wrap == Wrap::Clamp ? "clamp" : "mirror"));
        if (image.uvSet != 0) {
            const std::string set = add("texcoord", "vector2", {valueInput("index", "integer", "1")});
            inputs.push_back(nodeInput("texcoord", "vector2", set));
        }
        std::string name = add(isTiled ? "tiledimage" : "image", type, std::move(inputs));
        images_.emplace_back(key, type, name);
        return name;
    }

    std::string operation(const char* node, const char* type, XmlElement first, XmlElement second) {
        return add(node, type, {std::move(first), std::move(second)});
    }
    std::string add(const char* node, const std::string& type, std::vector<XmlElement> inputs) {
        std::string name = std::string(node) + std::to_string(++counts_[node]);
        root_.children.push_back({node, {{"name", name}, {"type", type}}, std::move(inputs), 0});
        return name;
    }

    std::string fileName(const std::string& file) const {
        const std::filesystem::path path(file), beside = path.lexically_relative(folder_);
        const bool isBelow = path.is_absolute() && !beside.empty() && *beside.begin() != "..";
        return isBelow ? beside.generic_string() : path.generic_string();
    }

    const SceneDesc& scene_;
    const std::filesystem::path folder_;
    std::vector<std::string>& notices_;
    XmlElement root_, surface_;
    std::vector<std::tuple<ImageTexture, std::string, std::string>> images_; // with type and name of the node
    std::map<std::string, int> counts_;                                      // of nodes, by what they are
};

} // namespace

std::string toMaterialX(const SceneDesc& scene, const std::string& material, const std::filesystem::path& folder,
                        std::vector<std::string>& notices) {
    const MaterialDesc desc = asPrincipled(scene.materials.at(material), notices);
    const std::filesystem::path whole = std::filesystem::absolute(folder).lexically_normal();
    return toXml(MaterialXWriter(scene, whole, notices).write(material, desc));
}

} // namespace rt::scene
