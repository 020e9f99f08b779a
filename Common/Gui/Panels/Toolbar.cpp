// One line at the top of the window: what is done most, and what is shown.
#include <algorithm>
#include <string>

#include "Common/Gui/Icons.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Panels/ViewModes.h"
#include "Common/Gui/Theme.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

using app::Activity;

constexpr const char* kNoPicture = "there is no picture yet";
constexpr int kRightIcons = 6; // race, comparison, statistics, panels, help, errors

float gap() {
    return ImGui::GetStyle().ItemInnerSpacing.x;
}
void beside() {
    ImGui::SameLine(0, gap());
}
// Between two groups.
void apart() {
    ImGui::SameLine(0, 3 * gap());
}

// By which program the window is.
void drawBadge(const Gui& gui) {
    const char* name = gui.isGpu ? "GPU" : "CPU";
    const float height = ImGui::GetFrameHeight(), width = buttonWidth(name);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::Dummy({width, height});
    const ImVec4 color = engineColor(gui.isGpu, gui.settings.colorMode);
    const bool isLight = gui.settings.colorMode == app::ColorMode::Light;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, {corner.x + width, corner.y + height}, ImGui::ColorConvertFloat4ToU32(color),
                       ImGui::GetStyle().FrameRounding);
    const ImVec2 extent = ImGui::CalcTextSize(name);
    list.AddText({corner.x + 0.5f * (width - extent.x), corner.y + 0.5f * (height - extent.y)},
                 isLight ? IM_COL32_WHITE : IM_COL32_BLACK, name);
    tooltip(gui.isGpu ? "ray-tracing-gpu" : "ray-tracing-cpu");
}

// The first thing to do is one button, whatever it is at the moment.
void drawRenderButtons(Gui& gui, bool isNarrow) {
    const bool isPreview = gui.state.picture.isPreview;
    const bool rendering = !isPreview && gui.state.activity == Activity::Rendering;
    const bool paused = !isPreview && gui.state.activity == Activity::Paused;
    const app::ColorMode colors = gui.settings.colorMode;
    const float icon = ImGui::GetFrameHeight();
    const float width = isNarrow ? icon : icon + ImGui::CalcTextSize("Resume").x + 2 * gap();
    const char* text = rendering ? "Pause" : paused ? "Resume" : "Start";
    if (primaryButton(
            "render", rendering ? Icon::Pause : Icon::Start, text,
            rendering ? "Pauses the render (Space)" : "Starts the render, or resumes it after a pause (Space)", true,
            width, accentColor(colors), accentTextColor(colors))) {
        if (rendering) {
            gui.session.pause();
        } else if (isPreview) {
            gui.setRayTracing(true);
        } else {
            gui.session.render();
        }
    }
    beside();
    const bool canStop = rendering || paused || !gui.state.stage.empty();
    if (iconButton("stop", Icon::Stop,
                   "Ends the render, of which stays what there is, and gives up what is being loaded",
                   {canStop, "nothing is rendered or loaded"}))
        gui.session.stop(), gui.timeline.giveUp();
    beside();
    if (iconButton("restart", Icon::Restart, "Discards the samples and renders from the beginning (Ctrl+R)",
                   {!isPreview, "ray tracing is off"}))
        gui.session.reset();
}

float modeMenuWidth() {
    return buttonWidth("Denoised error") + ImGui::GetFrameHeight();
}

// Of buttons, and the menu for what the denoiser knows.
float modesWidth() {
    float width = modeMenuWidth();
    for (const ViewModeRow& mode : viewModes())
        if (!mode.isOfDenoiser) width += buttonWidth(mode.name) + gap();
    return width;
}

const char* whyNot(const Gui& gui, const ViewModeRow& mode) {
    if (gui.state.picture.isOfRace && mode.mode != app::ViewMode::Error) return "of a race only pictures are shown";
    return gui.state.picture.isPreview ? "ray tracing is off" : mode.missing;
}

void choose(Gui& gui, const ViewModeRow& mode) {
    const bool canBe = isAvailable(gui, mode.mode), isOn = gui.viewRequest.mode == mode.mode;
    if (isOn) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    if (button(mode.name, mode.tip, {canBe, whyNot(gui, mode)})) gui.viewRequest.mode = mode.mode;
    if (isOn) ImGui::PopStyleColor();
}

void drawModeMenu(Gui& gui, const char* label, const char* tip, float width, bool isOfDenoiserAlone) {
    ImGui::SetNextItemWidth(std::max(1.0f, width));
    if (!ImGui::BeginCombo("##mode", label, ImGuiComboFlags_HeightLarge)) return tooltip(tip);
    for (const ViewModeRow& mode : viewModes()) {
        if (isOfDenoiserAlone && !mode.isOfDenoiser) continue;
        const bool canBe = isAvailable(gui, mode.mode);
        const auto flags = canBe ? ImGuiSelectableFlags_None : ImGuiSelectableFlags_Disabled;
        if (ImGui::Selectable(mode.name, mode.mode == gui.viewRequest.mode, flags)) gui.viewRequest.mode = mode.mode;
        tooltip((mode.tip + (canBe ? "" : std::string("\nNot now: ") + whyNot(gui, mode))).c_str());
    }
    ImGui::EndCombo();
}

