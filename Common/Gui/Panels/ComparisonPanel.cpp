#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "Common/Core/AtomicFile.h"
#include "Common/Core/Error.h"
#include "Common/Gui/Panels/Chart.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Panels/SavePaths.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr std::size_t kMostRows = 200;
constexpr float kNarrow = 34, kLeastHeight = 7; // of the panel; of table and chart: in heights of the font
// Told apart with any colour vision (Okabe and Ito).
constexpr ImU32 kCpuColor = IM_COL32(230, 159, 0, 255);
constexpr ImU32 kGpuColor = IM_COL32(86, 180, 233, 255);
constexpr ImU32 kLiveColor = IM_COL32(0, 158, 115, 255);

using app::RunRecord;

bool isGpuRun(const RunRecord& record) {
    return record.app == app::kGpuProgram;
}

// The newest first.
std::vector<const RunRecord*> chosenRuns(Gui& gui) {
    std::vector<const RunRecord*> runs;
    const std::vector<RunRecord>& all = gui.history.records();
    for (auto record = all.rbegin(); record != all.rend() && runs.size() < kMostRows; ++record) {
        const bool sameScene = gui.state.scene && record->scene == gui.state.scene->id;
        if (gui.onlyThisScene && !sameScene) continue;
        runs.push_back(&*record);
    }
    return runs;
}

std::string scientific(double value) {
    char text[24];
    std::snprintf(text, sizeof text, "%.2e", value);
    return value > 0 ? text : "-";
}

void cell(const std::string& text) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(text.c_str());
}

// What the columns do not show.
std::string provenance(const RunRecord& r) {
    const std::string lacking = lackingIn(r);
    return r.time + ", " + r.device +
           (lacking.empty() ? "" : "\nCompared with no other run: the record lacks " + lacking);
}

void drawRow(const RunRecord& r, bool isCompared) {
    ImGui::TableNextRow();
    if (isCompared) ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg0, ImGui::GetColorU32(ImGuiCol_Header));
    ImGui::TableNextColumn();
    ImGui::PushStyleColor(ImGuiCol_Text, isGpuRun(r) ? kGpuColor : kCpuColor);
    ImGui::Bullet();
    ImGui::PopStyleColor();
    ImGui::SameLine();
    ImGui::TextUnformatted(((isGpuRun(r) ? "GPU " : "CPU ") + r.engine).c_str());
    tooltip(provenance(r).c_str());
    cell(std::to_string(r.spp));
    cell(shortDuration(r.renderSeconds));
    cell((r.hasReference || r.relmse <= 0 ? "" : "~") + scientific(r.relmse));
    tooltip(r.hasReference ? "Against a reference"
                           : "The film's own estimate, from how its samples differ; with one replicate of Sobol or "
                             "strata it is too high by factors");
    cell(r.efficiency() > 0 ? withPrefix(r.efficiency()) : "-");
    cell(withPrefix(r.samplesPerSecond));
    cell(withPrefix(r.raysPerSecond));
    cell(r.lightSampling + ", " + r.sampler);
    cell(std::to_string(r.maxDepth));
    cell(std::to_string(r.width) + " x " + std::to_string(r.height));
    cell(r.scene);
    cell(r.device);
}

void drawTable(const std::vector<const RunRecord*>& runs, const app::EnginePair& pair, ImVec2 size) {
    constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_ScrollX | ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg |
                                       ImGuiTableFlags_BordersInnerV | ImGuiTableFlags_SizingFixedFit |
                                       ImGuiTableFlags_NoSavedSettings;
    if (!ImGui::BeginTable("##runs", 12, kFlags, size)) return;
    ImGui::TableSetupScrollFreeze(1, 1);
    for (const char* title : {"Engine", "SPP", "Time", "relMSE", "Efficiency", "Samples/s", "Rays/s", "Estimator",
                              "Depth", "Size", "Scene", "Device"}) {
        ImGui::TableSetupColumn(title);
    }
    ImGui::TableHeadersRow();
    for (const RunRecord* record : runs) drawRow(*record, record == pair.cpu || record == pair.gpu);
    ImGui::EndTable();
}

std::string speedUp(const app::EnginePair& pair) {
    if (pair.cpu == nullptr)
        return "Run both programs on the same work for a speed-up: all of scene, camera, size, "
               "SPP, depth, estimator and sampler";
    const RunRecord& cpu = *pair.cpu;
    const RunRecord& gpu = *pair.gpu;
    char text[160];
    const double ratio = gpu.samplesPerSecond / cpu.samplesPerSecond;
    std::snprintf(text, sizeof text, "GPU is %.3g\u00d7 %s than CPU (samples/s)", ratio >= 1 ? ratio : 1 / ratio,
                  ratio >= 1 ? "faster" : "slower");
    std::string line = text;
    if (gpu.hasReference && cpu.hasReference && cpu.efficiency() > 0 && gpu.efficiency() > 0) {
        std::snprintf(text, sizeof text, ", %.3g\u00d7 the efficiency", gpu.efficiency() / cpu.efficiency());
        line += text;
    }
    return line + ": " + gpu.scene + ", the two runs marked";
}

