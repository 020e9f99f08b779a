// Writing of scene files. Defaults are left out.
#include "Common/Scene/Json/SceneWriter.h"

#include <algorithm>

#include "Common/Core/Error.h"
#include "Common/Core/Printable.h"
#include "Common/Scene/Json/JsonWriting.h"
#include "Common/Scene/Json/PrincipledType.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/Json/SkyJson.h"
#include "Common/Scene/Json/TextureTypes.h"
#include "Common/Scene/MaterialTypes.h"

namespace rt::scene {

namespace {

constexpr std::size_t kLineWidth = 120;

// ---- layout --------------------------------------------------------------------------------------------------------

// Whole numbers without their fraction. Only texts can be what JSON cannot hold: paths, as names have been made
// printable.
std::string scalar(const OrderedJson& value) {
    std::string text;
    try {
        text = value.dump();
    } catch (const OrderedJson::type_error&) {
        throw InputError("a scene file cannot hold \"" + printable(value.get_ref<const std::string&>()) +
                         "\": it must be valid UTF-8");
    }
    const bool isWhole = value.is_number_float() && text.size() > 2 && text.compare(text.size() - 2, 2, ".0") == 0;
    if (isWhole && text != "-0.0") text.resize(text.size() - 2);
    return text;
}

// On one line with spaces after separators; gives up and returns false once it gets longer than a line.
bool writeInline(const OrderedJson& value, std::size_t limit, std::string& out) {
    if (!value.is_structured()) {
        out += scalar(value);
        return out.size() <= limit;
    }
    out += value.is_object() ? '{' : '[';
    bool first = true;
    for (auto member = value.begin(); member != value.end(); ++member) {
        if (!first) out += ", ";
        first = false;
        if (value.is_object()) out += scalar(OrderedJson(member.key())) + ": ";
        if (!writeInline(*member, limit, out)) return false;
    }
    out += value.is_object() ? '}' : ']';
    return out.size() <= limit;
}

void writeNumbers(const OrderedJson& numbers, const std::string& indent, std::string& out) {
    std::size_t width = kLineWidth;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const std::string text = scalar(numbers[i]);
        if (i > 0) out += ',';
        if (width + text.size() + 2 > kLineWidth) {
            out += '\n' + indent;
            width = indent.size();
        } else {
            out += ' ';
        }
        out += text;
        width += text.size() + 2;
    }
}

void write(const OrderedJson& value, const std::string& indent, std::string& out) {
    std::string line;
    if (writeInline(value, kLineWidth - std::min(indent.size(), kLineWidth / 2), line)) {
        out += line;
        return;
    }
    if (!value.is_structured()) {
        out += scalar(value);
        return;
    }
    const std::string inner = indent + "  ";
    out += value.is_object() ? '{' : '[';
    if (value.is_array() && value[0].is_number()) {
        writeNumbers(value, inner, out);
    } else {
        bool first = true;
        for (auto member = value.begin(); member != value.end(); ++member) {
            out += (first ? "\n" : ",\n") + inner;
            first = false;
            if (value.is_object()) out += scalar(OrderedJson(member.key())) + ": ";
            write(*member, inner, out);
        }
    }
    out += '\n' + indent + (value.is_object() ? '}' : ']');
}

// ---- values --------------------------------------------------------------------------------------------------------

using scene::json;

template <typename Vector>
OrderedJson flat(const std::vector<Vector>& vectors) {
    OrderedJson numbers = OrderedJson::array();
    for (const Vector& v : vectors)
        for (int i = 0; i < v.length(); ++i) numbers.push_back(v[i]);
    return numbers;
}

OrderedJson json(const CameraDesc& camera) {
    return {{"look_from", json(camera.lookFrom)},
            {"look_at", json(camera.lookAt)},
            {"up", json(camera.up)},
            {"vertical_fov", camera.verticalFov},
            {"defocus_angle", camera.defocusAngle},
            {"focus_distance", camera.focusDistance}};
}

// ---- appearance ----------------------------------------------------------------------------------------------------

OrderedJson json(const NumberOrTexture& number) {
    if (number.texture.empty()) return number.factor;
    return {{"texture", number.texture},
            {"channel", channelNames().at(static_cast<std::size_t>(number.channel))},
            {"factor", number.factor}};
}

template <typename Value>
OrderedJson json(const SceneParameter& parameter, const Value& value) {
    if constexpr (std::is_enum_v<Value>)
        return parameter.choices().at(static_cast<std::size_t>(value));
    else if constexpr (std::is_same_v<Value, glm::dvec3> || std::is_same_v<Value, ColorOrTexture> ||
                       std::is_same_v<Value, NumberOrTexture>)
        return json(value);
    else if constexpr (std::is_same_v<Value, std::optional<double>> ||
                       std::is_same_v<Value, std::optional<std::uint32_t>>)
        return *value; // the usual one is none, and not written
    else
        return value;
}

OrderedJson json(const TextureDesc& desc) {
    return std::visit(
        []<typename Texture>(const Texture& texture) {
            const Texture usual;
            OrderedJson out = {{"type", TextureType<Texture>::name}};
            TextureType<Texture>::forEachParameter([&](const SceneParameter& p, auto member) {
                if (p.isRequired || texture.*member != usual.*member) out[p.name] = json(p, texture.*member);
            });
            return out;
        },
        desc);
}

OrderedJson json(const MaterialDesc& material) {
    const MaterialDesc usual;
    const MaterialType& type = materialType(material.kind);
    OrderedJson out = {{"type", type.name}};
    if (const MaterialParameter* color = colorOf(type))
        if (color->isRequired || material.albedo != usual.albedo) out[color->name] = json(material.albedo);
    forEachNumber(type, [&](const MaterialParameter& parameter, std::size_t i) {
        const std::optional<double>& value = material.parameters[i];
        if (parameter.isRequired || value) out[parameter.name] = value.value_or(parameter.usual);
    });
    if (material.kind == MaterialKind::Principled)
        forEachPrincipledParameter([&](const SceneParameter& p, auto member) {
            const auto& value = material.principled.*member;
            if (value != usual.principled.*member) out[p.name] = json(p, value);
        });
    if (!type.scatters || material.emission != usual.emission) out["emission"] = json(material.emission);
    setUnless(out, "emission_texture", material.emissionTexture, std::string());
    if (material.sides) out["sides"] = *material.sides == Sides::Front ? "front" : "both";
    return out;
}

// ---- objects -------------------------------------------------------------------------------------------------------

OrderedJson json(const Transform& transform) {
    struct Step {
        OrderedJson operator()(const Translate& step) const { return {{"translate", json(step.offset)}}; }
        OrderedJson operator()(const Rotate& step) const {
            return {{"rotate", {{"axis", json(step.axis)}, {"degrees", step.degrees}}}};
        }
        OrderedJson operator()(const Scale& step) const { return {{"scale", json(step.factors)}}; }
        OrderedJson operator()(const Matrix& step) const { return {{"matrix", step.rows}}; }
    };
    OrderedJson steps = OrderedJson::array();
    for (const auto& step : transform) steps.push_back(std::visit(Step{}, step));
    return steps;
}

OrderedJson json(const std::vector<ObjectDesc>& objects);

template <typename Surface>
OrderedJson withSurface(OrderedJson out, const Surface& surface) {
    setUnless(out, "material", surface.material, std::string());
    setUnless(out, "light", surface.light, true);
    return out;
}

OrderedJson json(const SphereBoundary& sphere) {
    return {{"type", "sphere"}, {"center", json(sphere.center)}, {"radius", sphere.radius}};
}
OrderedJson json(const BoxBoundary& box) {
    return {{"type", "box"}, {"min", json(box.min)}, {"max", json(box.max)}};
}
OrderedJson json(const QuadDesc& quad) {
    return withSurface(
        {{"type", "quad"}, {"corner", json(quad.corner)}, {"edge_u", json(quad.edgeU)}, {"edge_v", json(quad.edgeV)}},
        quad);
}
OrderedJson json(const SphereDesc& sphere) {
    OrderedJson out = {{"type", "sphere"}, {"center", json(sphere.center)}};
    if (sphere.centerEnd) out["center_end"] = json(*sphere.centerEnd);
    out["radius"] = sphere.radius;
    return withSurface(std::move(out), sphere);
}
OrderedJson json(const SphereSetDesc& spheres) {
    OrderedJson out = withSurface({{"type", "spheres"}, {"radius", spheres.radius}}, spheres);
    out["centers"] = flat(spheres.centers);
    return out;
}
OrderedJson json(const BoxDesc& box) {
    return withSurface({{"type", "box"}, {"min", json(box.min)}, {"max", json(box.max)}}, box);
}
OrderedJson json(const DiskDesc& disk) {
    OrderedJson out = {
        {"type", "disk"}, {"center", json(disk.center)}, {"normal", json(disk.normal)}, {"radius", disk.radius}};
    setUnless(out, "inner_radius", disk.innerRadius, 0.0);
    return withSurface(std::move(out), disk);
}
OrderedJson json(const CylinderDesc& cylinder) {
    return withSurface(
        {{"type", "cylinder"}, {"base", json(cylinder.base)}, {"top", json(cylinder.top)}, {"radius", cylinder.radius}},
        cylinder);
}
template <class Real>
void setData(OrderedJson& out, const MeshOf<Real>& data) {
    out["positions"] = flat(data.positions);
    if (!data.normals.empty()) out["normals"] = flat(data.normals);
    if (!data.uvs.empty()) out["uvs"] = flat(data.uvs);
    if (!data.uvs2.empty()) out["uvs2"] = flat(data.uvs2);
    if (!data.colors.empty()) out["colors"] = flat(data.colors);
    if (!data.tangents.empty()) out["tangents"] = flat(data.tangents);
    out["triangles"] = flat(data.triangles);
}
OrderedJson json(const MeshDesc& mesh) {
    OrderedJson out = {{"type", "mesh"}};
    if (const auto* source = std::get_if<MeshFile>(&mesh.source)) {
        out["file"] = source->file;
        setUnless(out, "stand_in", source->standIn, std::string());
        return withSurface(std::move(out), mesh);
    }
    out = withSurface(std::move(out), mesh);
    if (const auto* data = std::get_if<Boxed<MeshData>>(&mesh.source))
        setData(out, **data);
    else
        setData(out, *std::get<Boxed<FloatMeshData>>(mesh.source));
    return out;
}
OrderedJson json(const MediumDesc& medium) {
    const OrderedJson boundary = std::visit([](const auto& shape) { return json(shape); }, medium.boundary);
    OrderedJson out = {{"type", "medium"}, {"boundary", boundary}, {"density", medium.density}};
    setUnless(out, "albedo", medium.albedo, MediumDesc().albedo);
    return out;
}
OrderedJson json(const PointLightDesc& light) {
    return {{"type", "point_light"}, {"position", json(light.position)}, {"intensity", json(light.intensity)}};
}
OrderedJson json(const SpotLightDesc& light) {
    const SpotLightDesc usual;
    OrderedJson out = {{"type", "spot_light"},
                       {"position", json(light.position)},
                       {"direction", json(light.direction)},
                       {"intensity", json(light.intensity)}};
    setUnless(out, "inner_angle", light.innerAngle, usual.innerAngle);
    setUnless(out, "outer_angle", light.outerAngle, usual.outerAngle);
    return out;
}
OrderedJson json(const DirectionalLightDesc& light) {
    return {
        {"type", "directional_light"}, {"direction", json(light.direction)}, {"irradiance", json(light.irradiance)}};
}
OrderedJson json(const GroupDesc& group) {
    OrderedJson out = {{"type", "group"}};
    if (!group.transform.empty()) out["transform"] = json(group.transform);
    out["objects"] = json(group.objects);
    return out;
}
OrderedJson json(const InstanceDesc& instance) {
    OrderedJson out = {{"type", "instance"}, {"prototype", instance.prototype}};
    if (!instance.transform.empty()) out["transform"] = json(instance.transform);
    setUnless(out, "material", instance.material, std::string());
    return out;
}

// Behind the type, where it is seen.
OrderedJson withHidden(OrderedJson object) {
    OrderedJson out = {{"type", object["type"]}, {"hidden", true}};
    for (auto& [key, value] : object.items())
        if (key != "type") out[key] = std::move(value);
    return out;
}

OrderedJson json(const ObjectDesc& object) {
    OrderedJson all = std::visit([](const auto& shape) { return json(shape); }, object.shape);
    return object.hidden ? withHidden(std::move(all)) : all;
}

OrderedJson json(const std::vector<ObjectDesc>& objects) {
    OrderedJson out = OrderedJson::array();
    for (const ObjectDesc& object : objects) out.push_back(json(object));
    return out;
}

template <typename Value>
void setSection(OrderedJson& target, const char* key, const std::map<std::string, Value>& section) {
    for (const auto& [name, value] : section) target[key][name] = json(value);
}

} // namespace