// A row of buttons with a menu at its end, or only a menu where there is no room.
void drawModes(Gui& gui, float room) {
    const ViewModeRow& shown = rowOf(gui.viewRequest.mode);
    if (modesWidth() > room)
        return drawModeMenu(gui, shown.name, "What is shown", std::min(room, modeMenuWidth()), false);
    for (const ViewModeRow& mode : viewModes()) {
        if (mode.isOfDenoiser) continue;
        choose(gui, mode);
        beside();
    }
    drawModeMenu(gui, shown.isOfDenoiser ? shown.name : "Halves, error", "What the denoiser knows beside the picture",
                 modeMenuWidth(), true);
}

// What is counted is said where it is turned on: raw samples are compared with raw samples.
void drawDenoise(Gui& gui, float width) {
    if (toggleButton("denoise", Icon::Denoise, "Denoise",
                     "Shows the picture with less noise, or the raw one (N). The film stays what it is, but for two "
                     "halves of its samples that know nothing of each other.\n"
                     "The filter works between samples: render time, rates and the comparison of engines leave it out",
                     !gui.state.picture.isPreview, gui.settings.denoise, width))
        gui.settings.denoise = !gui.settings.denoise;
}

void drawRight(Gui& gui) {
    app::GuiSettings& settings = gui.settings;
    if (iconButton("race", Icon::Flag, "Race of several settings, each for the same time (F5)", true,
                   settings.showRace))
        gui.toggleRace();
    beside();
    if (iconButton("comparison", Icon::Chart, "Comparison of runs (F3)", true, settings.showComparison))
        gui.toggleComparison();
    beside();
    const bool areFiguresOpen = settings.showPanels && settings.showStatistics && settings.openPanels["statistics"];
    if (iconButton("statistics", Icon::Figures, "Statistics (F2)", true, areFiguresOpen)) gui.toggleStatistics();
    beside();
    if (iconButton("panels", Icon::Panels, "Panels at the side (F4)", true, settings.showPanels))
        settings.showPanels = !settings.showPanels;
    beside();
    if (iconButton("help", Icon::Help, "Keys and mouse (F1)", true, gui.showHelp)) gui.showHelp = !gui.showHelp;
    beside();
    const bool isUnread = gui.errors.unread() != nullptr;
    if (isUnread) ImGui::PushStyleColor(ImGuiCol_Text, errorColor(settings.colorMode));
    if (iconButton("errors", Icon::Warning, nullptr, !gui.errors.all().empty(), gui.showErrors))
        gui.showErrors = !gui.showErrors;
    if (isUnread) ImGui::PopStyleColor();
    tooltip(gui.errors.all().empty() ? "What went wrong: nothing so far" : "What went wrong so far"); // as all others
}

} // namespace

void drawToolbar(Gui& gui) {
    const float icon = ImGui::GetFrameHeight(), all = ImGui::GetContentRegionAvail().x;
    const float left = ImGui::GetCursorPosX();
    const float right = kRightIcons * icon + (kRightIcons - 1) * gap();
    // Badge, start, stop, restart; denoise, A/B, save, open; the gaps between groups.
    const float fixed = buttonWidth("GPU") + 7 * icon + 13 * gap() + right;
    const float words = ImGui::CalcTextSize("Resume").x + ImGui::CalcTextSize("Denoise").x + 2 * gap();
    const bool isNarrow = all - fixed - words < modeMenuWidth();
    const float denoise = isNarrow ? icon : icon + ImGui::CalcTextSize("Denoise").x + 2 * gap();
    drawBadge(gui);
    apart();
    drawRenderButtons(gui, isNarrow);
    apart();
    const float used = ImGui::GetCursorPosX() - left;
    drawModes(gui, all - used - denoise - 3 * icon - 9 * gap() - right);
    apart();
    drawDenoise(gui, denoise);
    beside();
    if (iconButton("split", Icon::Split,
                   gui.pinned ? "Unpins the picture that is compared with (B)"
                              : "Pins the picture for A/B comparison with the next one (B)",
                   {gui.pinned || gui.state.picture.image, kNoPicture}, static_cast<bool>(gui.pinned))) {
        gui.hold();
    }
    beside();
    if (iconButton("save", Icon::Save, "Saves the picture as PNG and EXR (F12, Ctrl+S); Ctrl+Shift+S asks where",
                   {gui.state.picture.image != nullptr, kNoPicture})) {
        gui.saveRequested = true;
    }
    beside();
    if (iconButton("open", Icon::Open, "Opens a scene file or a model (Ctrl+O)")) gui.browse(BrowseFor::Scene);
    ImGui::SameLine(std::max(ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x + gap(), left + all - right));
    drawRight(gui);
}

} // namespace rt::gui
