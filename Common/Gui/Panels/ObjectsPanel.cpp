// The objects of the scene: their tree, what is selected, what can be added, and the history of edits.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "Common/Core/Printable.h"
#include "Common/Gui/Panels/ObjectFields.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr std::size_t kHistoryLines = 12;

// ---- adding --------------------------------------------------------------------------------------------------------

// Where the camera looks, in a size that is seen well; lights hang before that, above the line of sight.
struct Spot {
    glm::dvec3 middle, above;
    double size;
};

Spot spotOf(const Gui& gui) {
    const scene::CameraDesc& camera = gui.camera.camera();
    const glm::dvec3 back = camera.lookFrom - camera.lookAt;
    const double distance = glm::length(back);
    return {camera.lookAt, camera.lookAt + 0.4 * back + glm::dvec3(0, 0.2 * distance, 0), 0.1 * distance};
}

// That of what is selected, else one of its own; the edit that makes it, where it is not there yet.
std::string materialFor(const Gui& gui, std::vector<scene::SceneEdit>& edits, const char* usual,
                        const scene::MaterialDesc& desc) {
    const scene::SceneDesc& scene = gui.editor.document()->scene();
    if (gui.editor.selection() && desc.emission == glm::dvec3(0)) {
        const std::string* own = materialNameOf(*findObject(scene, *gui.editor.selection()));
        if (own != nullptr && !own->empty()) return *own;
    }
    if (!scene.materials.contains(usual)) edits.emplace_back(scene::SetMaterial{usual, desc});
    return usual;
}

void addObject(Gui& gui, const char* name, const scene::ObjectDesc::Shape& shape, std::vector<scene::SceneEdit> edits) {
    const auto index = static_cast<std::uint32_t>(gui.editor.document()->scene().objects.size());
    const scene::ObjectPath path{"", {index}};
    edits.emplace_back(scene::PlaceObject{path, scene::ObjectDesc{shape}});
    if (!editScene(gui, std::string("Add ") + name, std::move(edits), false)) return;
    gui.editor.select(path);
    gui.editing.revealsSelection = true;
}

template <typename Shape>
void addSurface(Gui& gui, const char* name, Shape shape, bool isLamp) {
    std::vector<scene::SceneEdit> edits;
    scene::MaterialDesc desc;
    desc.albedo = glm::dvec3(0.8);
    if (isLamp) {
        desc.kind = scene::MaterialKind::Emitter;
        desc.emission = glm::dvec3(8);
        desc.sides = scene::Sides::Both;
    }
    shape.material = materialFor(gui, edits, isLamp ? "lamp" : "white", desc);
    addObject(gui, name, {std::move(shape)}, std::move(edits));
}

void drawAddMenu(Gui& gui) {
    if (!ImGui::BeginPopup("##add")) return;
    const auto [middle, above, size] = spotOf(gui);
    const glm::dvec3 x(size, 0, 0), z(0, 0, size);
    if (ImGui::MenuItem("Sphere")) {
        scene::SphereDesc sphere;
        sphere.center = middle;
        sphere.radius = size;
        addSurface(gui, "sphere", sphere, false);
    }
    if (ImGui::MenuItem("Box")) addSurface(gui, "box", scene::BoxDesc{middle - size, middle + size, "", true}, false);
    if (ImGui::MenuItem("Quad"))
        addSurface(gui, "quad", scene::QuadDesc{middle - x + z, 2.0 * x, -2.0 * z, "", true}, false);
    if (ImGui::MenuItem("Disk")) addSurface(gui, "disk", scene::DiskDesc{middle, {0, 1, 0}, size, 0, "", true}, false);
    if (ImGui::MenuItem("Medium")) {
        scene::MediumDesc medium;
        medium.boundary = scene::SphereBoundary{middle, 2 * size};
        medium.density = 0.5 / size;
        addObject(gui, "medium", medium, {});
    }
    ImGui::Separator();
    const glm::dvec3 bright(10 * size * size); // 10 at a distance of its size
    if (ImGui::MenuItem("Area light"))
        addSurface(gui, "area light", scene::QuadDesc{above - x - z, 2.0 * x, 2.0 * z, "", true}, true);
    if (ImGui::MenuItem("Point light")) addObject(gui, "point light", scene::PointLightDesc{above, bright}, {});
    if (ImGui::MenuItem("Spot light"))
        addObject(gui, "spot light", scene::SpotLightDesc{above, {0, -1, 0}, 4.0 * bright, 0, 45}, {});
    if (ImGui::MenuItem("Directional light"))
        addObject(gui, "directional light", scene::DirectionalLightDesc{{-1, -2, -1}, glm::dvec3(2)}, {});
    if (ImGui::MenuItem("Sun and sky"))
        editScene(gui, "Sun and sky", {scene::SetBackground{scene::SunSkyBackground{}}}, false);
    tooltip("In place of the sky that there is");
    ImGui::Separator();
    if (ImGui::MenuItem("Model...")) gui.browse(BrowseFor::Model);
    tooltip("What a file of glTF, OBJ or pbrt, or a scene file shows, as one object; also by a drop onto this panel");
    ImGui::EndPopup();
}

// ---- all of it -----------------------------------------------------------------------------------------------------

