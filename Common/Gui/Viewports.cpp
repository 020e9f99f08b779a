#include "Common/Gui/Viewports.h"

#include <algorithm>
#include <exception>
#include <utility>

#include <imgui.h>

#include "Common/Gui/Theme.h"

namespace rt::gui {
namespace {

constexpr float kGap = 6, kFrame = 2; // between viewports, and around the one that has the focus, at scale 1

} // namespace

Viewports::Viewports(Gui& gui, SessionLink& link, Presenter& presenter)
    : gui_(gui), link_(link), presenter_(presenter), first_(gui.session.addressed()) {
    seats_.resize(std::max<std::size_t>(1, gui.settings.viewports.size()));
    seats_[focus()].id = first_;
    gui_.settings.viewports.resize(count() > 1 ? count() : 0);
}

// ---- who has the focus ---------------------------------------------------------------------------------------------

// What the Gui has and what waits at that place change places; the session's requests are of what the Gui has.
void Viewports::exchange(std::size_t place) {
    Seat& seat = seats_[place];
    std::swap(gui_.state, seat.state);
    std::swap(gui_.camera, seat.camera);
    std::swap(gui_.view, seat.view);
    std::swap(gui_.viewRequest, seat.viewRequest);
    std::swap(gui_.pinned, seat.pinned);
    std::swap(gui_.compareBy, seat.compareBy);
    std::swap(gui_.split, seat.split);
    std::swap(gui_.autoExposure, seat.autoExposure);
    std::swap(gui_.previewWidth, seat.previewWidth);
    std::swap(gui_.viewportName, seat.name);
    std::swap(link_.memory(), seat.link);
    std::swap(static_cast<app::ViewportSettings&>(gui_.settings), gui_.settings.viewports[place]);
}

void Viewports::eachOther(const std::function<void(const Rect&, std::size_t)>& act) {
    for (std::size_t i = 0; i < count(); ++i) {
        if (i == focus() || seats_[i].id == 0) continue;
        exchange(i);
        gui_.session.address(seats_[i].id);
        act(areas_[i], link_.memory().slot);
        gui_.session.address(seats_[focus()].id);
        exchange(i);
    }
}

void Viewports::setFocus(std::size_t place) {
    if (place == focus() || place >= count() || seats_[place].id == 0 || gui_.editing.tool) return;
    const std::size_t before = std::exchange(gui_.settings.focusedViewport, place);
    exchange(place); // what had the focus waits there now, and belongs to its own place
    const app::ViewportId id = seats_[place].id;
    std::swap(seats_[place], seats_[before]);
    std::swap(gui_.settings.viewports[place], gui_.settings.viewports[before]);
    std::swap(seats_[place].id, seats_[before].id);
    gui_.session.address(id);
    gui_.session.setFocus(id);
    gui_.askedSize.reset();
    gui_.pickFocus = false;
}

// ---- how many there are --------------------------------------------------------------------------------------------

std::size_t Viewports::freeSlot() const {
    for (std::size_t slot = 0;; ++slot) {
        const auto isTaken = [&](const Seat& seat) {
            const bool hasFocus = &seat == &seats_[focus()];
            return hasFocus ? link_.memory().slot == slot : seat.id != 0 && seat.link.slot == slot;
        };
        if (std::none_of(seats_.begin(), seats_.end(), isTaken)) return slot;
    }
}

// New ones are as the one that has the focus; that one stays where some are closed.
void Viewports::setCount(std::size_t count) {
    while (seats_.size() > count) close(focus() == seats_.size() - 1 ? seats_.size() - 2 : seats_.size() - 1);
    gui_.settings.viewports.resize(std::max(count, seats_.size()), gui_.settings);
    seats_.resize(count);
    if (count == 1) gui_.settings.viewports.clear();
}

void Viewports::close(std::size_t place) {
    const auto at = static_cast<std::ptrdiff_t>(place);
    if (seats_[place].id != 0) {
        gui_.session.closeViewport(seats_[place].id);
        presenter_.drop(seats_[place].link.slot);
    }
    seats_.erase(seats_.begin() + at);
    gui_.settings.viewports.erase(gui_.settings.viewports.begin() + at);
    if (focus() > place) --gui_.settings.focusedViewport;
    if (count() == 1) gui_.settings.viewports.clear();
}

// As soon as there is something to be seen of the present scene.
void Viewports::openMissing() {
    const app::SessionState& state = gui_.state;
    const bool isInStep = gui_.editor.document() == nullptr || gui_.editor.isUpToDate(state);
    if (!state.scene || !state.picture.image || !state.stage.empty() || !isInStep) return;
    for (std::size_t i = 0; i < count(); ++i)
        if (i != focus() && seats_[i].id == 0) open(i);
}

void Viewports::open(std::size_t place) {
    app::ViewportSettings& settings = gui_.settings.viewports[place];
    settings.request.oneSidedLights = gui_.settings.request.oneSidedLights;
    settings.request.halves = settings.denoise;
    Seat& seat = seats_[place];
    const std::size_t slot = freeSlot();
    seat.camera = gui_.camera;
    seat.link = {};
    seat.link.slot = slot;
    seat.link.sceneSerial = 1; // of the scene that it gets
    seat.link.request = settings.request;
    seat.link.engine = settings.engine;
    seat.link.rayTracing = settings.rayTracing;
    seat.link.camera = gui_.camera.camera();
    seat.id = gui_.session.openViewport(settings.request, settings.engine, seat.link.camera, !settings.rayTracing);
}

// By what they differ, as entrants of a race.
void Viewports::nameAll() {
    gui_.viewportName.clear();
    if (count() < 2) return;
    std::vector<app::RaceEntrant> all;
    for (std::size_t i = 0; i < count(); ++i) {
        const app::ViewportSettings& settings = i == focus() ? gui_.settings : gui_.settings.viewports[i];
        all.push_back({settings.request.settings, settings.denoise});
    }
    const std::vector<std::string> names = app::namesOf(all, gui_.isGpu, "Viewport");
    for (std::size_t i = 0; i < count(); ++i) (i == focus() ? gui_.viewportName : seats_[i].name) = names[i];
}

// What keys and panels have asked for.
void Viewports::follow() {
    if (const auto wanted = std::exchange(gui_.wantedViewports, std::nullopt)) setCount(*wanted);
    if (std::exchange(gui_.stepsFocus, false)) setFocus((focus() + 1) % count());
    openMissing();
    nameAll();
}

// ---- once a frame --------------------------------------------------------------------------------------------------

void Viewports::take() {
    link_.take(true);
    std::optional<std::size_t> failed;
    const auto noteFatal = [&](app::ViewportId id, std::size_t place) {
        if (!gui_.state.fatal) return;
        if (id == first_) std::rethrow_exception(gui_.state.fatal);
        failed = place;
    };
    noteFatal(seats_[focus()].id, focus());
    gui_.otherPixels = 0;
    for (std::size_t i = 0; i < count(); ++i) {
        if (i == focus() || seats_[i].id == 0) continue;
        exchange(i);
        gui_.session.address(seats_[i].id);
        link_.take(false);
        noteFatal(seats_[i].id, i);
        const double pixels = static_cast<double>(gui_.state.settings.width) * gui_.state.settings.height;
        gui_.session.address(seats_[focus()].id);
        exchange(i);
        gui_.otherPixels += pixels;
    }
    if (failed && *failed == focus()) setFocus(focus() == 0 ? 1 : 0);
    if (failed && *failed != focus()) gui_.wantedViewports = 1; // why has been said with its errors
    follow();
    gui_.areOthersBusy = isBusy();
}

void Viewports::send() {
    link_.send(true);
    linkCameras();
    for (app::ViewportSettings& settings : gui_.settings.viewports)
        settings.request.oneSidedLights = gui_.settings.request.oneSidedLights; // which the scene is compiled with
    eachOther([this](const Rect&, std::size_t) { link_.send(false); });
}

void Viewports::linkCameras() {
    if (!gui_.settings.linkCameras) return;
    for (std::size_t i = 0; i < count(); ++i) {
        Seat& seat = seats_[i];
        const bool isOfScene = seat.id != 0 && seat.state.sceneReads == gui_.state.sceneReads;
        if (i != focus() && isOfScene && seat.camera.camera() != gui_.camera.camera()) seat.camera = gui_.camera;
    }
}

bool Viewports::isBusy() const {
    return std::any_of(seats_.begin(), seats_.end(), [this](const Seat& seat) {
        const bool isOther = &seat != &seats_[focus()] && seat.id != 0;
        return isOther && (seat.state.activity == app::Activity::Rendering ||
                           seat.state.activity == app::Activity::Preparing || !seat.state.stage.empty());
    });
}

// ---- in the window -------------------------------------------------------------------------------------------------

void Viewports::place(const Rect& area, float scale) {
    all_ = area;
    gap_ = kGap * scale;
    areas_ = splitAreas(all_, count(), {gui_.settings.splitX, gui_.settings.splitY}, gap_);
}

void Viewports::handlePointer() {
    const ImGuiIO& io = ImGui::GetIO();
    const ImVec2 mouse = io.MousePos;
    app::GuiSettings& settings = gui_.settings;
    const Splits splits{settings.splitX, settings.splitY};
    if (coming_) setFocus(*std::exchange(coming_, std::nullopt));
    const bool isFree = !io.WantCaptureMouse && !gui_.editing.tool;
    hovered_ = isFree ? splitterAt(all_, count(), splits, gap_, mouse.x, mouse.y) : Splitter{};
    if (hovered_ && io.MouseClicked[0]) splitter_ = hovered_;
    if (splitter_) {
        const Splits moved = movedTo(splits, splitter_, all_, mouse.x, mouse.y);
        settings.splitX = moved.x;
        settings.splitY = moved.y;
        areas_ = splitAreas(all_, count(), moved, gap_);
        if (!io.MouseDown[0]) splitter_ = {}; // where it is by then: a slow frame sees the way and its end at once
        return;
    }
    const bool isPress = io.MouseClicked[0] || io.MouseClicked[1] || io.MouseClicked[2] || io.MouseWheel != 0;
    // A material that is let go above a picture, or a file, is for what is seen there.
    const bool isDrop = (gui_.materials.dragged && !io.MouseDown[0]) || !gui_.materials.droppedFile.empty();
    if (!isDrop && (!isFree || !isPress)) return;
    for (std::size_t i = 0; i < count(); ++i)
        if (areas_[i].contains(mouse.x, mouse.y)) // what is typed is read in the next frame
            io.WantTextInput ? void(coming_ = i) : setFocus(i);
}

void Viewports::drawFrames() const {
    if (count() < 2) return;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const Rect &first = areas_.front(), &last = areas_.back();
    const ImU32 lit = ImGui::ColorConvertFloat4ToU32(accentColor(gui_.settings.colorMode));
    const ImU32 gap = ImGui::GetColorU32(ImGuiCol_WindowBg);
    const Splitter active = splitter_ ? splitter_ : hovered_;
    const auto fill = [&](float left, float top, float right, float bottom, bool isLit) {
        list.AddRectFilled({left, top}, {right, bottom}, isLit ? lit : gap);
    };
    if (count() > 2) fill(all_.x, first.y + first.height, all_.x + all_.width, last.y, active.isY);
    fill(first.x + first.width, all_.y, last.x, all_.y + all_.height, active.isX);
    const Rgb around = surroundColor(gui_.settings.colorMode);
    for (std::size_t i = 0; i < count(); ++i) // to which no picture belongs yet
        if (i != focus() && !seats_[i].state.picture.image)
            list.AddRectFilled({areas_[i].x, areas_[i].y},
                               {areas_[i].x + areas_[i].width, areas_[i].y + areas_[i].height},
                               ImGui::ColorConvertFloat4ToU32({around.r, around.g, around.b, 1}));
    const Rect& area = focusArea();
    const float width = kFrame * gap_ / kGap, half = 0.5f * width;
    list.AddRect({area.x + half, area.y + half}, {area.x + area.width - half, area.y + area.height - half}, lit, 0, 0,
                 width);
}

} // namespace rt::gui
