#include "Common/Gui/PointPicker.h"

#include <cmath>
#include <utility>

#include "Common/Gui/Gui.h"
#include "Common/Gui/PicturePlaces.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr float kPointRadius = 6, kReach = 11; // of the mark, and of the pointer that takes it, in the window's units

void setPoint(Gui& gui, PointPicker& picker, const std::array<std::uint32_t, 2>& pixel) {
    const image::Image& picture = *gui.state.picture.image;
    picker.point = PickedPixel{
        gui.camera.camera(), pixel, {picture.width, picture.height}, gui.state.source, gui.state.sceneReads};
}

// A scene that is saved under a name is the one that it was; so is one that is read anew from where it was.
bool isOfAnotherScene(const Gui& gui, PickedPixel& point) {
    const bool isRead = std::exchange(point.reads, gui.state.sceneReads) != gui.state.sceneReads;
    const bool isElsewhere = std::exchange(point.source, gui.state.source) != gui.state.source;
    return isRead && isElsewhere;
}

} // namespace

bool followPicker(const Gui& gui, PointPicker& picker) {
    if (picker.point && isOfAnotherScene(gui, *picker.point)) picker.point.reset();
    if (std::exchange(picker.isShown, false)) return true;
    picker.isPicking = picker.isDragged = false;
    return false;
}

void drawPickButton(PointPicker& picker, const char* label, float width) {
    if (button(picker.isPicking ? "Click in the picture" : label,
               "Then click in the picture; the point can be dragged there", true, width))
        picker.isPicking = !picker.isPicking;
}

std::optional<ImVec2> placeInWindow(const Gui& gui, const glm::dvec3& place, const Rect& image) {
    const auto inPicture = projectionOf(gui).place(place);
    if (!inPicture) return std::nullopt;
    return inWindow(*inPicture, image);
}

bool holdPoint(Gui& gui, PointPicker& picker, const std::optional<ImVec2>& mark, bool isInside,
               const std::optional<std::array<std::uint32_t, 2>>& pixel) {
    if (!picker.isShown || !gui.state.picture.image) return false;
    const ImGuiIO& io = ImGui::GetIO();
    if (isInside && io.MouseClicked[0]) {
        const bool isOnMark = mark && std::hypot(io.MousePos.x - mark->x, io.MousePos.y - mark->y) < kReach;
        picker.isDragged = std::exchange(picker.isPicking, false) || isOnMark;
        if (picker.isDragged && !pixel) gui.say("The picture is elsewhere: nothing was picked");
    }
    if (!picker.isDragged) return false;
    if (pixel && (io.MouseDown[0] || io.MouseClicked[0])) setPoint(gui, picker, *pixel);
    if (!io.MouseDown[0]) picker.isDragged = false; // its release selects nothing
    return true;
}

void drawPointMark(const ImVec2& mark, const Rect& area, ImU32 color) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.PushClipRect({area.x, area.y}, {area.x + area.width, area.y + area.height});
    for (const bool isShadow : {true, false}) { // dark and light, so that it is seen on every picture
        const ImU32 drawn = isShadow ? IM_COL32(0, 0, 0, 180) : color;
        const float thickness = isShadow ? 4.0f : 2.0f, from = 0.4f * kPointRadius, to = 1.6f * kPointRadius;
        list.AddCircle(mark, kPointRadius, drawn, 0, thickness);
        for (const ImVec2 way : {ImVec2(1, 0), ImVec2(-1, 0), ImVec2(0, 1), ImVec2(0, -1)})
            list.AddLine({mark.x + from * way.x, mark.y + from * way.y}, {mark.x + to * way.x, mark.y + to * way.y},
                         drawn, thickness);
    }
    list.PopClipRect();
}

} // namespace rt::gui