void drawCommands(Gui& gui) {
    const scene::SceneDocument& document = *gui.editor.document();
    const float space = ImGui::GetStyle().ItemSpacing.x, width = (ImGui::GetContentRegionAvail().x - 3 * space) / 4;
    if (button("Add", "A surface, a light, a medium or a model, where the camera looks", true, width))
        ImGui::OpenPopup("##add");
    drawAddMenu(gui);
    ImGui::SameLine(0, space);
    const bool canUndo = document.position() > 0, canRedo = document.position() < document.stepCount();
    if (button("Undo", "Takes the last step back (Ctrl+Z)", {canUndo, "nothing has been edited"}, width)) undoEdit(gui);
    ImGui::SameLine(0, space);
    if (button("Redo", "What was taken back (Ctrl+Y)", {canRedo, "nothing was taken back"}, width)) redoEdit(gui);
    ImGui::SameLine(0, space);
    const char* tip = "Writes the scene file, or asks for one where the scene is built in or imported";
    if (button(gui.editor.isDirty() ? "Save*" : "Save", tip, !gui.editor.isSaving(), width)) saveScene(gui);
}

// A button that stays lit while what it stands for is so.
bool litButton(const char* label, const char* tip, bool isLit, float width) {
    if (isLit) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_SliderGrab));
    const bool isPressed = button(label, tip, true, width);
    if (isLit) ImGui::PopStyleColor();
    return isPressed;
}

// What handles the picture shows on what is selected: the lit ones once more, and there are none.
void drawGizmoRow(Gui& gui) {
    app::GuiSettings& settings = gui.settings;
    const float space = ImGui::GetStyle().ItemSpacing.x, width = (ImGui::GetContentRegionAvail().x - 3 * space) / 4;
    for (const auto& gizmo : app::kGizmos) {
        const bool isLit = settings.showGizmo && settings.gizmo == gizmo.value;
        if (litButton(gizmo.title, gizmo.help, isLit, width)) {
            settings.showGizmo = !isLit;
            settings.gizmo = gizmo.value;
        }
        ImGui::SameLine(0, space);
    }
    const char* tip = settings.localAxes ? "X, Y and Z are the object's own; click for those of the scene"
                                         : "X, Y and Z are those of the scene; click for the object's own";
    if (litButton(settings.localAxes ? "Local" : "World", tip, settings.localAxes, width))
        settings.localAxes = !settings.localAxes;
}

void drawSelectionPart(Gui& gui) {
    const scene::ObjectPath path = *gui.editor.selection();
    const auto object = [&] { return findObject(gui.editor.document()->scene(), path); };
    const std::size_t others = gui.editor.selected().size() - 1;
    const std::string title = std::string(app::kindName(*object())) + "  " + printable(textOf(path), 60);
    ImGui::Separator();
    ImGui::TextUnformatted(elided(title, ImGui::GetContentRegionAvail().x).c_str());
    if (others > 0)
        note("And " + std::to_string(others) + " more: numbers and a material that are set here become theirs, too");
    const float space = ImGui::GetStyle().ItemSpacing.x, width = (ImGui::GetContentRegionAvail().x - 3 * space) / 4;
    const bool isDeleted = button("Delete", "All that is selected (Delete)", true, width);
    ImGui::SameLine(0, space);
    const bool isDuplicated = button("Duplicate", "Beside itself (Shift+D)", true, width);
    ImGui::SameLine(0, space);
    if (button("Frame", "Moves the camera until all of it is in sight (F)", true, width)) frameSelection(gui);
    ImGui::SameLine(0, space);
    if (button("Solo", "Hides all else but what gives light (Shift+H)", true, width)) soloSelection(gui);
    drawObjectFields(gui, path);
    if (object() != nullptr) drawMaterialFields(gui, path);
    if (isDuplicated) duplicateSelection(gui);
    if (isDeleted) deleteSelection(gui);
}

// The latest steps; what was taken back is grey.
void drawHistory(const scene::SceneDocument& document) {
    if (document.stepCount() == 0 || !ImGui::CollapsingHeader("History")) return;
    const std::size_t last = std::min(document.stepCount(), document.position() + kHistoryLines / 2);
    const std::size_t first = last > kHistoryLines ? last - kHistoryLines : 0;
    for (std::size_t step = first; step < last; ++step) {
        const std::string text = std::to_string(step + 1) + "  " + printable(document.stepName(step), 60);
        step < document.position() ? ImGui::TextUnformatted(text.c_str()) : ImGui::TextDisabled("%s", text.c_str());
    }
}

} // namespace

void drawObjectsPanel(Gui& gui) {
    gui.editor.begin();
    if (const auto file = takeDroppedModel(gui)) addModel(gui, *file);
    if (gui.editor.document() == nullptr)
        return note(gui.editor.isReading() ? "Reading the scene's description ..." : "There is no scene yet");
    drawCommands(gui);
    drawModelReading(gui);
    drawGizmoRow(gui);
    drawObjectTree(gui);
    // Above what is selected, whose fields are more or fewer with each material that it gets.
    if (ImGui::CollapsingHeader("Material library")) drawMaterialLibrary(gui);
    if (gui.editor.selection()) drawSelectionPart(gui);
    if (ImGui::CollapsingHeader("Sky")) drawSkyFields(gui);
    const scene::CameraDesc& view = gui.camera.camera();
    if (button("View to scene", "What is seen now becomes the scene's own camera",
               {view != gui.editor.document()->scene().camera, "it is the scene's own camera"}))
        editScene(gui, "Camera", {scene::SetCamera{view}}, false);
    drawHistory(*gui.editor.document());
}

} // namespace rt::gui
