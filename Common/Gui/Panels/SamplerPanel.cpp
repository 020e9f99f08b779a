// What light sampling does at a point of the picture: which directions a strategy draws, by which density, how well.
#include <algorithm>
#include <string>
#include <vector>

#include "Common/Core/Format.h"
#include "Common/Core/Printable.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Panels/SamplerMap.h"
#include "Common/Gui/Panels/SavePaths.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr std::uint32_t kMostSamples = 10'000'000, kMostPaths = 4096, kMostStrata = 64;
constexpr app::Named<SampleSpace> kSpaces[] = {
    {"sphere", SampleSpace::Sphere, "All directions", probe::kProjections[0].help},
    {"hemisphere", SampleSpace::Hemisphere, "Hemisphere", probe::kProjections[1].help},
    {"square", SampleSpace::UnitSquare, "Unit square", "the random numbers that the directions are made of"}};

// ---- what is asked -------------------------------------------------------------------------------------------------

std::string titleOf(const probe::Strategy& strategy, const probe::ProbeResult* result) {
    if (strategy.kind != probe::StrategyKind::Light) return app::titleOf(probe::kStrategies, strategy.kind);
    std::string title = "Light " + std::to_string(strategy.light);
    if (result == nullptr) return title;
    for (const probe::LightShare& share : result->selection)
        if (share.light == strategy.light) title += formatted("  (%.3g %%)", 100.0 * share.probability);
    return title;
}

void chooseStrategy(Gui& gui, const probe::Strategy& strategy, const probe::ProbeResult* result) {
    probe::Strategy& chosen = gui.sampling.settings.strategy;
    if (ImGui::Selectable(titleOf(strategy, result).c_str(), chosen == strategy)) chosen = strategy;
}

void drawStrategies(Gui& gui, const probe::ProbeResult* result) {
    row("Strategy",
        "By which directions are drawn; with a light's number by its shape alone: how often it is chosen here, "
        "stands beside it");
    if (!ImGui::BeginCombo("##strategy", titleOf(gui.sampling.settings.strategy, result).c_str())) return;
    for (const auto& strategy : probe::kStrategies) {
        chooseStrategy(gui, {strategy.value}, result);
        tooltip(strategy.help);
    }
    ImGuiListClipper lights;
    lights.Begin(static_cast<int>(gui.state.scene->globals.lightCount));
    while (lights.Step())
        for (int i = lights.DisplayStart; i < lights.DisplayEnd; ++i)
            chooseStrategy(gui, {probe::StrategyKind::Light, static_cast<std::uint32_t>(i)}, result);
    ImGui::EndCombo();
}

void drawQuestion(Gui& gui, const probe::ProbeResult* result) {
    SamplerView& sampling = gui.sampling;
    drawStrategies(gui, result);
    combo("Map", "What brightness stands for", probe::kQuantities, sampling.settings.quantity);
    if (combo("Shown on", nullptr, kSpaces, sampling.space) && sampling.space != SampleSpace::UnitSquare)
        sampling.settings.projections = {sampling.space == SampleSpace::Sphere ? probe::Projection::Sphere
                                                                               : probe::Projection::Hemisphere};
}

// What is changed less often.
void drawSettings(Gui& gui) {
    SamplerView& sampling = gui.sampling;
    probe::ProbeSettings& settings = sampling.settings;
    double scale = sampling.scale;
    if (sliderReal("Brightness", "Of the map", scale, 1, 10000, "%.3g", true))
        sampling.scale = static_cast<float>(scale);
    checkbox("Show samples", "The first 512: those of lights are orange, those of the BSDF blue",
             sampling.showsSamples);
    checkbox("Show strata", "The cells of the unit square, and what becomes of each", settings.showsStrata);
    {
        const bool isUsed = settings.showsStrata || settings.numbers.kind == app::SamplerKind::Stratified;
        const Disabled rest(!isUsed, "neither stratified nor shown");
        inputCount("Cells a side", "Of the unit square", settings.numbers.strata, 1, kMostStrata, 1);
    }
    combo("Numbers", "Where those of samples come from", probe::kProbeSamplers, settings.numbers.kind);
    inputCount("Samples", "To be tested, and of each strategy's variance", settings.samples, 2, kMostSamples, 4096);
    const Disabled rest(!isTraced(settings.quantity), "for maps of radiance and product");
    inputCount("Paths", "Of each cell of the map, where rays are traced", settings.paths, 1, kMostPaths, 16);
}

// ---- what is answered ----------------------------------------------------------------------------------------------

// What integral and dropped samples say; the former is known to its error.
void drawTotal(const probe::ProbeResult& result) {
    const double dropped = result.samples > 0 ? 100.0 * result.dropped / result.samples : 0;
    const bool isWrong = !result.tests.empty() && result.tests.back().test.total < probe::DensityTest::kSuspicious;
    note(formatted("Integral %.4f +- %.1g; %.3g %% of samples dropped", result.density.integral(),
                   result.density.integralError(), dropped) +
         (isWrong ? ": that does not make 1" : ""));
    tooltip(
        "Of the density over all directions: 1, less what is dropped as absorbed, below the surface, on the back of a "
        "lamp, or of a light without extent");
}

