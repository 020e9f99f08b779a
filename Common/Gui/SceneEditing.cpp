#include "Common/Gui/SceneEditing.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <imgui.h>

#include "Common/App/Interactive/VisibleSurface.h"
#include "Common/Core/Error.h"
#include "Common/Gui/Gui.h"
#include "Common/Gui/ObjectTools.h"
#include "Common/Gui/PicturePlaces.h"
#include "Common/Gui/Theme.h"
#include "Common/Gui/Widgets.h"
#include "Common/Scene/Edit/ObjectMotion.h"
#include "Common/Scene/Edit/Visibility.h"

namespace rt::gui {
namespace {

constexpr ImU32 kMark = IM_COL32(255, 170, 40, 255);
constexpr std::size_t kMostBoxes = 200; // of as many objects each is outlined; of more all in one
constexpr float kLightRadius = 7;       // of the mark of a light without extent, in the window's units

// What the click met, as soon as the description and the picture's scene name the same objects.
void resolveClick(Gui& gui) {
    SceneEditing& editing = gui.editing;
    if (!editing.click || !gui.editor.isInStep(gui.state)) return;
    const SceneEditing::Click click = *std::exchange(editing.click, std::nullopt);
    const auto surface = app::visibleSurface(*gui.state.scene, click.camera, {click.size[0], click.size[1]},
                                             {click.pixel[0], click.pixel[1]});
    if (!surface) return click.isAdded ? void() : deselect(gui);
    const scene::ObjectPath path = pathOfLeaf(gui.editor.document()->scene(), surface->object);
    click.isAdded ? gui.editor.toggle(path) : gui.editor.select(path);
    editing.rangeStart = path;
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
    if (gui.editing.tool && !gui.editor.selection()) {
        gui.editing.tool.reset(); // with the scene that it was of
        gui.editing.drag.reset();
    }
    if (ImGui::IsMouseClicked(0)) gui.editing.pressGesture = gui.editor.newGesture();
    resolveClick(gui);
}

std::vector<scene::SceneEdit> movedAll(const scene::SceneDesc& scene, const std::vector<scene::ObjectPath>& paths,
                                       const scene::Transform& steps) {
    std::vector<scene::SceneEdit> edits;
    edits.reserve(paths.size());
    for (const scene::ObjectPath& path : paths) edits.push_back(moved(scene, path, steps));
    return edits;
}

std::string ofHowMany(std::size_t count) {
    return count == 1 ? "" : " " + std::to_string(count) + " objects";
}

// ---- the history ---------------------------------------------------------------------------------------------------

bool editScene(Gui& gui, const std::string& name, std::vector<scene::SceneEdit> edits, bool isHeld) {
    if (edits.empty()) return false;
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
    gui.editing.goesOnAfterSaving = gui.editor.isDirtyUntilSaved();
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
        if (button("Discard them", "They cannot be recovered afterwards", true)) std::exchange(editing.whenSaved, {})();
        ImGui::SameLine();
        if (button("Go on editing", nullptr, true)) editing.whenSaved = {};
    }
    ImGui::End();
}

// ---- the selection -------------------------------------------------------------------------------------------------

void pickObject(Gui& gui, const std::array<std::uint32_t, 2>& pixel, bool isAdded) {
    const image::Image* picture = gui.state.picture.image.get();
    if (picture == nullptr || !gui.state.scene) return;
    gui.editor.begin();
    gui.editing.click = SceneEditing::Click{gui.camera.camera(), pixel, {picture->width, picture->height}, isAdded};
}

void deselect(Gui& gui) {
    if (gui.editing.tool) endTool(gui, false);
    if (gui.editor.document() != nullptr) gui.editor.select(std::nullopt);
}

void deleteSelection(Gui& gui) {
    if (!gui.editor.selection() || gui.editing.tool) return;
    const std::vector<scene::ObjectPath> paths = gui.editor.selected().paths();
    gui.editor.select(std::nullopt);
    std::vector<scene::SceneEdit> edits = removed(paths);
    for (scene::SceneEdit& edit : app::editsToDrop(gui.editor.document()->scene(), paths))
        edits.push_back(std::move(edit));
    if (!editScene(gui, "Delete" + ofHowMany(paths.size()), std::move(edits), false))
        gui.editor.select(paths, paths.back());
}

namespace {

glm::dvec3 rightOf(const scene::CameraDesc& camera) {
    return glm::normalize(glm::cross(camera.lookAt - camera.lookFrom, camera.up));
}

} // namespace

// Beside itself by a fifth of its size, so that it is seen.
void duplicateSelection(Gui& gui) {
    if (!gui.editor.selection() || gui.editing.tool) return;
    const scene::Bounds& bounds = gui.editor.outline(gui.state).all;
    const double size = bounds.empty() ? 0 : glm::length(bounds.upper - bounds.lower);
    const std::string name = "Duplicate" + ofHowMany(gui.editor.selected().size());
    std::vector<scene::ObjectPath> copies;
    auto edits = duplicated(gui.editor.document()->scene(), gui.editor.selected().paths(), copies);
    if (!editScene(gui, name, std::move(edits), false)) return;
    gui.editor.select(copies, copies.back());
    gui.editing.revealsSelection = true;
    const scene::Transform steps = {scene::Translate{0.2 * size * rightOf(gui.camera.camera())}};
    if (size > 0 && editScene(gui, "Move", movedAll(gui.editor.document()->scene(), copies, steps), false))
        gui.editor.joinSteps(name);
}

void hideObjects(Gui& gui, const std::vector<scene::ObjectPath>& paths, bool areHidden) {
    if (gui.editing.tool) endTool(gui, false);
    editScene(gui, areHidden ? "Hide" : "Show", hidden(gui.editor.document()->scene(), paths, areHidden), false);
}

void hideSelection(Gui& gui) {
    const std::vector<scene::ObjectPath>& paths = gui.editor.selected().paths();
    const scene::SceneDesc& scene = gui.editor.document()->scene();
    const auto isHidden = [&](const scene::ObjectPath& path) { return findObject(scene, path)->hidden; };
    hideObjects(gui, paths, !std::all_of(paths.begin(), paths.end(), isHidden));
}

void soloSelection(Gui& gui) {
    if (gui.editing.tool) endTool(gui, false);
    auto edits = soloed(gui.editor.document()->scene(), gui.editor.selected().paths());
    if (edits.empty()) return gui.say("All else is hidden by now: Alt+H shows it");
    editScene(gui, "Solo", std::move(edits), false);
}

void showAllObjects(Gui& gui) {
    if (gui.editor.document() == nullptr) return;
    if (gui.editing.tool) endTool(gui, false);
    editScene(gui, "Show all", allShown(gui.editor.document()->scene()), false);
}

void assignMaterial(Gui& gui, const std::string& name) {
    std::vector<scene::SceneEdit> edits;
    for (const scene::ObjectPath& path : gui.editor.selected().paths())
        if (materialNameOf(*findObject(gui.editor.document()->scene(), path)) != nullptr)
            edits.emplace_back(scene::SetMaterialOf{path, name});
    editScene(gui, "Assign material", std::move(edits), false);
}

void frameSelection(Gui& gui) {
    const scene::Bounds& bounds = gui.editor.outline(gui.state).all;
    if (!(bounds.radius() > 0)) return gui.say("What is selected has no extent to be framed");
    gui.camera.frame(bounds.center(), bounds.radius(), projectionOf(gui).aspect());
}

// ---- the outline --------------------------------------------------------------------------------------------------

namespace {

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

void drawOutline(Gui& gui, const Rect& image, const Rect& area, const scene::CameraDesc& camera) {
    if (!gui.editor.selection() || !gui.state.picture.image) return;
    const app::ViewProjection view = projectionOf(gui, camera);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.PushClipRect({area.x, area.y}, {area.x + area.width, area.y + area.height});
    const app::SelectionOutline& outline = gui.editor.outline(gui.state);
    if (outline.boxes.size() <= kMostBoxes)
        for (const scene::Bounds& box : outline.boxes) drawBox(box, view, image, list);
    else
        drawBox(outline.all, view, image, list);
    for (std::size_t i = 0; i < std::min(outline.lights.size(), kMostBoxes); ++i)
        if (const auto place = view.place(outline.lights[i])) drawLight(inWindow(*place, image), list);
    list.PopClipRect();
}

} // namespace

void drawSelection(Gui& gui, const Rect& image, const Rect& area) {
    gui.shownImage = image;
    drawOutline(gui, image, area, gui.camera.camera());
}

void drawSelectionOfOther(Gui& gui, const Rect& image, const Rect& area) {
    const app::Picture& picture = gui.state.picture;
    if (picture.camera && picture.sceneEdits == gui.state.sceneEdits) drawOutline(gui, image, area, *picture.camera);
}

} // namespace rt::gui