OrderedJson jsonOf(const ObjectDesc& object) {
    return json(object);
}

OrderedJson jsonOf(const Transform& transform) {
    return json(transform);
}

OrderedJson jsonOf(const std::map<std::string, ModelDesc>& models) {
    OrderedJson out = OrderedJson::object();
    for (const auto& [name, model] : models) {
        OrderedJson& named = out[name] = {{"file", model.file}};
        setUnless(named, "animation", model.animation, std::string());
        setUnless(named, "time", model.time, 0.0);
    }
    return out;
}

OrderedJson jsonOf(const SceneDesc& scene) {
    OrderedJson out = {{"version", 1}};
    setUnless(out, "title", scene.title, std::string());
    out["camera"] = json(scene.camera);
    setSection(out, "cameras", scene.cameras);
    out["background"] = skyJson(scene.background);
    if (scene.render != RenderDefaults()) out["render"] = {{"aspect", scene.render.aspect}};
    setSection(out, "textures", scene.textures);
    setSection(out, "materials", scene.materials);
    setSection(out, "prototypes", scene.prototypes);
    out["objects"] = json(scene.objects);
    for (const TargetDesc& target : scene.importanceTargets)
        out["importance_targets"].push_back(std::visit([](const auto& shape) { return json(shape); }, target.shape));
    return out;
}

std::string layOut(const OrderedJson& value) {
    std::string text;
    write(value, "", text);
    return text + '\n';
}

std::string toJson(const SceneDesc& scene) {
    return layOut(jsonOf(scene));
}

} // namespace rt::scene
