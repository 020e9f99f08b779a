#include "Common/Gui/SceneEditing.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <imgui.h>

#include "Common/App/Interactive/VisibleSurface.h"
#include "Common/Core/Error.h"
#include "Common/Gui/Gui.h"
#include "Common/Gui/Theme.h"
#include "Common/Gui/Widgets.h"
#include "Common/Scene/Edit/ObjectMotion.h"

namespace rt::gui {
namespace {

constexpr ImU32 kMark = IM_COL32(255, 170, 40, 255);
constexpr float kLightRadius = 7; // of the mark of a light without extent, in the window's units

app::ViewProjection projectionOf(const Gui& gui) {
    const app::RenderSettings& settings = gui.state.settings;
    const double aspect = static_cast<double>(settings.width) / std::max(1u, settings.height);
    return {gui.camera.camera(), aspect};
}

ImVec2 inWindow(const glm::dvec2& place, const Rect& image) {
    return {image.x + static_cast<float>(place.x) * image.width, image.y + static_cast<float>(place.y) * image.height};
}

glm::dvec2 pointerPlace(const Rect& image) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    return {(mouse.x - image.x) / std::max(1.0f, image.width), (mouse.y - image.y) / std::max(1.0f, image.height)};
}

// What the click met, as soon as the description and the picture's scene name the same objects.
void resolveClick(Gui& gui) {
    SceneEditing& editing = gui.editing;
    if (!editing.click || !gui.editor.isInStep(gui.state)) return;
    const SceneEditing::Click click = *std::exchange(editing.click, std::nullopt);
    const auto surface = app::visibleSurface(*gui.state.scene, click.camera, {click.size[0], click.size[1]},
                                             {click.pixel[0], click.pixel[1]});
    if (!surface) return deselect(gui);
    const scene::ObjectPath path = pathOfLeaf(gui.editor.document()->scene(), surface->object);
    gui.editor.select(path);
    editing.revealsSelection = true;
    gui.settings.openPanels["objects"] = true;
    gui.revealPanel = "objects";
}

void tell(Gui& gui, const std::exception& error) {
    gui.fail(messageOf(error), app::ErrorSource::Scene);
}

void afterHistory(Gui& gui) {
    gui.editing.isListStale = true;
}

} // namespace

void followEditing(Gui& gui) {
    if (!gui.editor.isDirty()) gui.editing.isDiscarded = false;
    try {
        gui.editor.follow(gui.state);
    } catch (const std::exception& error) {
        gui.editing.goesOnAfterSaving = false;
        gui.editing.click.reset();
        tell(gui, error);
    }
    if (const auto file = gui.editor.takeSaved()) {
        gui.say("Saved " + *file);
        if (std::exchange(gui.editing.goesOnAfterSaving, false))
            if (const auto action = std::exchange(gui.editing.whenSaved, {})) action();
    }
    if (gui.editing.tool && !gui.editor.selection()) gui.editing.tool.reset();
    if (ImGui::IsMouseClicked(0)) gui.editing.pressGesture = gui.editor.newGesture();
    resolveClick(gui);
}

// ---- the history ---------------------------------------------------------------------------------------------------

bool editScene(Gui& gui, const std::string& name, std::vector<scene::SceneEdit> edits, bool isHeld) {
    try {
        const std::uint64_t gesture = isHeld && ImGui::IsMouseDown(0) ? gui.editing.pressGesture : 0;
        gui.editor.perform(name, std::move(edits), gesture);
        afterHistory(gui);
        return true;
    } catch (const Error& error) {
        tell(gui, error);
        return false;
    }
}

void undoEdit(Gui& gui) {
    if (gui.editing.tool) return endTool(gui, false);
    if (gui.editor.document() != nullptr) gui.editor.undo();
    afterHistory(gui);
}

void redoEdit(Gui& gui) {
    if (gui.editor.document() != nullptr && !gui.editing.tool) gui.editor.redo();
    afterHistory(gui);
}

