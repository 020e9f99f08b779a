// The material of what is selected: its fields follow from the table of materials.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "Common/Core/Printable.h"
#include "Common/Gui/Icons.h"
#include "Common/Gui/Panels/ObjectFields.h"
#include "Common/Gui/Widgets.h"
#include "Common/Scene/Edit/EditCheck.h"
#include "Common/Scene/Edit/MaterialTransfer.h"
#include "Common/Scene/Json/PrincipledType.h"
#include "Common/Scene/MaterialTypes.h"

namespace rt::gui {
namespace {

// Null where the table says nothing.
const char* tipOf(const char* help) {
    return help[0] != '\0' ? help : nullptr;
}

// "base_color" as people read it: "Base color".
std::string titled(const char* name) {
    std::string title = name;
    std::replace(title.begin(), title.end(), '_', ' ');
    if (!title.empty() && title.front() >= 'a' && title.front() <= 'z') title.front() -= 'a' - 'A';
    return title;
}

bool numberField(const std::string& label, const char* help, double& value, double minimum, double maximum) {
    constexpr double kLongest = 1e3; // of a slider: a field of text for what has no end
    if (maximum - minimum > kLongest) return inputReal(label.c_str(), help, value, minimum, maximum, "%.5g");
    return sliderReal(label.c_str(), help, value, minimum, maximum, "%.3f");
}

// The material that is drawn, and what comes of its rows beside other numbers.
struct MaterialRows {
    Gui& gui;
    const std::string& name;
    std::vector<std::string> freed{};       // textures that a row refers to no more
    std::optional<TextureSlot> droppedOn{}; // which gets an image
    std::string droppedImage{};
};

// Behind the row of a colour or a number: an image in its place. `find`: where a material has it.
template <typename Find>
void drawImageButton(MaterialRows& rows, const std::string& label, bool isColor, const Find& find) {
    using Source = std::remove_pointer_t<decltype(find(std::declval<scene::MaterialDesc&>()))>;
    const auto set = [find](scene::MaterialDesc& material, const std::string& texture) {
        Source& source = *find(material);
        if constexpr (std::is_same_v<Source, scene::NumberOrTexture>)
            source = {1, texture, scene::Channel::Red};
        else
            source = texture;
    };
    const TextureSlot slot{rows.name, isColor, set, std::is_same_v<Source, std::string>};
    if (const auto file = takeDroppedImage(rows.gui)) {
        rows.droppedOn = slot;
        rows.droppedImage = *file;
    }
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    if (iconButton(label.c_str(), Icon::Open, "From an image, by a click or by a drop onto this row"))
        askImage(rows.gui, [slot](Gui& gui, const std::string& file) { setTexture(gui, slot, file); });
}

float imageButtonRoom() {
    return ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x;
}

// What stands in place of the control; whether the texture is to go.
bool drawTextureName(const std::string& label, const char* help, const std::string& texture) {
    row(label.c_str(), help);
    const float room = ImGui::GetContentRegionAvail().x - 2 * imageButtonRoom();
    ImGui::PushID(label.c_str());
    ImGui::BeginGroup(); // above all of which an image can be let go
    ImGui::TextDisabled("%s", elided("texture " + texture, room).c_str());
    tooltip(printable(texture).c_str());
    ImGui::SameLine(room + ImGui::GetStyle().ItemInnerSpacing.x); // from the group's left end
    const bool isRemoved = iconButton("none", Icon::Close, "Without the texture");
    ImGui::EndGroup();
    ImGui::PopID();
    return isRemoved;
}

// Where there is none yet; it can be let go above this.
void drawNoTexture(const std::string& label, const char* help) {
    row(label.c_str(), help);
    const float room = ImGui::GetContentRegionAvail().x - imageButtonRoom();
    ImGui::BeginGroup();
    ImGui::TextDisabled("no texture");
    ImGui::SameLine(room);
    ImGui::Dummy({0, ImGui::GetFrameHeight()});
    ImGui::EndGroup();
}

template <typename Find>
bool colorField(MaterialRows& rows, const std::string& label, const char* help, scene::ColorOrTexture& source,
                const Find& find) {
    bool changed = false;
    if (const auto* texture = std::get_if<std::string>(&source)) {
        if (drawTextureName(label, help, *texture)) {
            rows.freed.push_back(*texture);
            source = glm::dvec3(0.8);
            changed = true;
        }
    } else {
        leaveRoomInNextRow(imageButtonRoom());
        changed = inputColor(label.c_str(), help, std::get<glm::dvec3>(source));
    }
    drawImageButton(rows, label, true, find);
    return changed;
}

// Of one parameter of a principled surface, whatever it is.
template <typename Member>
struct PrincipledField {
    MaterialRows& rows;
    const scene::SceneParameter& parameter;
    const Member member;
    const std::string label = titled(parameter.name);
    const char* const help = tipOf(parameter.help);

