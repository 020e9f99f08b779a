#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "Common/Core/Error.h"
#include "Common/Gui/Panels/Chart.h"
#include "Common/Gui/Panels/EngineCards.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Panels/RunTable.h"
#include "Common/Gui/Panels/RunTexts.h"
#include "Common/Gui/Panels/SavePaths.h"
#include "Common/Gui/Theme.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr const char* kNoneSelected = "no run is selected in the table";
constexpr float kNarrow = 34, kMinHeight = 8; // of the panel; of table and chart: in heights of the font

using app::RunRecord;

// What there is to measure against, and the error that is known by it.
void drawReferenceState(const Gui& gui) {
    const app::SessionState& state = gui.state;
    std::string text = state.reference.empty() ? "Reference: none" : "Reference: " + state.reference;
    if (!state.reference.empty() && !state.referenceFits) text += " (of another view or size)";
    if (state.isReferenceRender) text = "Reference: being rendered";
    besideIfItFits(ImGui::CalcTextSize(text.c_str()).x);
    ImGui::TextUnformatted(elided(text, ImGui::GetContentRegionAvail().x).c_str());
    tooltip(text.c_str());
    if (!state.relmse) return;
    const std::string error =
        "relMSE " + errorText(*state.relmse) + (state.curve.empty() ? ", estimated" : ", measured");
    besideIfItFits(ImGui::CalcTextSize(error.c_str()).x);
    ImGui::TextUnformatted(error.c_str());
}

void drawReferenceMenu(Gui& gui) {
    const float em = ImGui::GetFontSize(), gap = ImGui::GetStyle().ItemSpacing.x;
    ImGui::SetNextItemWidth(6 * em);
    int spp = static_cast<int>(gui.referenceSpp);
    if (ImGui::InputInt("##referencespp", &spp, 0))
        gui.referenceSpp = static_cast<std::uint32_t>(std::clamp(spp, 16, 1 << 24));
    tooltip("Samples per pixel of the reference");
    ImGui::SameLine(0, gap);
    ImGui::TextUnformatted("spp");
    ImGui::SameLine(0, gap);
    if (button("Render reference",
               "With these samples per pixel, the present scene, camera and size; those that there are of an earlier "
               "render, by whichever program, count. Stop gives it up.",
               {!gui.state.isReferenceRender && !gui.state.picture.isPreview,
                gui.state.isReferenceRender ? "one is being rendered" : "ray tracing is off"})) {
        gui.session.renderReference(gui.referenceSpp);
        ImGui::CloseCurrentPopup();
    }
    ImGui::SetNextItemWidth(14 * em);
    const bool entered = inputText("##referencefile", ".exr, .hdr or .pfm file", gui.referencePath);
    ImGui::SameLine(0, gap);
    if ((button("Load", "A linear image of the present size", {!gui.referencePath.empty(), "no file is named"}) ||
         entered) &&
        !gui.referencePath.empty()) {
        gui.session.loadReference(gui.referencePath);
        ImGui::CloseCurrentPopup();
    }
    ImGui::SameLine(0, gap);
    if (button("Browse", "Chooses the file of a reference", true)) {
        gui.browse(BrowseFor::Reference);
        ImGui::CloseCurrentPopup();
    }
}

void drawReference(Gui& gui) {
    besideIfItFits(buttonWidth("Reference..."));
    if (button("Reference...", "Renders or loads an image to measure errors against", true))
        ImGui::OpenPopup("##reference");
    if (ImGui::BeginPopup("##reference")) {
        drawReferenceMenu(gui);
        ImGui::EndPopup();
    }
    drawReferenceState(gui);
}

// What is wrong with the reference, where there is something.
void drawReferenceTrouble(Gui& gui) {
    const app::SessionState& state = gui.state;
    if (state.referenceFits && !state.curve.empty() && state.relmse &&
        app::isReferenceTooNoisy(*state.relmse, state.referenceError)) {
        wrapped("The reference is too noisy for this: its own relMSE is " + errorText(state.referenceError) +
                    ", more than a ninth of what is measured. Render it with more samples",
                noticeColor(gui.settings.colorMode));
    }
    drawErrorOf(gui, app::ErrorSource::Reference);
}