void saveScene(Gui& gui) {
    if (gui.editor.document() == nullptr || gui.editor.isSaving()) return;
    std::error_code none;
    const std::filesystem::path file = gui.state.source;
    // What was imported stays what it is, and so does a built-in scene.
    if (file.extension() == ".json" && std::filesystem::is_regular_file(file, none))
        gui.editor.save(file.string());
    else
        saveSceneAs(gui);
}

void saveSceneAs(Gui& gui) {
    if (gui.editor.document() != nullptr) gui.browse(BrowseFor::SaveScene);
}

void onceSaved(Gui& gui, std::function<void()> action) {
    if (!gui.editor.isDirty()) return action();
    gui.editing.whenSaved = std::move(action);
}

void drawUnsaved(Gui& gui) {
    SceneEditing& editing = gui.editing;
    // The name of a file was not given after all, or it could not be written.
    const bool isGivenUp = editing.goesOnAfterSaving && !gui.browser.isOpen() && !gui.editor.isSaving();
    if (isGivenUp) editing.goesOnAfterSaving = false, editing.whenSaved = {};
    if (!editing.whenSaved || editing.goesOnAfterSaving) return;
    const ImVec2 size = ImGui::GetMainViewport()->Size;
    ImGui::SetNextWindowPos({0.5f * size.x, 0.4f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
    constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse |
                                        ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove;
    if (ImGui::Begin("Unsaved edits", nullptr, kFlags)) {
        ImGui::TextUnformatted("The scene has edits that are not saved.");
        if (button("Save them", "Into the scene's file, or one that is asked for", true)) {
            editing.goesOnAfterSaving = true;
            saveScene(gui);
        }
        ImGui::SameLine();
        if (button("Discard them", "They cannot be had back", true)) {
            editing.isDiscarded = true;
            std::exchange(editing.whenSaved, {})();
        }
        ImGui::SameLine();
        if (button("Go on editing", nullptr, true)) editing.whenSaved = {};
    }
    ImGui::End();
}

// ---- the selection -------------------------------------------------------------------------------------------------

void pickObject(Gui& gui, const std::array<std::uint32_t, 2>& pixel) {
    const image::Image* picture = gui.state.picture.image.get();
    if (picture == nullptr || !gui.state.scene) return;
    gui.editor.begin();
    gui.editing.click = SceneEditing::Click{gui.camera.camera(), pixel, {picture->width, picture->height}};
}

void deselect(Gui& gui) {
    if (gui.editing.tool) endTool(gui, false);
    if (gui.editor.document() != nullptr) gui.editor.select(std::nullopt);
}

void deleteSelection(Gui& gui) {
    if (!gui.editor.selection() || gui.editing.tool) return;
    const scene::ObjectPath path = *gui.editor.selection();
    if (editScene(gui, "Delete", {scene::PlaceObject{path, {}}}, false)) gui.editor.select(std::nullopt);
}

// Beside it by a fifth of its size, so that it is seen.
void duplicateSelection(Gui& gui) {
    if (!gui.editor.selection() || gui.editing.tool) return;
    const scene::SceneDesc& scene = gui.editor.document()->scene();
    scene::ObjectPath path = *gui.editor.selection();
    const scene::ObjectDesc copy = *findObject(scene, path);
    const auto bounds = gui.editor.selectionBounds(gui.state);
    const double size = bounds ? glm::length(bounds->upper - bounds->lower) : 0;
    ++path.indices.back();
    if (!editScene(gui, "Duplicate", {scene::PlaceObject{path, copy}}, false)) return;
    const glm::dvec3 right =
        glm::normalize(glm::cross(gui.camera.camera().lookAt - gui.camera.camera().lookFrom, gui.camera.camera().up));
    gui.editor.select(path);
    gui.editing.revealsSelection = true;
    if (size > 0) editScene(gui, "Move", {moved(scene, path, {scene::Translate{0.2 * size * right}})}, false);
}

void frameSelection(Gui& gui) {
    const auto bounds = gui.editor.selectionBounds(gui.state);
    if (!bounds) return gui.say("What is selected has no extent to be framed");
    gui.camera.frame(bounds->center(), bounds->radius(), projectionOf(gui).aspect());
}

// ---- tools ---------------------------------------------------------------------------------------------------------

void beginTool(Gui& gui, app::ObjectTool::Kind kind) {
    if (!gui.editor.selection()) return;
    if (gui.editing.tool) endTool(gui, false);
    const auto bounds = gui.editor.selectionBounds(gui.state);
    const auto light = lightPosition(gui.editor.document()->scene(), *gui.editor.selection());
    if (!bounds && !light) return gui.say("What is selected is nowhere that it could be moved from");
    const glm::dvec3 pivot = light ? *light : bounds->center();
    gui.editing.tool.emplace(kind, pivot, pointerPlace(gui.shownImage));
    gui.editing.toolGesture = gui.editor.newGesture();
}

void endTool(Gui& gui, bool isConfirmed) {
    if (!std::exchange(gui.editing.tool, std::nullopt)) return;
    if (!isConfirmed) gui.editor.giveUp(gui.editing.toolGesture);
    afterHistory(gui);
}

namespace {

void followPointer(Gui& gui, const Rect& image) {
    const app::ObjectTool& tool = *gui.editing.tool;
    const ImVec2 moved = ImGui::GetIO().MouseDelta;
    if (moved.x == 0 && moved.y == 0 && !gui.editing.isToolStale) return;
    gui.editing.isToolStale = false;
    const auto steps = tool.steps(projectionOf(gui), pointerPlace(image));
    if (!steps) return;
    constexpr const char* kNames[] = {"Move", "Turn", "Scale"};
    try {
        const scene::ObjectPath path = *gui.editor.selection();
        const auto edit = [&](const scene::SceneDesc& scene) { return scene::moved(scene, path, *steps); };
        gui.editor.performAnew(kNames[static_cast<int>(tool.kind())], edit, gui.editing.toolGesture);
        gui.say(tool.text(*steps));
    } catch (const Error& error) {
        tell(gui, error);
    }
}

// Its corners alone, which hide little of what is in it.
void drawBox(const scene::Bounds& bounds, const app::ViewProjection& view, const Rect& image, ImDrawList& list) {
    const auto corner = [&](int i) {
        const glm::dvec3 &a = bounds.lower, &b = bounds.upper;
        return glm::dvec3(i & 1 ? b.x : a.x, i & 2 ? b.y : a.y, i & 4 ? b.z : a.z);
    };
    constexpr double kShare = 0.2;            // of an edge, at either end
    for (const bool isShadow : {true, false}) // dark and light, so that it is seen on every picture
        for (int i = 0; i < 8; ++i)
            for (const int bit : {1, 2, 4}) {
                const glm::dvec3 from = corner(i), to = corner(i ^ bit);
                const auto edge = view.line(from, from + kShare * (to - from));
                if (!edge) continue;
                const ImU32 color = isShadow ? IM_COL32(0, 0, 0, 160) : kMark;
                list.AddLine(inWindow(edge->first, image), inWindow(edge->second, image), color,
                             isShadow ? 4.0f : 2.0f);
            }
}

void drawLight(const ImVec2& at, ImDrawList& list) {
    list.AddCircle(at, kLightRadius + 1, IM_COL32(0, 0, 0, 160), 0, 3);
    list.AddCircle(at, kLightRadius, kMark, 0, 1.5f);
    list.AddCircleFilled(at, 2, kMark);
}

} // namespace

void drawSelection(Gui& gui, const Rect& image, const Rect& area) {
    gui.shownImage = image;
    if (!gui.editor.selection() || !gui.state.picture.image) return;
    if (gui.editing.tool) followPointer(gui, image);
    if (!gui.editor.selection()) return;
    const app::ViewProjection view = projectionOf(gui);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.PushClipRect({area.x, area.y}, {area.x + area.width, area.y + area.height});
    if (const auto bounds = gui.editor.selectionBounds(gui.state)) drawBox(*bounds, view, image, list);
    if (const auto light = lightPosition(gui.editor.document()->scene(), *gui.editor.selection()))
        if (const auto place = view.place(*light)) drawLight(inWindow(*place, image), list);
    list.PopClipRect();
}

} // namespace rt::gui