    auto find() const {
        return [member = member](scene::MaterialDesc& material) { return &(material.principled.*member); };
    }
    bool operator()(scene::NumberOrTexture& value) const {
        bool changed = false;
        if (value.texture.empty()) {
            leaveRoomInNextRow(imageButtonRoom());
            changed = numberField(label, help, value.factor, 0, 1);
        } else if (drawTextureName(label, help, value.texture)) {
            rows.freed.push_back(value.texture);
            value = {std::abs(value.factor), {}, scene::Channel::Red};
            changed = true;
        }
        drawImageButton(rows, label, false, find());
        return changed;
    }
    bool operator()(scene::ColorOrTexture& value) const { return colorField(rows, label, help, value, find()); }
    bool operator()(glm::dvec3& value) const { return inputColor(label.c_str(), help, value); }
    bool operator()(double& value) const {
        const double maximum = value <= 4 ? std::min(parameter.maximum, 4.0) : parameter.maximum;
        return numberField(label, help, value, std::max(parameter.minimum, -4.0), maximum);
    }
    bool operator()(bool& value) const { return checkbox(label.c_str(), help, value); }
    // A map of directions: of normals, or of the tangent that facets are rougher along.
    bool operator()(std::string& texture) const {
        bool changed = false;
        if (texture.empty()) {
            drawNoTexture(label, help);
        } else if (drawTextureName(label, help, texture)) {
            rows.freed.push_back(texture);
            texture.clear();
            changed = true;
        }
        drawImageButton(rows, label, false, find());
        return changed;
    }
    bool operator()(std::optional<double>&) const { return false; } // what is mostly left out
};

bool drawNumbers(MaterialRows& rows, scene::MaterialDesc& material) {
    bool changed = false;
    const scene::MaterialType& type = scene::materialType(material.kind);
    if (const scene::MaterialParameter* color = colorOf(type)) {
        const auto find = [](scene::MaterialDesc& other) { return &other.albedo; };
        changed |= colorField(rows, titled(color->name), tipOf(color->help), material.albedo, find);
    }
    forEachNumber(type, [&](const scene::MaterialParameter& parameter, std::size_t i) {
        double value = material.parameters[i].value_or(parameter.usual);
        if (!numberField(titled(parameter.name), tipOf(parameter.help), value, parameter.minimum, parameter.maximum))
            return;
        material.parameters[i] = value;
        changed = true;
    });
    if (material.kind == scene::MaterialKind::Principled)
        scene::forEachPrincipledParameter([&](const scene::SceneParameter& parameter, auto member) {
            changed |= PrincipledField<decltype(member)>{rows, parameter, member}(material.principled.*member);
        });
    changed |= inputLight("Emission", "Radiance that the surface gives off", material.emission);
    return changed;
}

// Textures that nothing else refers to go with it.
std::vector<scene::SceneEdit> editsOf(const MaterialRows& rows, const scene::SceneDesc& scene,
                                      scene::MaterialDesc material) {
    std::vector<scene::SceneEdit> edits{scene::SetMaterial{rows.name, std::move(material)}};
    for (const std::string& texture : rows.freed)
        if (scene::textureUses(scene, texture) == 1) edits.emplace_back(scene::SetTexture{texture, std::nullopt});
    return edits;
}

bool drawKind(scene::MaterialDesc& material) {
    row("Kind", "What the surface does with light");
    bool changed = false;
    if (!ImGui::BeginCombo("##kind", titled(scene::materialType(material.kind).name).c_str())) return false;
    for (const scene::MaterialType& type : scene::materialTypes()) {
        const bool isSelected = type.kind == material.kind;
        if (ImGui::Selectable(titled(type.name).c_str(), isSelected) && !isSelected) {
            material.kind = type.kind;
            material.parameters = {}; // the usual ones of its kind
            // What does not scatter is there to emit.
            if (!type.scatters && material.emission == glm::dvec3(0)) material.emission = glm::dvec3(4);
            changed = true;
        }
        if (type.help[0] != '\0') tooltip(type.help);
    }
    ImGui::EndCombo();
    return changed;
}

void drawName(Gui& gui, const std::string& current) {
    row("Material", "That of all surfaces which name it; another one is for all that is selected");
    if (!ImGui::BeginCombo("##name", current.empty() ? "its own" : current.c_str())) return;
    for (const auto& [name, material] : gui.editor.document()->scene().materials) {
        const bool isSelected = name == current;
        if (!ImGui::Selectable(name.c_str(), isSelected) || isSelected) continue;
        assignMaterial(gui, name);
        break; // the names may be others by now
    }
    ImGui::EndCombo();
}

// Counted once for each change of the scene: it may be large.
std::size_t usesOf(Gui& gui, const std::string& name) {
    SceneEditing& editing = gui.editing;
    const scene::SceneDocument& document = *gui.editor.document();
    if (std::exchange(editing.materialCounted, name) != name ||
        std::exchange(editing.countRevision, document.revision()) != document.revision())
        editing.materialUses = scene::materialUses(document.scene(), name);
    return editing.materialUses;
}

// For what is selected and has that material.
void drawUnique(Gui& gui, const std::string& name) {
    const std::size_t uses = usesOf(gui, name);
    if (uses > 1) note("Shared by " + std::to_string(uses) + " objects, which change with it");
    const scene::SceneDesc& scene = gui.editor.document()->scene();
    std::vector<scene::ObjectPath> paths = gui.editor.selected().paths();
    std::erase_if(paths, [&](const scene::ObjectPath& path) {
        const std::string* own = materialNameOf(*findObject(scene, path));
        return own == nullptr || *own != name;
    });
    if (!button("Make unique", "Gives what is selected a material of its own, like the one it has",
                {uses > paths.size(), "no other object has this material"}))
        return;
    const auto isTaken = [&](const std::string& other) { return scene.materials.contains(other); };
    const std::string own = scene::freeName(name, isTaken);
    std::vector<scene::SceneEdit> edits{scene::SetMaterial{own, scene.materials.at(name)}};
    for (const scene::ObjectPath& path : paths) edits.emplace_back(scene::SetMaterialOf{path, own});
    editScene(gui, "Make unique", std::move(edits), false);
}

} // namespace

void drawMaterialFields(Gui& gui, const scene::ObjectPath& path) {
    const scene::SceneDesc& scene = gui.editor.document()->scene();
    const std::string* found = materialNameOf(*findObject(scene, path));
    if (found == nullptr) return;
    const std::string name = *found; // edits may move the object
    ImGui::PushID("material");
    drawName(gui, name);
    if (const auto at = scene.materials.find(name); at != scene.materials.end()) {
        drawUnique(gui, name);
        scene::MaterialDesc material = scene.materials.at(name);
        const bool isOther = drawKind(material);
        MaterialRows rows{gui, name};
        const bool changed = drawNumbers(rows, material) || isOther;
        if (rows.droppedOn)
            setTexture(gui, *rows.droppedOn, rows.droppedImage);
        else if (changed)
            editScene(gui, "Material " + name, editsOf(rows, scene, material), !isOther && rows.freed.empty());
    }
    ImGui::PopID();
}

} // namespace rt::gui
