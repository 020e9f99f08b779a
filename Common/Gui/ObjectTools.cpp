#include "Common/Gui/ObjectTools.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "Common/App/Interactive/Gizmo.h"
#include "Common/Core/Error.h"
#include "Common/Gui/PicturePlaces.h"
#include "Common/Gui/SceneEditing.h"
#include "Common/Gui/Theme.h"
#include "Common/Scene/Edit/ObjectMotion.h"

namespace rt::gui {
namespace {

constexpr float kArmLength = 5.5f, kReachOfPointer = 0.55f; // of the gizmo, in heights of letters
constexpr float kDragThreshold = 2;                         // from the press on, in the window's units
constexpr ImU32 kShade = IM_COL32(0, 0, 0, 150);            // around lines, so that they are seen on every picture
constexpr ImU32 kLit = IM_COL32(255, 230, 100, 255);        // the handle that the pointer has
constexpr const char* kLetters[] = {"X", "Y", "Z"};

float lineWidth() {
    return ImGui::GetFontSize() / 6.5f;
}

double inHeights(float length, const Rect& image) {
    return length / std::max(1.0f, image.height);
}

// Where the gizmo is, and keyboard's axes are: nothing where what is selected is nowhere. What has just been moved is
// where it was left, until the picture shows it there.
std::optional<app::ToolAxes> restingAxes(Gui& gui) {
    SceneEditing& editing = gui.editing;
    if (!gui.editor.selection()) return std::nullopt;
    const std::uint64_t selection = gui.editor.selected().serial();
    const bool isKept = editing.axes && editing.axesSelection == selection && !gui.editor.isUpToDate(gui.state);
    if (isKept) return editing.axes;
    editing.axes.reset();
    editing.axesSelection = selection;
    const scene::Bounds& bounds = gui.editor.outline(gui.state).all;
    if (bounds.empty()) return std::nullopt;
    editing.axes.emplace();
    editing.axes->pivot = bounds.center();
    if (gui.settings.localAxes)
        editing.axes->directions = localAxes(gui.editor.document()->scene(), *gui.editor.selection());
    return editing.axes;
}

bool isGizmoShown(const Gui& gui) {
    return gui.settings.showGizmo && gui.editor.selection() && gui.state.picture.image && !gui.pickFocus;
}

std::vector<app::GizmoHandle> handlesNow(Gui& gui, const Rect& image) {
    const auto axes = gui.editing.tool ? gui.editing.axes : restingAxes(gui);
    if (!axes) return {};
    const double size = inHeights(kArmLength * ImGui::GetFontSize(), image);
    return app::gizmoHandles(gui.settings.gizmo, *axes, projectionOf(gui), size);
}

// The copies are what moves; they and their way are one step.
bool beginWithCopies(Gui& gui) {
    GizmoDrag& drag = *gui.editing.drag;
    drag.duplicates = false;
    drag.originals = gui.editor.selected().paths();
    drag.copyGesture = gui.editor.newGesture();
    std::vector<scene::ObjectPath> copies;
    try {
        auto edits = duplicated(gui.editor.document()->scene(), drag.originals, copies);
        gui.editor.perform("Duplicate", std::move(edits), drag.copyGesture);
    } catch (const Error& error) {
        gui.fail(error.what(), app::ErrorSource::Scene);
        return false;
    }
    gui.editor.select(copies, copies.back());
    gui.editing.axesSelection = gui.editor.selected().serial(); // where the originals are
    gui.editing.revealsSelection = true;
    return true;
}

} // namespace

// ---- tools ---------------------------------------------------------------------------------------------------------

void beginTool(Gui& gui, app::ObjectTool::Kind kind) {
    if (!gui.editor.selection()) return;
    if (gui.editing.tool) endTool(gui, false);
    const auto axes = restingAxes(gui);
    if (!axes) return gui.say("What is selected is nowhere that it could be moved from");
    gui.editing.tool.emplace(kind, *axes, placeInPicture(ImGui::GetIO().MousePos, gui.shownImage));
    gui.editing.toolGesture = gui.editor.newGesture();
}

void endTool(Gui& gui, bool isConfirmed) {
    SceneEditing& editing = gui.editing;
    if (!editing.tool) return;
    const app::ToolAxes began = editing.tool->axes();
    editing.tool.reset();
    editing.toolText.clear();
    const bool hasMoved = std::exchange(editing.hasMoved, false);
    if (!isConfirmed) {
        gui.editor.giveUp(editing.toolGesture);
        editing.axes = began;
    }
    if (const auto drag = std::exchange(editing.drag, std::nullopt); drag && !drag->originals.empty()) {
        if (isConfirmed && hasMoved) {
            gui.editor.joinSteps("Duplicate");
        } else {
            gui.editor.giveUp(drag->copyGesture);
            gui.editor.select(drag->originals, drag->originals.back());
            editing.axesSelection = gui.editor.selected().serial();
        }
    }
    editing.isListStale = true;
}

bool isDragged(const Gui& gui) {
    return gui.editing.drag && gui.editing.drag->hasBegun;
}

void followTool(Gui& gui, const Rect& image) {
    SceneEditing& editing = gui.editing;
    const ImGuiIO& io = ImGui::GetIO();
    if (editing.drag && !editing.drag->hasBegun) {
        if (!ImGui::IsMouseDragging(0, kDragThreshold)) return;
        editing.drag->hasBegun = true;
        editing.isToolStale = true;
        if (editing.drag->duplicates && !beginWithCopies(gui)) return endTool(gui, false);
    }
    const bool isOtherSnap = std::exchange(editing.isSnapped, io.KeyCtrl) != io.KeyCtrl;
    if (io.MouseDelta.x == 0 && io.MouseDelta.y == 0 && !isOtherSnap && !editing.isToolStale) return;
    editing.isToolStale = false;
    const app::ObjectTool& tool = *editing.tool;
    const auto motion = tool.motion(projectionOf(gui), placeInPicture(io.MousePos, image), editing.isSnapped);
    if (!motion) return;
    constexpr const char* kNames[] = {"Move", "Turn", "Scale"};
    try {
        const std::vector<scene::ObjectPath>& paths = gui.editor.selected().paths();
        const auto edits = [&](const scene::SceneDesc& scene) { return movedAll(scene, paths, motion->steps); };
        const std::string name = kNames[static_cast<int>(tool.kind())] + ofHowMany(paths.size());
        editing.hasMoved = false;
        gui.editor.performAnew(name, edits, editing.toolGesture);
        editing.hasMoved = true;
        editing.toolText = motion->text;
        editing.axes = tool.axes();
        editing.axes->pivot = toAffine(motion->steps).point(tool.axes().pivot);
        editing.axesSelection = gui.editor.selected().serial();
    } catch (const Error& error) {
        gui.fail(error.what(), app::ErrorSource::Scene);
    }
}

// ---- the gizmo -----------------------------------------------------------------------------------------------------

bool gripGizmo(Gui& gui, const Rect& image, bool isInside) {
    SceneEditing& editing = gui.editing;
    const ImGuiIO& io = ImGui::GetIO();
    editing.hovered.reset();
    if (!isInside || !isGizmoShown(gui) || io.KeyAlt || io.MouseDown[1] || io.MouseDown[2]) return false;
    if (io.MouseDown[0] && !io.MouseClicked[0]) return false; // for something else
    const std::vector<app::GizmoHandle> handles = handlesNow(gui, image);
    const glm::dvec2 place = placeInPicture(io.MousePos, image);
    const double reach = inHeights(kReachOfPointer * ImGui::GetFontSize(), image);
    const app::ViewProjection view = projectionOf(gui);
    const app::GizmoHandle* handle = handleAt(handles, view.aspect(), place, reach);
    if (handle == nullptr) return false;
    editing.hovered.emplace(handle->constraint);
    if (!io.MouseClicked[0]) return false;
    const double arm = inHeights(kArmLength * ImGui::GetFontSize(), image) * view.heightAt(editing.axes->pivot);
    editing.tool.emplace(gui.settings.gizmo, *editing.axes, place, handle->constraint, arm);
    editing.toolGesture = gui.editor.newGesture();
    editing.drag.emplace();
    editing.drag->duplicates = io.KeyShift;
    return true;
}

namespace {

ImU32 axisColorOf(int axis) {
    return ImGui::ColorConvertFloat4ToU32(axisColor(axis));
}

void drawLines(const app::GizmoHandle& handle, const Rect& image, ImU32 color, float width, ImDrawList& list) {
    for (const auto& [from, to] : handle.lines) list.AddLine(inWindow(from, image), inWindow(to, image), color, width);
}

// An arrow's head or a box, at the end of an arm.
void drawEnd(const app::GizmoHandle::Line& arm, bool isBox, const Rect& image, ImU32 color, float size,
             ImDrawList& list) {
    const ImVec2 from = inWindow(arm.first, image), end = inWindow(arm.second, image);
    if (isBox) return list.AddRectFilled({end.x - size, end.y - size}, {end.x + size, end.y + size}, color);
    const float x = end.x - from.x, y = end.y - from.y, length = std::max(1e-3f, std::sqrt(x * x + y * y));
    const ImVec2 ahead{1.4f * size * x / length, 1.4f * size * y / length}, aside{-0.7f * ahead.y, 0.7f * ahead.x};
    list.AddTriangleFilled({end.x + ahead.x, end.y + ahead.y}, {end.x - ahead.x + aside.x, end.y - ahead.y + aside.y},
                           {end.x - ahead.x - aside.x, end.y - ahead.y - aside.y}, color);
}

void drawArea(const app::GizmoHandle& handle, const Rect& image, ImU32 color, ImU32 edge, ImDrawList& list) {
    if (handle.area.size() != 4) return;
    ImVec2 p[4];
    for (std::size_t i = 0; i < 4; ++i) p[i] = inWindow(handle.area[i], image);
    list.AddQuadFilled(p[0], p[1], p[2], p[3], color);
    list.AddQuad(p[0], p[1], p[2], p[3], edge, 1.5f);
}

void drawLetter(int axis, const ImVec2& at, ImU32 color, ImDrawList& list) {
    const ImVec2 size = ImGui::CalcTextSize(kLetters[axis]);
    const ImVec2 corner{std::round(at.x - 0.5f * size.x), std::round(at.y - 0.5f * size.y)};
    list.AddCircleFilled(at, 0.62f * ImGui::GetFontSize(), kShade);
    list.AddText(corner, color, kLetters[axis]);
}

void drawHandle(const Gui& gui, const app::GizmoHandle& handle, bool isLit, const Rect& image, ImDrawList& list) {
    const float width = lineWidth(), size = 2.2f * width;
    const ImU32 plain = axisColorOf(handle.constraint ? handle.constraint->axis : -1);
    const ImU32 color = isLit ? kLit : plain;
    const bool isBox = gui.settings.gizmo == app::ObjectTool::Kind::Scale;
    drawLines(handle, image, kShade, 2 * width, list);
    if (handle.arm) drawEnd(*handle.arm, isBox, image, kShade, size + 0.5f * width, list);
    drawLines(handle, image, color, width, list);
    if (handle.arm) drawEnd(*handle.arm, isBox, image, color, size, list);
    drawArea(handle, image, (color & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, isLit ? 190 : 110), color, list);
    if (handle.letter && handle.constraint)
        drawLetter(handle.constraint->axis, inWindow(*handle.letter, image), color, list);
}

// Of a tool that is bound to an axis, through all of the picture.
void drawAxis(const Gui& gui, const Rect& image, ImDrawList& list) {
    const auto& constraint = gui.editing.tool->constraint();
    if (!constraint || constraint->isPlane || !gui.editing.axes) return;
    const app::ViewProjection view = projectionOf(gui);
    const glm::dvec3 &middle = gui.editing.axes->pivot,
                     &way = 20 * view.heightAt(middle) * gui.editing.axes->directions[constraint->axis];
    const auto line = view.line(middle - way, middle + way);
    if (!line) return;
    const ImVec2 from = inWindow(line->first, image), to = inWindow(line->second, image);
    list.AddLine(from, to, kShade, 3);
    list.AddLine(from, to, axisColorOf(constraint->axis), 1.5f);
}

// What the tool does, beside the pointer.
void drawToolText(const Gui& gui, const Rect& area) {
    const std::string& text = gui.editing.toolText;
    if (text.empty()) return;
    const ImVec2 mouse = ImGui::GetIO().MousePos, size = ImGui::CalcTextSize(text.c_str());
    const float gap = 0.4f * ImGui::GetFontSize(), away = 1.4f * ImGui::GetFontSize();
    const float right = area.x + area.width - size.x - gap, bottom = area.y + area.height - size.y - gap;
    const ImVec2 at{std::max(area.x + gap, std::min(mouse.x + away, right)),
                    std::max(area.y + gap, std::min(mouse.y + away, bottom))};
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    list.AddRectFilled({at.x - gap, at.y - gap}, {at.x + size.x + gap, at.y + size.y + gap},
                       ImGui::GetColorU32(ImGuiCol_PopupBg), 3);
    list.AddRect({at.x - gap, at.y - gap}, {at.x + size.x + gap, at.y + size.y + gap},
                 ImGui::GetColorU32(ImGuiCol_Border), 3);
    list.AddText(at, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
}

} // namespace

void drawTools(Gui& gui, const Rect& image, const Rect& area) {
    const bool isHeld = gui.editing.drag.has_value();
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImVec2 low{std::max(image.x, area.x), std::max(image.y, area.y)};
    const ImVec2 high{std::min(image.x + image.width, area.x + area.width),
                      std::min(image.y + image.height, area.y + area.height)};
    if (low.x >= high.x || low.y >= high.y) return;
    list.PushClipRect(low, high);
    if (gui.editing.tool) drawAxis(gui, image, list);
    if (isGizmoShown(gui) && (isHeld || !gui.editing.tool))
        for (const app::GizmoHandle& handle : handlesNow(gui, image)) {
            const bool isLit = isHeld ? handle.constraint == gui.editing.tool->constraint()
                                      : gui.editing.hovered && *gui.editing.hovered == handle.constraint;
            if (isLit || !isDragged(gui)) drawHandle(gui, handle, isLit, image, list);
        }
    list.PopClipRect();
    if (gui.editing.tool) drawToolText(gui, area);
}

} // namespace rt::gui
