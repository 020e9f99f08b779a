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

void drawRenderControl(Gui& gui) {
    const app::SessionState& state = gui.state;
    const float space = ImGui::GetStyle().ItemSpacing.x, all = ImGui::GetContentRegionAvail().x;
    const float columns = 4 * buttonWidth("Resume") + 3 * space <= all ? 4.0f : 2.0f;
    const float width = std::floor((all - (columns - 1) * space) / columns);
    const bool isPreview = state.picture.isPreview;
    const bool rendering = !isPreview && state.activity == Activity::Rendering;
    const bool paused = !isPreview && state.activity == Activity::Paused;
    if (button(paused ? "Resume" : "Start", "Starts the render, or resumes it after a pause (Space)", !rendering,
               width)) {
        isPreview ? gui.setRayTracing(true) : gui.session.render();
    }
    besideIfItFits(width);
    if (button("Pause", "Pauses the render (Space)", rendering, width)) gui.session.pause();
    besideIfItFits(width);
    if (button("Stop", "Ends the render; what there is of it stays", rendering || paused, width)) gui.session.stop();
    besideIfItFits(width);
    if (button("Restart", "Discards the samples and renders from the beginning", !isPreview, width)) {
        gui.session.reset();
    }

    const float share = state.status.samplesTotal > 0
                            ? static_cast<float>(static_cast<double>(state.status.samplesDone) /
                                                 static_cast<double>(state.status.samplesTotal))
                            : 0.0f;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::ProgressBar(share, {-1, 0}, "");
    const ImVec2 bar = ImGui::GetItemRectSize();
    const std::string text = progressText(state, share);
    const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
    ImGui::GetWindowDrawList()->AddText({corner.x + 0.5f * (bar.x - extent.x), corner.y + 0.5f * (bar.y - extent.y)},
                                        ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
    std::string line = isPreview ? "preview: ray tracing is off" : activityText(state.activity);
    if (!state.stage.empty()) line = state.stage + " ... " + shortDuration(state.stageSeconds);
    if (const std::string left = timeLeft(state); !left.empty() && state.stage.empty() && !isPreview)
        line += ", " + left;
    ImGui::TextDisabled("%s", line.c_str()); // a long one is cut: nothing moves
    if (state.lastRun) {
        const app::LastRun& run = *state.lastRun;
        ImGui::PushTextWrapPos(0);
        ImGui::TextUnformatted(("Render time " + shortDuration(run.seconds.render)).c_str());
        tooltip("Wall time of sampling alone, as in the statistics of a render without a window");
        ImGui::Text("%llu samples per pixel", static_cast<unsigned long long>(run.spp));
        ImGui::PopTextWrapPos();
        note("load " + shortDuration(run.seconds.load) + ", build " + shortDuration(run.accelBuild + run.pipeline) +
             ", render " + shortDuration(run.seconds.render));
        tooltip(("Build: the scene's tree " + shortDuration(run.accelBuild) + ", pipelines of shaders " +
                 shortDuration(run.pipeline))
                    .c_str());
    } else {
        for (const char* text : {"Render time: none yet", " ", " "}) note(text); // nothing moves when there is one
    }
    ImGui::Separator();
}

void drawStatusLine(Gui& gui) {
    const app::SessionState& state = gui.state;
    std::string text = state.scene ? state.scene->title : "no scene";
    text += "   |   " + std::to_string(state.settings.width) + " x " + std::to_string(state.settings.height);
    text += "   |   " +
            (state.report.engine.empty() ? std::string("starting") : state.report.engine + ", " + state.report.device);
    if (state.renderSeconds > 0) {
        text +=
            "   |   " + withPrefix(static_cast<double>(state.status.samplesDone) / state.renderSeconds) + " samples/s";
    }
    ImGui::TextUnformatted(text.c_str());
    char fps[48];
    std::snprintf(fps, sizeof fps, "%.0f fps   F1 help", gui.figures.window.framesPerSecond);
    const float right = ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(fps).x;
    if (right > ImGui::GetItemRectSize().x + 20) {
        ImGui::SameLine(right);
        ImGui::TextDisabled("%s", fps);
    }
}

} // namespace rt::gui
