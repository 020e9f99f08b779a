
#include "Common/App/Platform.h"
#include "Common/App/Session/FeatureNames.h"
#include "Common/Core/Format.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

void figure(const char* label, const char* tip, const std::string& text) {
    row(label, tip);
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
}

std::string namesOf(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text.empty() ? "none" : text;
}

} // namespace

void drawStatisticsPanel(Gui& gui) {
    const app::SessionState& state = gui.state;
    const app::EngineReport& report = state.report;
    const app::WindowFigures& window = gui.figures.window;
    figure("Window", "Frames of the last second: only what is new is drawn; and the median time of a frame",
           formatted("%.0f fps, a frame takes %.1f ms", window.framesPerSecond, 1000 * window.medianTurn));
    figure("Longest stall", "The longest time that the window did not look for input; and that of the last 10 s",
           formatted("%.0f ms, of late %.0f ms", 1000 * window.longestTurn, 1000 * gui.figures.longestOfLate));
    figure("Slowest answer", "From a change of camera or settings to the first picture of it",
           state.slowestAnswer > 0 ? shortDuration(state.slowestAnswer) : "-");
    if (gui.isGpu) {
        figure("Longest dispatch",
               "The longest that the device was at what the engine gives it at a time; draws wait for it",
               report.longestDispatchSeconds > 0 ? shortDuration(report.longestDispatchSeconds) : "-");
    }
    const double seconds = state.renderSeconds;
    const auto perSecond = [seconds](double count) { return seconds > 0 ? withPrefix(count / seconds) + "/s" : "-"; };
    figure("Samples", "Paths from the camera", perSecond(static_cast<double>(state.status.samplesDone)));
    figure("Rays",
           "All of them: camera, scattered and shadow, more from the camera at edges of lights, and those between "
           "neighbours' paths",
           perSecond(static_cast<double>(report.rays.all())));
    figure("Render time", "Of samples alone", shortDuration(seconds));
    figure(
        "Denoiser",
        "Features and filter of the last denoised picture. They come between samples: neither the render time nor any "
        "rate counts them",
        state.denoiseSeconds > 0 ? shortDuration(state.denoiseSeconds) : "-");
    figure("Memory", "Of this process; and what the engine holds of scene and film",
           bytesText(app::residentBytes()) + ", engine " + bytesText(report.deviceBytes));
    figure("Engine", nullptr,
           report.engine + (report.threads > 0 ? ", " + std::to_string(report.threads) + " threads" : std::string()));
    figure("Device", nullptr, report.device);
    figure("Kernel", "The specialization that runs", report.kernel);
    figure("Lights", "How the shapes of light are sampled", report.lightSampling);
    figure("Active features", "What the scene needs", namesOf(app::featureNames(report.features)));
    figure("Compiled out", "What it does not need, and no code runs for",
           namesOf(app::absentFeatureNames(report.features)));
    figure("NaN or Inf samples", "They count as black", std::to_string(report.nonfiniteSamples));
    figure("Cut off by max depth", "Of what paths carry: the picture may be darker by as much",
           formatted("%.2g %%", 100 * report.cutOffShare()));
}

} // namespace rt::gui