void drawTest(const probe::ProbeResult& result) {
    drawTotal(result);
    if (result.tests.empty()) return note("Chi-square: after the map");
    const probe::TestOf& last = result.tests.back();
    const auto& cells = last.test.cells;
    if (!cells) return note("Chi-square: too few samples or cells");
    const std::string found = formatted("Chi-square %.1f of %zu degrees: ", cells->statistic, cells->degrees);
    ImGui::TextUnformatted(
        (found + (last.test.isResolved() ? formatted("p = %.3f", cells->p) : "not resolved")).c_str());
    tooltip(
        "Pearson's test of the samples against the map. Below 0.001: they do not follow the density. Close to 1: "
        "they follow it better than by chance, as stratified ones do. Not resolved: the density is too fine for its "
        "integrals over cells to be known well enough for so many samples, and p says nothing");
    std::vector<float> growth;
    for (const probe::TestOf& test : result.tests)
        if (test.test.cells) growth.push_back(static_cast<float>(test.test.cells->p));
    ImGui::PlotLines("##growth", growth.data(), static_cast<int>(growth.size()), 0, nullptr, 0, 1,
                     {ImGui::GetContentRegionAvail().x, 2.5f * ImGui::GetFontSize()});
    tooltip(("p from 0 to 1, as samples grow; here " + withPrefix(last.samples)).c_str());
}

// The best one first, with the others by the measure of the best that is not exact.
void drawVariances(const probe::ProbeResult& result) {
    std::vector<probe::EstimateOf> sorted;
    for (const probe::EstimateOf& estimate : result.estimates)
        if (estimate.samples > 0) sorted.push_back(estimate);
    if (sorted.empty()) return;
    std::ranges::sort(sorted, {}, &probe::EstimateOf::variance);
    if (!ImGui::BeginTable("##variances", 3, ImGuiTableFlags_BordersInnerH | ImGuiTableFlags_SizingFixedFit)) return;
    ImGui::TableSetupColumn("Strategy", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("Variance a sample");
    ImGui::TableSetupColumn("Ratio");
    ImGui::TableHeadersRow();
    const auto first = std::ranges::find_if_not(sorted, &probe::EstimateOf::isExact);
    const double best = first == sorted.end() ? 0 : first->variance;
    for (const probe::EstimateOf& estimate : sorted) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(estimate.title.c_str());
        tooltip(formatted("Mean %.4g: light of lamps and sky that comes by way of the point", estimate.mean).c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(estimate.isExact() ? "0" : formatted("%.3g", estimate.variance).c_str());
        ImGui::TableNextColumn();
        const std::string ratio = best > 0 ? formatted("%.3g", estimate.variance / best) : "-";
        ImGui::TextUnformatted(estimate.isExact() ? "exact" : ratio.c_str());
        if (estimate.isExact()) tooltip("Every sample has the same value, but for rounding");
    }
    ImGui::EndTable();
}

void drawAnswer(Gui& gui, const probe::ProbeState& state) {
    const probe::ProbeResult& result = state.result;
    note(formatted("At %.3g, %.3g, %.3g of ", static_cast<double>(result.position.x),
                   static_cast<double>(result.position.y), static_cast<double>(result.position.z)) +
         printable(result.material, 40) + (result.isDone ? "" : " ..."));
    drawSamplerMap(gui, state);
    drawTest(result);
    drawVariances(result);
}

void savePoint(Gui& gui, const PickedPixel& point) {
    gui.probe.save(probePath(gui.settings.saveFolder, gui.state, point.pixel), wishAt(gui, point));
}

} // namespace

void drawSamplerPanel(Gui& gui) {
    if (!gui.state.scene || !gui.state.picture.image) return note("There is no picture yet");
    SamplerView& sampling = gui.sampling;
    sampling.isShown = true;
    const float space = ImGui::GetStyle().ItemSpacing.x, width = (ImGui::GetContentRegionAvail().x - space) / 2;
    drawPickButton(sampling, "Pick a point", width);
    ImGui::SameLine(0, space);
    const Usable canSave{sampling.point && !gui.probe.isSaving(),
                         sampling.point ? "it is being saved" : "no point was picked yet"};
    if (button("Save PNG and JSON", "As ray-tracing-image probe does", canSave, width)) savePoint(gui, *sampling.point);
    if (!sampling.point) {
        gui.probe.wish(std::nullopt);
        return note("What light sampling does at a point of the picture: its directions, their density, its variance");
    }
    gui.probe.wish(wishAt(gui, *sampling.point));
    const auto state = gui.probe.state();
    const bool hasAnswer = state && state->whyNot.empty();
    drawQuestion(gui, hasAnswer ? &state->result : nullptr);
    if (hasAnswer)
        drawAnswer(gui, *state);
    else
        note(state ? state->whyNot : "Working ...");
    drawSettings(gui);
}

} // namespace rt::gui
