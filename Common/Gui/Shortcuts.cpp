#include "Common/Gui/Shortcuts.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include "Common/Gui/ObjectTools.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"

namespace rt::gui {
namespace {

constexpr double kFast = 5, kSlow = 0.2;
constexpr float kScaleStep = 0.25f;

enum class When {
    Always,    // also while text is typed
    Control,   // with Ctrl, also while text is typed
    CtrlShift, // likewise
    Alt,       // with Alt, and not while text is typed
    Plain,     // without Ctrl, and not while text is typed
};

struct Shortcut {
    int key;
    When when;
    void (*act)(Gui&);
};

void pauseOrGoOn(Gui& gui) {
    if (ImGui::GetIO().NavVisible) return; // it presses the control that the keyboard is at
    if (gui.state.race && gui.state.race->phase != app::RaceState::Phase::Over) return gui.session.stopRace();
    gui.state.activity == app::Activity::Rendering ? gui.session.pause() : gui.session.render();
}

void holdPicture(Gui& gui) {
    if (gui.pinned || gui.state.picture.image) gui.hold();
}

// Split, blink, difference, split.
void compareOtherwise(Gui& gui) {
    const auto count = static_cast<int>(std::size(kCompareBys));
    if (gui.pinned) gui.compareBy = static_cast<CompareBy>((static_cast<int>(gui.compareBy) + 1) % count);
}

// From the picture: what ImGui's keys walk through begins with a window that has the focus.
void walkPanels(Gui& gui) {
    if (ImGui::IsWindowFocused(ImGuiFocusedFlags_AnyWindow)) return;
    gui.settings.showPanels = gui.focusPanels = true;
}

// What the keyboard is for while a tool moves an object. Whether it was for that.
bool steerTool(Gui& gui, const InputEvent& press) {
    if (!gui.editing.tool) return false;
    if (press.code >= GLFW_KEY_X && press.code <= GLFW_KEY_Z) {
        gui.editing.tool->constrain(press.code - GLFW_KEY_X);
        gui.editing.isToolStale = true;
        return true;
    }
    const bool isConfirmed = press.code == GLFW_KEY_ENTER || press.code == GLFW_KEY_KP_ENTER;
    if (isConfirmed || press.code == GLFW_KEY_ESCAPE) endTool(gui, isConfirmed);
    return isConfirmed || press.code == GLFW_KEY_ESCAPE;
}

// Keys that concern what is selected, where something is. Whether it was one of them.
bool editByKey(Gui& gui, const InputEvent& press) {
    using Kind = app::ObjectTool::Kind;
    const bool isPlain = (press.modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)) == 0;
    if (!gui.editor.selection() || ImGui::GetIO().WantTextInput || gui.browser.isOpen()) return false;
    if (steerTool(gui, press)) return true;
    const bool isShifted = (press.modifiers & GLFW_MOD_SHIFT) != 0;
    if (!isPlain) return false;
    if (press.code == GLFW_KEY_D && isShifted) return duplicateSelection(gui), true;
    switch (press.code) {
        case GLFW_KEY_G:
            return beginTool(gui, Kind::Move), true;
        case GLFW_KEY_R:
            return beginTool(gui, Kind::Turn), true;
        case GLFW_KEY_S:
            return beginTool(gui, Kind::Scale), true;
        case GLFW_KEY_F:
            return frameSelection(gui), true;
        case GLFW_KEY_DELETE:
            return deleteSelection(gui), true;
        case GLFW_KEY_H:
            return isShifted ? soloSelection(gui) : hideSelection(gui), true;
        default:
            return false;
    }
}

// One thing at a time: what is open goes first.
void leave(Gui& gui) {
    if (std::exchange(gui.materials.isPicking, false)) return;
    if (!gui.showHelp && !gui.showErrors && !gui.showScenes && !ImGui::GetIO().WantTextInput) deselect(gui);
    gui.showHelp = gui.showErrors = gui.showScenes = false;
}

void toggle(bool& value) {
    value = !value;
}

void toggleLink(Gui& gui) {
    if (gui.viewportCount() < 2) return;
    toggle(gui.settings.linkCameras);
    gui.say(gui.settings.linkCameras ? "Cameras are linked" : "Cameras are not linked");
}

constexpr Shortcut kShortcuts[] = {
    {GLFW_KEY_F1, When::Always, [](Gui& gui) { toggle(gui.showHelp); }},
    {GLFW_KEY_ESCAPE, When::Always, leave},
    {GLFW_KEY_F2, When::Always, [](Gui& gui) { gui.toggleStatistics(); }},
    {GLFW_KEY_F3, When::Always, [](Gui& gui) { gui.toggleComparison(); }},
    {GLFW_KEY_F5, When::Always, [](Gui& gui) { gui.toggleRace(); }},
    {GLFW_KEY_F6, When::Always, [](Gui& gui) { gui.stepViewports(); }},
    {GLFW_KEY_F7, When::Always, [](Gui& gui) { gui.stepsFocus = true; }},
    {GLFW_KEY_L, When::Plain, toggleLink},
    {GLFW_KEY_K, When::Plain, [](Gui& gui) { gui.timeline.play(!gui.timeline.isPlaying()); }},
    {GLFW_KEY_COMMA, When::Plain, [](Gui& gui) { gui.timeline.step(-1); }},
    {GLFW_KEY_PERIOD, When::Plain, [](Gui& gui) { gui.timeline.step(1); }},
    {GLFW_KEY_F4, When::Always, [](Gui& gui) { toggle(gui.settings.showPanels); }},
    {GLFW_KEY_F11, When::Always, [](Gui& gui) { gui.window.toggleFullScreen(); }},
    {GLFW_KEY_F12, When::Always, [](Gui& gui) { gui.saveRequested = true; }},
    {GLFW_KEY_S, When::CtrlShift, [](Gui& gui) { gui.browse(BrowseFor::Picture); }},
    {GLFW_KEY_S, When::Control, [](Gui& gui) { gui.saveRequested = true; }},
    {GLFW_KEY_Z, When::CtrlShift, redoEdit},
    {GLFW_KEY_Z, When::Control, undoEdit},
    {GLFW_KEY_Y, When::Control, redoEdit},
    {GLFW_KEY_Q, When::Control, [](Gui& gui) { gui.close(); }},
    {GLFW_KEY_O, When::Control, [](Gui& gui) { gui.browse(BrowseFor::Scene); }},
    {GLFW_KEY_R, When::Control, [](Gui& gui) { gui.session.reset(); }},
    {GLFW_KEY_EQUAL, When::Control, [](Gui& gui) { gui.scaleInterface(kScaleStep); }},
    {GLFW_KEY_KP_ADD, When::Control, [](Gui& gui) { gui.scaleInterface(kScaleStep); }},
    {GLFW_KEY_MINUS, When::Control, [](Gui& gui) { gui.scaleInterface(-kScaleStep); }},
    {GLFW_KEY_KP_SUBTRACT, When::Control, [](Gui& gui) { gui.scaleInterface(-kScaleStep); }},
    {GLFW_KEY_C, When::CtrlShift, [](Gui& gui) { gui.copyPose(); }},
    {GLFW_KEY_V, When::CtrlShift, [](Gui& gui) { gui.pastePose(); }},
    {GLFW_KEY_SPACE, When::Plain, pauseOrGoOn},
    {GLFW_KEY_HOME, When::Plain, [](Gui& gui) { gui.frameAll(); }},
    {GLFW_KEY_R, When::Plain, [](Gui& gui) { gui.camera.reset(); }},
    {GLFW_KEY_F, When::Plain, [](Gui& gui) { gui.view = {}; }},
    {GLFW_KEY_B, When::Plain, holdPicture},
    {GLFW_KEY_V, When::Plain, compareOtherwise},
    {GLFW_KEY_N, When::Plain, [](Gui& gui) { toggle(gui.settings.denoise); }},
    {GLFW_KEY_H, When::Alt, showAllObjects},
    {GLFW_KEY_H, When::Plain, [](Gui& gui) { gui.toggleHeatMap(); }},
    {GLFW_KEY_P, When::Plain, [](Gui& gui) { gui.setRayTracing(!gui.settings.rayTracing); }},
    {GLFW_KEY_TAB, When::Plain, walkPanels},
    {GLFW_KEY_UP, When::Plain, walkPanels},
    {GLFW_KEY_DOWN, When::Plain, walkPanels},
    {GLFW_KEY_PAGE_UP, When::Plain, [](Gui& gui) { gui.stepScene(-1); }},
    {GLFW_KEY_PAGE_DOWN, When::Plain, [](Gui& gui) { gui.stepScene(1); }},
};

bool applies(const Shortcut& shortcut, const InputEvent& press) {
    const bool control = (press.modifiers & GLFW_MOD_CONTROL) != 0;
    switch (shortcut.when) {
        case When::Always:
            return true;
        case When::Control:
            return control;
        case When::CtrlShift:
            return control && (press.modifiers & GLFW_MOD_SHIFT) != 0;
        case When::Alt:
            return (press.modifiers & GLFW_MOD_ALT) != 0 && !ImGui::GetIO().WantTextInput;
        case When::Plain:
            break;
    }
    return !control && !ImGui::GetIO().WantTextInput;
}

// Keys of the file browser, where its field has the keyboard.
bool browseBy(FileBrowser& browser, const InputEvent& press) {
    using Key = FileBrowser::Key;
    switch (press.code) {
        case GLFW_KEY_ESCAPE:
            browser.close();
            return true;
        case GLFW_KEY_ENTER:
        case GLFW_KEY_KP_ENTER:
            browser.press(Key::Accept); // arrows may have taken the keyboard from the field
            return true;
        case GLFW_KEY_UP:
            browser.press((press.modifiers & GLFW_MOD_ALT) != 0 ? Key::Parent : Key::Up);
            return true;
        case GLFW_KEY_DOWN:
            browser.press(Key::Down);
            return true;
        case GLFW_KEY_PAGE_UP:
            browser.press(Key::PageUp);
            return true;
        case GLFW_KEY_PAGE_DOWN:
            browser.press(Key::PageDown);
            return true;
        default:
            return false;
    }
}

} // namespace