void exportCsv(Gui& gui) {
    const std::string file = (saveFolder(gui.settings.saveFolder) / "ray-tracing-history.csv").string();
    try {
        AtomicFile target(file);
        target.stream() << toCsv(gui.history.records());
        target.commit();
        gui.say("Saved " + file, false);
    } catch (const Error& error) {
        gui.say(error.what(), true);
    }
}

void drawReference(Gui& gui) {
    const app::SessionState& state = gui.state;
    const float space = ImGui::GetStyle().ItemSpacing.x;
    std::string text = state.reference.empty() ? "Reference: none" : "Reference: " + state.reference;
    if (!state.reference.empty() && !state.referenceFits) text += " (of another view or size)";
    if (state.isReferenceRender) text = "Reference: being rendered";
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    if (state.relmse) {
        const std::string error = (state.curve.empty() ? "relMSE ~" : "relMSE ") + scientific(*state.relmse);
        besideIfItFits(ImGui::CalcTextSize(error.c_str()).x);
        ImGui::TextUnformatted(error.c_str());
    }
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 6);
    int spp = static_cast<int>(gui.referenceSpp);
    if (ImGui::InputInt("##referencespp", &spp, 0))
        gui.referenceSpp = static_cast<std::uint32_t>(std::clamp(spp, 16, 1 << 24));
    tooltip("Samples per pixel of the reference");
    besideIfItFits(buttonWidth("Render reference"));
    if (button("Render reference",
               "With these samples per pixel, the present scene, camera and size. Stop gives it up.",
               !state.isReferenceRender)) {
        gui.session.renderReference(gui.referenceSpp);
    }
    const float field = ImGui::GetFontSize() * 10;
    besideIfItFits(field + space + buttonWidth("Load"));
    ImGui::SetNextItemWidth(field);
    const bool entered = inputText("##referencefile", ".exr, .hdr or .pfm file", gui.referencePath);
    besideIfItFits(buttonWidth("Load"));
    if ((button("Load", "A linear image of the present size", !gui.referencePath.empty()) || entered) &&
        !gui.referencePath.empty()) {
        gui.session.loadReference(gui.referencePath);
    }
    besideIfItFits(buttonWidth("Browse"));
    if (button("Browse", "Chooses the file of a reference", true)) gui.browse(BrowseFor::Reference);
    drawErrorOf(gui, app::ErrorSource::Reference);
}

std::vector<ChartSeries> makeSeries(Gui& gui, const std::vector<const RunRecord*>& runs) {
    std::vector<ChartSeries> series;
    for (const RunRecord* record : runs) {
        const ImU32 color = isGpuRun(*record) ? kGpuColor : kCpuColor;
        const char* name = isGpuRun(*record) ? "GPU" : "CPU";
        series.push_back({name, color, false, {{record->renderSeconds, record->relmse}}});
        if (record->curve.size() < 2) continue;
        ChartSeries curve{"", (color & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 130), true, {}};
        for (const RunRecord::Point& point : record->curve) curve.points.emplace_back(point.seconds, point.relmse);
        series.push_back(std::move(curve));
    }
    if (!gui.state.curve.empty()) {
        ChartSeries live{"this render", kLiveColor, true, {}};
        for (const app::ErrorPoint& point : gui.state.curve) live.points.emplace_back(point.seconds, point.relmse);
        series.push_back(live);
        live.line = false;
        live.points = {live.points.back()};
        series.push_back(std::move(live));
    }
    return series;
}

void drawChart(Gui& gui, const std::vector<const RunRecord*>& runs, ImVec2 size) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    gui.chart = {corner.x, corner.y, size.x, size.y};
    drawLogLogChart("##chart", "seconds", "relMSE", makeSeries(gui, runs), size);
}

} // namespace

void drawComparisonPanel(Gui& gui) {
    const std::vector<const RunRecord*> runs = chosenRuns(gui);
    const app::EnginePair pair = app::newestOfEqualWork(runs);
    const ImVec2 all = ImGui::GetContentRegionAvail();
    const float space = ImGui::GetStyle().ItemSpacing.x, font = ImGui::GetFontSize();
    const bool isNarrow = all.x < kNarrow * font; // the chart is below, not beside
    const ImVec2 chart = isNarrow ? ImVec2{0, kLeastHeight * font} : ImVec2{std::floor(0.4f * all.x), all.y};
    ImGui::BeginChild("##left", {isNarrow ? 0 : all.x - chart.x - space, 0}, false);
    drawReference(gui);
    ImGui::Checkbox("This scene only", &gui.onlyThisScene);
    besideIfItFits(buttonWidth("Export CSV"));
    if (button("Export CSV", "All runs, to the folder that pictures are saved to", true)) exportCsv(gui);
    besideIfItFits(buttonWidth("Export PNG"));
    if (button("Export PNG", "The chart as it is shown, to the same folder", true)) gui.chartRequested = true;
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(speedUp(pair).c_str());
    ImGui::PopTextWrapPos();
    drawTable(runs, pair, {0, std::max(kLeastHeight * font, ImGui::GetContentRegionAvail().y)});
    if (isNarrow) drawChart(gui, runs, {ImGui::GetContentRegionAvail().x, chart.y});
    ImGui::EndChild();
    if (isNarrow) return;
    ImGui::SameLine(0, space);
    drawChart(gui, runs, chart);
}

} // namespace rt::gui
