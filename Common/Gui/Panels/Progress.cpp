#include <algorithm>
#include <cmath>
#include <cstdio>

#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

using app::Activity;

const char* activityText(Activity activity) {
    switch (activity) {
        case Activity::Preparing:
            return "preparing";
        case Activity::Rendering:
            return "rendering";
        case Activity::Paused:
            return "paused";
        case Activity::Stopped:
            return "stopped";
        case Activity::Finished:
            return "done";
        case Activity::Failed:
            break;
    }
    return "failed";
}

std::string progressText(const app::SessionState& state, float share) {
    const std::uint64_t pixels = std::uint64_t{state.settings.width} * state.settings.height;
    const std::uint64_t spp = pixels > 0 ? state.status.samplesDone / pixels : 0;
    char text[96];
    std::snprintf(text, sizeof text, "%llu / %u spp   %.0f %%", static_cast<unsigned long long>(spp),
                  state.settings.spp, std::min(100.0f, 100 * share));
    return text;
}

std::string timeLeft(const app::SessionState& state) {
    const app::RenderStatus& status = state.status;
    if (state.activity != Activity::Rendering || status.samplesDone == 0 || state.renderSeconds <= 0) return "";
    const double rate = static_cast<double>(status.samplesDone) / state.renderSeconds;
    const auto left =
        static_cast<double>(status.samplesTotal - std::min(status.samplesTotal, status.samplesDone)) / rate;
    return roughDuration(left) + " left";
}

} // namespace

void drawProgress(Gui& gui) {
    const app::SessionState& state = gui.state;
    const bool isPreview = state.picture.isPreview;
    // What is being prepared has made no progress yet, whatever the picture that is still shown had.
    const bool isWaiting = !state.stage.empty() || state.activity == Activity::Preparing;
    const float share = !isWaiting && state.status.samplesTotal > 0
                            ? static_cast<float>(static_cast<double>(state.status.samplesDone) /
                                                 static_cast<double>(state.status.samplesTotal))
                            : 0.0f;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::ProgressBar(share, {-1, 0}, "");
    const ImVec2 bar = ImGui::GetItemRectSize();
    const std::string text = isWaiting ? "preparing" : progressText(state, share);
    const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
    ImGui::GetWindowDrawList()->AddText({corner.x + 0.5f * (bar.x - extent.x), corner.y + 0.5f * (bar.y - extent.y)},
                                        ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
    std::string line = isPreview ? "preview: ray tracing is off" : activityText(state.activity);
    if (!state.stage.empty()) line = state.stage + " ... " + shortDuration(state.stageSeconds);
    if (const std::string left = timeLeft(state); !left.empty() && !isWaiting && !isPreview) line += ", " + left;
    const float room = ImGui::GetContentRegionAvail().x;
    ImGui::TextDisabled("%s", elided(line, room).c_str());
    tooltip(line.c_str());
    std::string last = "Render time: none yet"; // nothing moves when there is one
    std::string parts;
    if (state.lastRun) {
        const app::LastRun& run = *state.lastRun;
        last = "Render time " + shortDuration(run.seconds.render) + " (" + std::to_string(run.spp) + " spp)";
        parts =
            "The last render that ended, wall time of sampling alone, as in the statistics of a render without a "
            "window.\nLoad " +
            shortDuration(run.seconds.load) + ", build " + shortDuration(run.accelBuild + run.pipeline) +
            " (the scene's tree " + shortDuration(run.accelBuild) + ", pipelines of shaders " +
            shortDuration(run.pipeline) + "), render " + shortDuration(run.seconds.render);
    }
    ImGui::TextUnformatted(elided(last, room).c_str());
    if (!parts.empty()) tooltip(parts.c_str());
    ImGui::Separator();
}

// What matters most comes first, and the device's name, which is long, gives way.
void drawStatusLine(Gui& gui) {
    const app::SessionState& state = gui.state;
    char fps[48];
    std::snprintf(fps, sizeof fps, "%.0f fps   F1 help", gui.figures.window.framesPerSecond);
    const float gap = 2 * ImGui::GetFontSize();
    const float all = ImGui::GetContentRegionAvail().x, right = all - ImGui::CalcTextSize(fps).x;
    std::string text = state.scene ? state.scene->title : "no scene";
    text += "   |   " + std::to_string(state.settings.width) + " x " + std::to_string(state.settings.height);
    if (state.renderSeconds > 0) {
        text +=
            "   |   " + withPrefix(static_cast<double>(state.status.samplesDone) / state.renderSeconds) + " samples/s";
    }
    text += "   |   " +
            (state.report.engine.empty() ? std::string("starting") : state.report.engine + ", " + state.report.device);
    const bool hasRight = right > 0.5f * all;
    ImGui::TextUnformatted(elided(text, hasRight ? right - gap : all).c_str());
    tooltip(text.c_str());
    if (!hasRight) return;
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(fps).x);
    ImGui::TextDisabled("%s", fps);
}

} // namespace rt::gui