bool isKeyPress(const InputEvent& event) {
    return event.kind == InputEvent::Kind::Key && event.isDown;
}

void obeyKey(Gui& gui, const InputEvent& press) {
    const bool isBrowsing = gui.browser.isOpen(); // what is typed is for its field
    if (isBrowsing && browseBy(gui.browser, press)) return;
    if (editByKey(gui, press)) return;
    for (const Shortcut& shortcut : kShortcuts) {
        if (shortcut.key != press.code || !applies(shortcut, press)) continue;
        if (isBrowsing && (shortcut.when == When::Plain || shortcut.when == When::Alt)) return;
        shortcut.act(gui);
        return;
    }
    const bool control = (press.modifiers & GLFW_MOD_CONTROL) != 0;
    if (control || isBrowsing || ImGui::GetIO().WantTextInput || press.code < GLFW_KEY_1 || press.code > GLFW_KEY_9)
        return;
    const auto index = static_cast<std::size_t>(press.code - GLFW_KEY_1);
    if (index < scene::builtinScenes().size()) gui.openScene(std::string(scene::builtinScenes()[index].id));
}

bool fly(Gui& gui, std::span<const InputEvent> input, double seconds) {
    if (ImGui::GetIO().WantTextInput || gui.browser.isOpen() || !gui.state.scene) return false;
    if (gui.editing.tool || gui.editing.whenSaved) return false; // keys are for these
    const Window& window = gui.window;
    const bool control = window.isDown(GLFW_KEY_LEFT_CONTROL) || window.isDown(GLFW_KEY_RIGHT_CONTROL);
    const bool shift = window.isDown(GLFW_KEY_LEFT_SHIFT) || window.isDown(GLFW_KEY_RIGHT_SHIFT);
    // A key that went down and up between two frames of a busy machine counts, too.
    const auto isPressed = [&](int key) {
        const auto isThis = [key](const InputEvent& press) {
            return isKeyPress(press) && press.code == key && (press.modifiers & GLFW_MOD_CONTROL) == 0;
        };
        return window.isDown(key) || std::any_of(input.begin(), input.end(), isThis);
    };
    const auto axis = [&isPressed](int positive, int negative) {
        return (isPressed(positive) ? 1.0 : 0.0) - (isPressed(negative) ? 1.0 : 0.0);
    };
    if (gui.editor.selection() && shift && isPressed(GLFW_KEY_D)) return false;
    const double right = axis(GLFW_KEY_D, GLFW_KEY_A);
    const double up = axis(GLFW_KEY_E, GLFW_KEY_Q);
    // What is selected is scaled by S, and duplicated by Shift and D.
    const bool isEditing = gui.editor.selection().has_value();
    double forward = axis(GLFW_KEY_W, GLFW_KEY_S);
    if (isEditing) forward = isPressed(GLFW_KEY_W) ? 1 : 0;
    if (control && (isPressed(GLFW_KEY_S) || isPressed(GLFW_KEY_Q))) return false; // save, quit
    if (right == 0 && up == 0 && forward == 0) return false;
    const double pace = shift ? kFast : control ? kSlow : 1;
    gui.camera.fly(pace * right, pace * up, pace * forward, seconds);
    return true;
}

} // namespace rt::gui
