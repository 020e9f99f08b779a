// What the lines of progress and status and the picture's chips say, apart from how it is drawn.
#pragma once
#include <string>
#include <vector>

#include "Common/App/Interactive/InteractiveState.h"
#include "Common/Gui/TextFit.h"

namespace rt::gui {

struct ProgressTexts {
    float share = 0;  // of the bar, 0 to 1
    std::string bar;  // "24 / 100 spp   24 %"
    std::string line; // below: what is being done, and the time that it will take
};
// What is being prepared has made no progress yet, whatever the picture that is still shown had. `timeLimit`: the
// budget of the render in seconds; 0: none.
ProgressTexts progressOf(const app::SessionState& state, double timeLimit);

// What the picture is: its engine, samples, time, whether it is denoised, and the errors of the raw and the denoised
// one. It may have fewer samples than the render has by now: how far that is tells the bar, or the chip where no bar is
// shown.
std::vector<std::string> chipTexts(const app::SessionState& state, bool isGpu, bool isBarShown);

// From what matters most to what matters least: title, size, samples per second, engine, device.
struct StatusParts {
    std::string title, size, rate, engine, device; // an empty one is left out
};
StatusParts statusOf(const app::SessionState& state);

// All parts in one line. Where that is too wide the device's name is shortened, then left out, then the engine; then
// the title is shortened: size and rate stay whole as long as they fit at all.
std::string fitStatus(const StatusParts& parts, float width, const TextWidth& widthOf);

} // namespace rt::gui
