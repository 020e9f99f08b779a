#include <algorithm>
#include <cstdint>
#include <string>

#include "Common/Core/Format.h"
#include "Common/Core/Printable.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/TimelineBar.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr double kLongestShutter = 1e3; // seconds

void drawAnimations(app::Timeline& timeline) {
    const scene::Motion& motion = timeline.motion();
    const Disabled one(timeline.whyNot() == nullptr && motion.animations.size() < 2, "the scene has one animation");
    row("Animation", "Which one of the scene's moves it");
    const std::string shown = motion.animations.empty() ? "" : motion.animations[motion.chosen];
    if (!ImGui::BeginCombo("##animation", printable(shown).c_str())) return explainDisabled();
    for (std::size_t i = 0; i < motion.animations.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        const bool isChosen = i == motion.chosen;
        if (ImGui::Selectable(printable(motion.animations[i]).c_str(), isChosen) && !isChosen)
            timeline.choose(motion.animations[i]);
        if (isChosen) ImGui::SetItemDefaultFocus();
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

void drawShutter(app::Timeline& timeline) {
    scene::Shutter shutter = timeline.shutter();
    const bool hasOpen = inputReal("Shutter opens", "Seconds after the time shown, or before it where below 0",
                                   shutter.open, -kLongestShutter, kLongestShutter, "%.4g s");
    if (hasOpen) shutter.close = std::max(shutter.close, shutter.open);
    const bool hasClose = inputReal("Shutter closes", "Likewise: between the two light is gathered; equal: an instant",
                                    shutter.close, -kLongestShutter, kLongestShutter, "%.4g s");
    if (hasClose) shutter.open = std::min(shutter.close, shutter.open);
    if (hasOpen || hasClose) timeline.setShutter(shutter.isOpen() ? shutter : scene::Shutter());
}

// As a shell of Unix takes it for one word, whatever is in it.
std::string shellWord(const std::string& text) {
    std::string word = "'";
    for (const char letter : text) word += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
    return word + "'";
}

// What renders all of the animation without a window.
std::string sequenceCommand(const Gui& gui) {
    const app::Timeline& timeline = gui.timeline;
    const auto last = static_cast<std::uint64_t>(timeline.motion().length * timeline.frameRate() + 1e-6);
    std::string command = std::string(gui.isGpu ? app::kGpuProgram : app::kCpuProgram) + " --scene " +
                          shellWord(gui.state.source) +
                          formatted(" --time 0 --frames 0..%llu --frame-rate %.6g",
                                    static_cast<unsigned long long>(last), timeline.frameRate());
    if (timeline.motion().chosen > 0)
        command += " --animation " + shellWord(timeline.motion().animations[timeline.motion().chosen]);
    if (timeline.shutter().isOpen())
        command += formatted(" --shutter %.9g,%.9g", timeline.shutter().open, timeline.shutter().close);
    return command + " -o frame.png";
}

} // namespace

void drawMotionPanel(Gui& gui) {
    app::Timeline& timeline = gui.timeline;
    const Disabled still(timeline.whyNot() != nullptr, timeline.whyNot());
    drawAnimations(timeline);
    row("Time", "Seconds from the start of the animation");
    double seconds = timeline.time();
    if (timeSlider("##time", timeline, seconds)) timeline.goTo(seconds);
    explainDisabled();
    drawPlayButtons(gui);
    double rate = timeline.frameRate();
    if (inputReal("Frame rate", "Frames a second, which playing and steps keep to", rate, app::Timeline::kLeastRate,
                  app::Timeline::kMostRate, "%.4g"))
        timeline.setFrameRate(rate);
    bool loops = timeline.loops();
    if (checkbox("Loop", "Begins again at the end", loops)) timeline.setLoops(loops);
    drawShutter(timeline);
    if (button("Copy command of the sequence", "What renders all of its frames, without a window, to the clipboard",
               {timeline.isMoving(), "nothing moves in the scene"}, -1)) {
        gui.window.setClipboard(sequenceCommand(gui));
        gui.say("Command copied");
    }
}

} // namespace rt::gui
