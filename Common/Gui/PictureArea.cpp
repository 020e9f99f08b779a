#include "Common/Gui/PictureArea.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <imgui.h>

#include "Common/App/Interactive/VisibleSurface.h"
#include "Common/Core/Format.h"
#include "Common/Core/Printable.h"
#include "Common/Gui/ObjectTools.h"
#include "Common/Gui/Theme.h"

namespace rt::gui {
namespace {

constexpr double kRadiansPerPixel = 0.004;
constexpr float kPixelScale = 4; // from here on pixels are squares, pixels of the window for one of the image
constexpr float kGridScale = 8;  // likewise for lines between them, in the window's units
constexpr float kZoomStep = 1.2f, kMinZoom = 0.02f, kMaxZoom = 64;
constexpr std::size_t kMaxNameBytes = 60; // of a material

} // namespace

// ---- where the picture lies ----------------------------------------------------------------------------------------

float PictureArea::fitScale() const {
    const image::Image* image = gui_.state.picture.image.get();
    if (image == nullptr || image->width == 0 || image->height == 0) return 1;
    return std::max(1e-3f, std::min(inner_.width / static_cast<float>(image->width),
                                    inner_.height / static_cast<float>(image->height)));
}

// Pixels of the film for one of the picture: a preview may have more.
float PictureArea::filmPixels() const {
    const image::Image* image = gui_.state.picture.image.get();
    if (image == nullptr || image->width == 0 || !gui_.state.picture.isPreview) return 1;
    return static_cast<float>(gui_.state.settings.width) / static_cast<float>(image->width);
}

std::uint32_t PictureArea::previewWidth() const {
    const float width = static_cast<float>(gui_.state.settings.width);
    const float height = static_cast<float>(gui_.state.settings.height);
    if (gui_.view.zoom > 0 || !(width > 0 && height > 0)) return 0;
    const float fit = std::min(inner_.width / width, inner_.height / height);
    const float shown = std::max(1.0f, fit * width * ImGui::GetIO().DisplayFramebufferScale.x);
    return static_cast<std::uint32_t>(std::lround(shown));
}

Rect PictureArea::imageRect() const {
    const image::Image* image = gui_.state.picture.image.get();
    if (image == nullptr) return inner_;
    const ImVec2 pixels = ImGui::GetIO().DisplayFramebufferScale;
    const PresentConstants place = constants();
    return {place.originX / pixels.x, place.originY / pixels.y, scale() * static_cast<float>(image->width),
            scale() * static_cast<float>(image->height)};
}

PresentConstants PictureArea::constants() const {
    const ImVec2 pixels = ImGui::GetIO().DisplayFramebufferScale;
    PresentConstants constants;
    if (const image::Image* image = gui_.state.picture.image.get()) {
        const float s = scale();
        const float left = inner_.x + 0.5f * (inner_.width - s * static_cast<float>(image->width)) + gui_.view.panX;
        const float top = inner_.y + 0.5f * (inner_.height - s * static_cast<float>(image->height)) + gui_.view.panY;
        // Whole pixels of the window: an image at 1:1 stays sharp.
        constants.originX = std::round(left * pixels.x);
        constants.originY = std::round(top * pixels.y);
        constants.scale = s * pixels.x;
    }
    constants.flags = (gui_.state.picture.isDisplay ? kPlainPicture : 0u) |
                      (gui_.pinned.isDisplay() ? kPlainHeld : 0u) | (showsPixels() ? 0u : kSmooth);
    if (gui_.pinned) compare(constants);
    constants.exposure = gui_.exposure();
    constants.curve = static_cast<std::uint32_t>(gui_.settings.tonemap);
    const Rgb surround = surroundColor(gui_.settings.colorMode);
    constants.surround[0] = surround.r;
    constants.surround[1] = surround.g;
    constants.surround[2] = surround.b;
    return constants;
}

// Of a picture so large that smoothing would only blur them.
bool PictureArea::showsPixels() const {
    return scale() * ImGui::GetIO().DisplayFramebufferScale.x > kPixelScale;
}

// Between pixels that are large enough for lines.
void PictureArea::drawGrid() const {
    const float side = scale();
    if (!gui_.showGrid || !showsPixels() || side < kGridScale) return;
    const Rect image = imageRect();
    const float left = std::max(image.x, area_.x), right = std::min(image.x + image.width, area_.x + area_.width);
    const float top = std::max(image.y, area_.y), bottom = std::min(image.y + image.height, area_.y + area_.height);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImU32 color = IM_COL32(128, 128, 128, 110);
    for (float x = image.x + std::ceil((left - image.x) / side) * side; x <= right; x += side)
        list.AddLine({x, top}, {x, bottom}, color);
    for (float y = image.y + std::ceil((top - image.y) / side) * side; y <= bottom; y += side)
        list.AddLine({left, y}, {right, y}, color);
}

bool PictureArea::isSplit() const {
    return gui_.pinned && gui_.compareBy == CompareBy::Split;
}

void PictureArea::compare(PresentConstants& constants) const {
    constexpr double kBlinkSeconds = 0.5;
    constexpr float kAll = 1e9f; // beyond every window
    const float density = ImGui::GetIO().DisplayFramebufferScale.x;
    switch (gui_.compareBy) {
        case CompareBy::Split:
            constants.split = (area_.x + gui_.split * area_.width) * density;
            break;
        case CompareBy::Blink:
            constants.split = std::fmod(ImGui::GetTime(), 2 * kBlinkSeconds) < kBlinkSeconds ? kAll : -kAll;
            break;
        case CompareBy::Difference:
            constants.split = -kAll;
            constants.flags |= kDifference;
    }
}

// ---- the mouse -----------------------------------------------------------------------------------------------------

std::optional<PictureArea::Pixel> PictureArea::pixelUnderPointer() const {
    const image::Image* image = gui_.state.picture.image.get();
    if (image == nullptr) return std::nullopt;
    const ImVec2 mouse = ImGui::GetIO().MousePos, pixels = ImGui::GetIO().DisplayFramebufferScale;
    const PresentConstants place = constants();
    const float x = std::floor((mouse.x * pixels.x - place.originX) / place.scale);
    const float y = std::floor((mouse.y * pixels.y - place.originY) / place.scale);
    if (!(x >= 0 && y >= 0 && x < static_cast<float>(image->width) && y < static_cast<float>(image->height))) {
        return std::nullopt;
    }
    return {{static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)}};
}

