#include "Common/Gui/Panels/ObjectFields.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <variant>
#include <vector>

#include "Common/Core/Printable.h"
#include "Common/Gui/Widgets.h"
#include "Common/Scene/Edit/SameChange.h"

namespace rt::gui {
namespace {

constexpr double kLargestNumber = 1e9, kSmallestSize = 1e-9; // of scene files

bool sizeField(const char* label, const char* tip, double& size) {
    return inputReal(label, tip, size, kSmallestSize, kLargestNumber, "%.5g");
}

bool lightField(bool& isLight) {
    return checkbox("In light list", "Whether what it emits is aimed at; it emits either way", isLight);
}

// Fields of what each kind of object is described by. All return whether something was changed.
struct Fields {
    bool operator()(scene::SphereDesc& sphere) const {
        bool changed = inputVector("Center", nullptr, sphere.center);
        changed |= sizeField("Radius", nullptr, sphere.radius);
        if (sphere.centerEnd) changed |= inputVector("Center at 1", "Where it is at time 1", *sphere.centerEnd);
        return lightField(sphere.light) || changed;
    }
    bool operator()(scene::QuadDesc& quad) const {
        bool changed = inputVector("Corner", nullptr, quad.corner);
        changed |= inputVector("Edge U", "From the corner; U x V points to the front", quad.edgeU);
        changed |= inputVector("Edge V", nullptr, quad.edgeV);
        return lightField(quad.light) || changed;
    }
    bool operator()(scene::BoxDesc& box) const {
        bool changed = inputVector("Least corner", nullptr, box.min);
        changed |= inputVector("Largest corner", nullptr, box.max);
        return lightField(box.light) || changed;
    }
    bool operator()(scene::DiskDesc& disk) const {
        bool changed = inputVector("Center", nullptr, disk.center);
        changed |= inputVector("Normal", "Points to the front; of any length", disk.normal);
        changed |= sizeField("Radius", nullptr, disk.radius);
        changed |= inputReal("Hole", "Radius of the hole", disk.innerRadius, 0, kLargestNumber, "%.5g");
        return lightField(disk.light) || changed;
    }
    bool operator()(scene::CylinderDesc& cylinder) const {
        bool changed = inputVector("Base", nullptr, cylinder.base);
        changed |= inputVector("Top", nullptr, cylinder.top);
        changed |= sizeField("Radius", nullptr, cylinder.radius);
        return lightField(cylinder.light) || changed;
    }
    bool operator()(scene::MediumDesc& medium) const {
        bool changed = sizeField("Density", "Extinction per unit of length", medium.density);
        if (auto* color = std::get_if<glm::dvec3>(&medium.albedo))
            changed |= inputColor("Albedo", "What is scattered of light that is stopped", *color);
        if (auto* sphere = std::get_if<scene::SphereBoundary>(&medium.boundary)) {
            changed |= inputVector("Center", nullptr, sphere->center);
            return sizeField("Radius", nullptr, sphere->radius) || changed;
        }
        auto& box = std::get<scene::BoxBoundary>(medium.boundary);
        changed |= inputVector("Least corner", nullptr, box.min);
        return inputVector("Largest corner", nullptr, box.max) || changed;
    }
    bool operator()(scene::PointLightDesc& light) const {
        const bool changed = inputVector("Position", nullptr, light.position);
        return inputLight("Intensity", "Irradiance at a distance of 1", light.intensity) || changed;
    }
    bool operator()(scene::SpotLightDesc& light) const {
        bool changed = inputVector("Position", nullptr, light.position);
        changed |= inputVector("Direction", "In which it shines", light.direction);
        changed |= inputLight("Intensity", "Irradiance at a distance of 1", light.intensity);
        changed |= sliderReal("Inner angle", "Full up to it, in degrees", light.innerAngle, 0,
                              std::max(0.0, 0.99 * light.outerAngle), "%.1f");
        return sliderReal("Outer angle", "Dark from it on, in degrees", light.outerAngle,
                          std::max(0.1, 1.01 * light.innerAngle), 90, "%.1f") ||
               changed;
    }
    bool operator()(scene::DirectionalLightDesc& light) const {
        const bool changed = inputVector("Direction", "In which it shines", light.direction);
        return inputLight("Irradiance", "Of a surface across the direction", light.irradiance) || changed;
    }
    template <typename Other>
    bool operator()(Other&) const {
        return false;
    }
};

// Whether what describes it is small enough to be copied each frame.
bool isSmall(const scene::ObjectDesc& object) {
    return !std::holds_alternative<scene::MeshDesc>(object.shape) &&
           !std::holds_alternative<scene::SphereSetDesc>(object.shape) && transformOf(object) == nullptr;
}

bool stepField(std::variant<scene::Translate, scene::Rotate, scene::Scale, scene::Matrix>& step) {
    if (auto* translate = std::get_if<scene::Translate>(&step)) return inputVector("Move", nullptr, translate->offset);
    if (auto* scale = std::get_if<scene::Scale>(&step)) return inputVector("Scale", nullptr, scale->factors);
    if (auto* rotate = std::get_if<scene::Rotate>(&step)) {
        const bool changed = inputVector("Axis", "About which it is turned", rotate->axis);
        return inputReal("Degrees", "Counter-clockwise as seen from the axis' end", rotate->degrees, -kLargestNumber,
                         kLargestNumber, "%.5g") ||
               changed;
    }
    row("Matrix", "Of a move within a group that is turned or scaled, or of a file");
    ImGui::TextDisabled("3 x 4 numbers");
    return false;
}

// Steps in the order in which they are applied.
void drawTransform(Gui& gui, const scene::ObjectPath& path, scene::Transform transform) {
    bool changed = false;
    for (std::size_t i = 0; i < transform.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        changed |= stepField(transform[i]);
        ImGui::PopID();
    }
    if (transform.empty()) note("It stands as it is described: G, R and S move it");
    if (!changed) return;
    const scene::SceneDesc& scene = gui.editor.document()->scene();
    const scene::Transform& before = *transformOf(*findObject(scene, path));
    std::vector<scene::SceneEdit> edits;
    for (const scene::ObjectPath& selected : gui.editor.selected().paths()) {
        const scene::Transform* own = transformOf(*findObject(scene, selected));
        if (own == nullptr) continue;
        scene::Transform other = *own;
        changeAlike(before, transform, other);
        if (other != *own) edits.emplace_back(scene::SetTransform{selected, std::move(other)});
    }
    editScene(gui, "Transform", std::move(edits));
}

} // namespace

bool inputColor(const char* label, const char* tip, glm::dvec3& color) {
    row(label, tip);
    ImGui::PushID(label);
    float values[3] = {static_cast<float>(color.x), static_cast<float>(color.y), static_cast<float>(color.z)};
    constexpr ImGuiColorEditFlags kFlags = ImGuiColorEditFlags_Float | ImGuiColorEditFlags_PickerHueWheel;
    const bool changed = ImGui::ColorEdit3("##value", values, kFlags);
    ImGui::PopID();
    if (!changed) return false;
    for (int i = 0; i < 3; ++i) color[i] = std::clamp(static_cast<double>(values[i]), 0.0, 1.0);
    return true;
}

bool inputLight(const char* label, const char* tip, glm::dvec3& color) {
    double strength = std::max({color.x, color.y, color.z});
    glm::dvec3 hue = strength > 0 ? color / strength : glm::dvec3(1);
    const bool changed = inputReal(label, tip, strength, 0, kLargestNumber, "%.5g");
    const bool isTinted = inputColor("Color", "Of the light", hue);
    if (changed || isTinted) color = strength * hue;
    return changed || isTinted;
}

void drawObjectFields(Gui& gui, const scene::ObjectPath& path) {
    const scene::ObjectDesc& object = *findObject(gui.editor.document()->scene(), path);
    if (const scene::Transform* transform = transformOf(object)) return drawTransform(gui, path, *transform);
    if (!isSmall(object)) return note("G, R and S move it; it gets a group for that");
    scene::ObjectDesc changed = object;
    if (!std::visit(Fields{}, changed.shape)) return;
    std::vector<scene::SceneEdit> edits;
    for (const scene::ObjectPath& selected : gui.editor.selected().paths()) {
        const scene::ObjectDesc& own = *findObject(gui.editor.document()->scene(), selected);
        if (own.shape.index() != object.shape.index()) continue;
        scene::ObjectDesc other = own;
        changeAlike(object, changed, other);
        if (other != own) edits.emplace_back(scene::SetObject{selected, std::move(other)});
    }
    editScene(gui, app::kindName(object), std::move(edits));
}

namespace {

// What of a sky that there was comes over to one of another kind.
glm::dvec3 meanOf(const scene::Background& sky) {
    if (const auto* constant = std::get_if<scene::ConstantBackground>(&sky)) return constant->color;
    if (const auto* gradient = std::get_if<scene::GradientBackground>(&sky))
        return 0.5 * (gradient->bottom + gradient->top);
    return glm::dvec3(0.5);
}
scene::Background skyOfKind(std::size_t kind, const scene::Background& before) {
    if (kind == 0) return scene::ConstantBackground{meanOf(before)};
    if (kind == 1) return scene::GradientBackground{};
    return scene::SunSkyBackground{};
}

// Of kinds, those that can be had at once; an image has to be chosen first.
bool drawSkyKind(Gui& gui, scene::Background& sky) {
    constexpr const char* kKinds[] = {"Color", "Gradient", "Image", "Sun and sky"}; // in the order of the variant
    constexpr std::size_t kImageKind = 2;
    static_assert(std::variant_size_v<scene::Background> == std::size(kKinds));
    row("Kind",
        "One color from everywhere, one from above and one from below, an image of all directions, or the sun in "
        "a clear sky");
    bool changed = false;
    if (ImGui::BeginCombo("##kind", kKinds[sky.index()])) {
        const std::size_t before = sky.index();
        for (std::size_t kind = 0; kind < std::size(kKinds); ++kind) {
            if (!ImGui::Selectable(kKinds[kind], kind == before) || kind == before) continue;
            if (kind == kImageKind) {
                askImage(gui, setSkyImage);
            } else {
                sky = skyOfKind(kind, sky);
                changed = true;
            }
        }
        ImGui::EndCombo();
    }
    if (const auto file = takeDroppedImage(gui)) setSkyImage(gui, *file);
    return changed;
}

bool drawSkyImage(Gui& gui, scene::ImageBackground& image) {
    row("Image", "Of latitude and longitude, its upper row from above; another one by a click, or by a drop");
    const std::string name = printable(std::filesystem::path(image.file).filename().string());
    if (button((elided(name, ImGui::GetContentRegionAvail().x - ImGui::GetFontSize()) + "###image").c_str(),
               printable(image.file).c_str(), true, ImGui::GetContentRegionAvail().x))
        askImage(gui, setSkyImage);
    const auto dropped = takeDroppedImage(gui);
    const bool changed = inputLight("Strength", "The image is so many times as bright", image.factor);
    const bool isTurned = sliderReal("Rotation", "About +Y, in degrees", image.rotation, -180, 180, "%.1f");
    if (dropped) setSkyImage(gui, *dropped);
    return (changed || isTurned) && !dropped;
}

bool drawSunSky(scene::SunSkyBackground& sky) {
    bool changed = sliderReal("Sun elevation", "Above the horizon, in degrees", sky.sunElevation, 0, 90, "%.1f");
    changed |= sliderReal("Sun azimuth", "Degrees from -Z by way of +X, as on a compass whose north is -Z",
                          sky.sunAzimuth, -360, 360, "%.1f");
    changed |= sliderReal("Turbidity", "Haze of the air: 2 is very clear, 3 a fine day, 10 milky", sky.turbidity,
                          scene::kLeastTurbidity, scene::kMostTurbidity, "%.2f");
    changed |= inputLight("Strength", "Sun and sky are so many times as bright as the world's", sky.factor);
    return inputColor("Ground", "What the ground below the horizon reflects of both", sky.ground) || changed;
}

} // namespace

void drawSkyFields(Gui& gui) {
    scene::Background sky = gui.editor.document()->scene().background;
    ImGui::PushID("sky");
    const bool isOther = drawSkyKind(gui, sky);
    bool changed = isOther;
    if (auto* constant = std::get_if<scene::ConstantBackground>(&sky)) {
        changed |= inputLight("Sky", "Radiance from everywhere", constant->color);
    } else if (auto* gradient = std::get_if<scene::GradientBackground>(&sky)) {
        ImGui::PushID("zenith");
        changed |= inputLight("Zenith", "Radiance from above", gradient->top);
        ImGui::PopID();
        changed |= inputLight("Nadir", "Radiance from below", gradient->bottom);
    } else if (auto* image = std::get_if<scene::ImageBackground>(&sky)) {
        changed |= drawSkyImage(gui, *image);
    } else {
        changed |= drawSunSky(std::get<scene::SunSkyBackground>(sky));
    }
    ImGui::PopID();
    if (changed) editScene(gui, "Sky", {scene::SetBackground{sky}}, !isOther);
}

} // namespace rt::gui