std::vector<ChartSeries> makeSeries(const Gui& gui) {
    std::vector<ChartSeries> series;
    const std::vector<app::RunRow>& rows = gui.runs.groups().rows;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const RunRecord& r = *rows[i].record;
        const ImU32 color = ImGui::ColorConvertFloat4ToU32(engineColor(isGpuRun(r), gui.settings.colorMode));
        const bool isStressed = gui.runs.isHovered(r) || gui.runs.isSelected(r);
        if (r.curve.size() > 1) {
            const ImU32 faint = (color & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, isStressed ? 255 : 130);
            ChartSeries curve{faint, Mark::Line, false, false, {}, {}};
            for (const RunRecord::Point& point : r.curve) curve.points.emplace_back(point.seconds, point.relmse);
            series.push_back(std::move(curve));
        }
        series.push_back(
            {color, markOf(r.lightSampling), !r.hasReference, isStressed, i, {{r.renderSeconds, r.relmse}}});
    }
    if (!gui.state.curve.empty()) {
        ChartSeries live{ImGui::GetColorU32(ImGuiCol_Text), Mark::Line, false, false, {}, {}};
        for (const app::ErrorPoint& point : gui.state.curve) live.points.emplace_back(point.seconds, point.relmse);
        series.push_back(live);
        live.mark = Mark::Circle;
        live.points = {live.points.back()};
        series.push_back(std::move(live));
    }
    return series;
}

// Colours are engines, marks estimators, hollow ones are estimates: what of it occurs.
std::vector<ChartLegendRow> makeLegend(const Gui& gui) {
    const ImU32 text = ImGui::GetColorU32(ImGuiCol_Text);
    std::vector<ChartLegendRow> legend;
    const std::vector<app::RunRow>& rows = gui.runs.groups().rows;
    const auto occurs = [&rows](auto test) {
        return std::any_of(rows.begin(), rows.end(), [&](const app::RunRow& row) { return test(*row.record); });
    };
    for (const bool isGpu : {false, true}) {
        if (!occurs([isGpu](const RunRecord& r) { return isGpuRun(r) == isGpu; })) continue;
        const bool isSoftware = isGpu && !occurs([](const RunRecord& r) { return isGpuRun(r) && !r.isSoftware; });
        const ImVec4 color = engineColor(isGpu, gui.settings.colorMode);
        legend.push_back({!isGpu       ? "CPU"
                          : isSoftware ? "GPU (software)"
                                       : "GPU",
                          ImGui::ColorConvertFloat4ToU32(color), Mark::Circle, false});
    }
    for (const auto& estimator : app::kLightSamplings) {
        const std::string name{estimator.name};
        if (occurs([&name](const RunRecord& r) { return r.lightSampling == name; }))
            legend.push_back({name, text, markOf(name), false});
    }
    if (occurs([](const RunRecord& r) { return r.relmse > 0 && !r.hasReference; }))
        legend.push_back({"estimated", text, Mark::Circle, true});
    if (!gui.state.curve.empty()) legend.push_back({"this render", text, Mark::Line, false});
    return legend;
}

void drawChart(Gui& gui, ImVec2 size) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    gui.chart = {corner.x, corner.y, size.x, size.y};
    const ChartPointer pointer =
        drawLogLogChart("##chart", "seconds", "relMSE", makeSeries(gui), makeLegend(gui), size);
    if (!pointer.hovered) return;
    const RunRecord& r = *gui.runs.groups().rows[*pointer.hovered].record;
    gui.runs.hover(r);
    tooltip((engineText(r) + ", " + std::to_string(r.spp) + " spp, " + shortDuration(r.renderSeconds) + ", relMSE " +
             errorText(r.relmse) + " " + errorKind(r) + "\n" + runDetails(r))
                .c_str());
    if (pointer.isClicked) gui.runs.select(r, ImGui::GetIO().KeyCtrl);
}