// Its name; empty where none is known.
std::string PictureArea::materialAt(const Pixel& pixel, const image::Image& picture) {
    const app::SessionState& state = gui_.state;
    const Seen now{state.sceneLoads, gui_.camera.camera(), {pixel[0], pixel[1], picture.width, picture.height}};
    if (!state.scene) return {};
    if (now != seen_) {
        seen_ = now;
        const auto surface =
            app::visibleSurface(*state.scene, now.camera, {picture.width, picture.height}, {pixel[0], pixel[1]});
        seenMaterial_ = surface ? state.scene->materialNames[surface->material] : "";
    }
    return seenMaterial_;
}

// A frame around it, dark and light, so that it is seen on every picture.
void PictureArea::mark(const Pixel& pixel) const {
    const Rect image = imageRect();
    const float side = scale(), minimum = std::max(side, 5.0f), grow = 0.5f * (minimum - side);
    const ImVec2 low{image.x + side * static_cast<float>(pixel[0]) - grow,
                     image.y + side * static_cast<float>(pixel[1]) - grow};
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddRect({low.x - 1, low.y - 1}, {low.x + minimum + 1, low.y + minimum + 1}, IM_COL32_BLACK);
    list.AddRect(low, {low.x + minimum, low.y + minimum}, IM_COL32_WHITE);
}

// What the inspector says of a pixel.
void PictureArea::inspect(const std::optional<Pixel>& pixel) {
    gui_.inspected.clear();
    const app::Picture& picture = gui_.state.picture;
    if (!gui_.viewRequest.inspect || !pixel || !picture.radiance) return;
    gui_.inspected = inspectPixel(picture, gui_.pinned.radiance().get(), *pixel);
    if (gui_.inspected.empty()) return;
    mark(*pixel);
    const std::string material = materialAt(*pixel, *picture.radiance);
    if (!material.empty()) gui_.inspected.push_back({"material", printable(material, kMaxNameBytes), "", ""});
}

void PictureArea::handlePointer() {
    const ImGuiIO& io = ImGui::GetIO();
    const bool inside = area_.contains(io.MousePos.x, io.MousePos.y) && !io.WantCaptureMouse;
    if (inside && (io.MouseClicked[0] || io.MouseClicked[1] || io.MouseClicked[2])) {
        dragging_ = true;
        ImGui::SetWindowFocus(nullptr);
    }
    if (!io.MouseDown[0] && !io.MouseDown[1] && !io.MouseDown[2]) dragging_ = false;
    gui_.shownScale = scale() * io.DisplayFramebufferScale.x / filmPixels();
    drawGrid();
    const std::optional<Pixel> pixel = inside ? pixelUnderPointer() : std::nullopt;
    inspect(pixel);
    takeMaterial();
    const bool isPicking = gui_.materials.isPicking; // the click is for the pipette
    const bool mayHold = !gui_.editing.tool && !isPicking;
    if (mayHold && (holdSampledPoint(gui_, inside, pixel) || holdNoisyPixel(gui_, inside, pixel))) {
        dragging_ = false; // what moves the point does not orbit
        return;
    }
    if (gui_.editing.tool || (!isPicking && gripGizmo(gui_, imageRect(), inside))) return handleTool(pixel);
    select(inside, pixel);
    if (inside && io.MouseClicked[0] && (gui_.pickFocus || (io.KeyCtrl && io.KeyShift))) {
        gui_.pickFocus = false;
        dragging_ = false; // the press that picks does not orbit
        if (pixel)
            gui_.session.pickFocus((*pixel)[0], (*pixel)[1]);
        else
            gui_.say("The picture is elsewhere: nothing was picked");
    } else if (dragging_ && io.MouseDown[0] && isSplit() && !io.KeyAlt && !isAdding_) {
        gui_.split = std::clamp((io.MousePos.x - area_.x) / std::max(1.0f, area_.width), 0.0f, 1.0f);
    }
    if (dragging_ && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) drag();
    if (inside && io.MouseWheel != 0) turnWheel();
}