// What is deleted is gone for both programs: it is asked for twice.
void drawDeletion(Gui& gui, const char* id, const char* label, const char* tip, const std::vector<RunRecord>& runs,
                  const char* whyNone) {
    besideIfItFits(buttonWidth(label));
    if (button(label, tip, {!runs.empty(), whyNone})) ImGui::OpenPopup(id);
    if (!ImGui::BeginPopup(id)) return;
    ImGui::Text("Delete %zu %s from the history of both programs?", runs.size(), runs.size() == 1 ? "run" : "runs");
    if (button("Delete##yes", "They cannot be had back", true)) {
        gui.runsToDelete = runs;
        ImGui::CloseCurrentPopup();
    }
    ImGui::SameLine();
    if (button("Keep", nullptr, true)) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

void drawRunActions(Gui& gui) {
    ImGui::Checkbox("This scene only", &gui.onlyThisScene);
    const std::vector<RunRecord> selected = gui.runs.selected();
    besideIfItFits(buttonWidth("Hide"));
    if (button("Hide", "The selected runs, until the window closes", {!selected.empty(), kNoneSelected}))
        gui.runs.hideSelected();
    besideIfItFits(buttonWidth("Unhide"));
    if (button("Unhide", "Brings hidden runs back", {gui.runs.hiddenCount() > 0, "no run is hidden"}))
        gui.runs.showHidden();
    drawDeletion(gui, "##delete", "Delete", "The selected runs, from the history", selected, kNoneSelected);
    drawDeletion(gui, "##clear", "Clear", "All runs that are shown, from the history", gui.runs.shown(),
                 "no run is shown");
    besideIfItFits(buttonWidth("Export CSV"));
    if (button("Export CSV", "All runs, to the folder that pictures are saved to", true))
        gui.saveText(saveFolder(gui.settings.saveFolder) / "ray-tracing-history.csv", toCsv(gui.history.records()));
    besideIfItFits(buttonWidth("Export PNG"));
    if (button("Export PNG", "The chart as it is shown, to the same folder", true))
        gui.partToSave = SavedPart{gui.chart, saveFolder(gui.settings.saveFolder) / "ray-tracing-errors.png"};
}

RunBoard::InView inView(const Gui& gui) {
    RunBoard::InView view;
    view.picture = gui.workInView();
    if (gui.pinned) view.pinned = gui.pinned.work();
    return view;
}

void deleteRuns(Gui& gui) {
    try {
        gui.history.remove(std::exchange(gui.runsToDelete, {}));
    } catch (const Error& error) {
        gui.fail(error.what(), app::ErrorSource::Other);
    }
}

} // namespace

void drawComparisonPanel(Gui& gui) {
    if (!gui.runsToDelete.empty()) deleteRuns(gui);
    gui.runs.update(gui.history, gui.onlyThisScene && gui.state.scene ? gui.state.scene->id : "", inView(gui));
    const float space = ImGui::GetStyle().ItemSpacing.x, font = ImGui::GetFontSize();
    const bool isNarrow = ImGui::GetContentRegionAvail().x < kNarrow * font; // the chart is below, not beside
    drawEngineCards(gui, [&gui] { drawReference(gui); });
    drawReferenceTrouble(gui);
    drawRunActions(gui);
    const ImVec2 all = ImGui::GetContentRegionAvail();
    const float height = std::max(kMinHeight * font, all.y);
    if (isNarrow) {
        drawRunTable(gui, {0, kMinHeight * font});
        return drawChart(gui, {all.x, kMinHeight * font});
    }
    const float chart = std::floor(0.35f * all.x);
    ImGui::BeginGroup();
    drawRunTable(gui, {all.x - chart - space, height});
    ImGui::EndGroup();
    ImGui::SameLine(0, space);
    drawChart(gui, {chart, height});
}

} // namespace rt::gui