// A click, or of the gizmo the release, says where the object stays that the pointer has, and does nothing else; but a
// click on a handle that goes nowhere is one on what is behind that.
void PictureArea::handleTool(const std::optional<Pixel>& pixel) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool isDrag = gui_.editing.drag.has_value();
    dragging_ = isClick_ = false;
    followTool(gui_, imageRect());
    if (io.MouseClicked[1]) return endTool(gui_, false);
    if (!isDrag && io.MouseClicked[0]) return endTool(gui_, true);
    if (!isDrag || io.MouseDown[0]) return;
    const bool isClick = !isDragged(gui_);
    endTool(gui_, !isClick);
    if (isClick && pixel) pickObject(gui_, *pixel, io.KeyCtrl);
}

// One that is dragged out of the library and let go above the picture, or a file, when the pointer is where it was let
// go. The mouse is not the picture's meanwhile.
void PictureArea::takeMaterial() {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const bool isFile = !gui_.materials.droppedFile.empty();
    if (isFile ? gui_.window.hasEvents() : !gui_.materials.dragged || ImGui::IsMouseDown(0)) return;
    constexpr ImGuiHoveredFlags kAnywhere =
        ImGuiHoveredFlags_AnyWindow | ImGuiHoveredFlags_AllowWhenBlockedByActiveItem;
    const bool isHere = area_.contains(mouse.x, mouse.y) && !ImGui::IsWindowHovered(kAnywhere);
    dropMaterial(gui_, isHere ? pixelUnderPointer() : std::nullopt);
}

// By a press and its release, unless the pointer has been dragged in between.
void PictureArea::select(bool inside, const std::optional<Pixel>& pixel) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.MouseClicked[0]) {
        isAdding_ = io.KeyCtrl;
        isClick_ = inside && !gui_.pickFocus && !(io.KeyCtrl && io.KeyShift) && !io.KeyAlt && (isAdding_ || !isSplit());
    }
    if (ImGui::IsMouseDragging(0)) isClick_ = false;
    if (!io.MouseReleased[0] || !std::exchange(isClick_, false) || !inside) return;
    if (gui_.materials.isPicking && pixel) return pickMaterial(gui_, *pixel);
    if (pixel) return pickObject(gui_, *pixel, isAdding_);
    if (!isAdding_) deselect(gui_);
}

void PictureArea::drag() {
    const ImGuiIO& io = ImGui::GetIO();
    const double dx = io.MouseDelta.x, dy = io.MouseDelta.y;
    const float height = imageRect().height;
    if (io.MouseDown[1] && io.KeyCtrl) {
        gui_.view.panX += io.MouseDelta.x;
        gui_.view.panY += io.MouseDelta.y;
        gui_.view.zoom = scale() / filmPixels();
    } else if (io.MouseDown[1]) {
        gui_.camera.look(-kRadiansPerPixel * dx, -kRadiansPerPixel * dy);
    } else if (io.MouseDown[0] && (io.KeyAlt || (!isSplit() && ImGui::IsMouseDragging(0)))) {
        // Alone from ImGui's threshold on, so that a click with an unsteady hand starts no new film.
        gui_.camera.orbit(-kRadiansPerPixel * dx, -kRadiansPerPixel * dy);
    } else if (io.MouseDown[2] && height > 0) {
        gui_.camera.pan(-dx / height, dy / height);
    }
}

void PictureArea::turnWheel() {
    const ImGuiIO& io = ImGui::GetIO();
    if (!io.KeyShift && !io.KeyAlt && !io.MouseDown[1]) { // about the pointer
        const float before = scale();
        const float after = std::clamp(before * std::pow(kZoomStep, io.MouseWheel), kMinZoom, kMaxZoom);
        const float x = io.MousePos.x - inner_.x - 0.5f * inner_.width;
        const float y = io.MousePos.y - inner_.y - 0.5f * inner_.height;
        gui_.view.panX = x - (x - gui_.view.panX) * after / before;
        gui_.view.panY = y - (y - gui_.view.panY) * after / before;
        gui_.view.zoom = after / filmPixels();
    } else if (io.KeyShift) {
        gui_.camera.dolly(io.MouseWheel);
    } else {
        gui_.camera.changeSpeed(io.MouseWheel);
        gui_.say(formatted("Flying speed %.3g", gui_.camera.speed()));
    }
}

} // namespace rt::gui
