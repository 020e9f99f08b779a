// Several settings against each other on one clock: who races, how it stands, what is kept of it.
#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "Common/App/Interactive/RaceFiles.h"
#include "Common/Gui/Icons.h"
#include "Common/Gui/Panels/Chart.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Panels/RunTexts.h"
#include "Common/Gui/Panels/SavePaths.h"
#include "Common/Gui/Theme.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

using app::RaceEntrant;
using app::RaceLane;
using RacePhase = app::RaceState::Phase;

constexpr float kChartShare = 0.36f, kMinChart = 12, kNarrowPanel = 44; // of the width; in heights of the font
constexpr Mark kEntrantMarks[] = {Mark::Circle, Mark::Square, Mark::Diamond, Mark::Triangle};
constexpr float kMinColumn = 2.5f;    // of a choice beside others, in heights of a row
constexpr double kNoisyReference = 2; // its own error, which is subtracted, may be that part of the least one
// What most races are about has a column each; the other methods are in a menu.
constexpr std::string_view kColumnKeys[] = {"light_sampling", "sampler", "light_selection"};

bool hasColumn(std::string_view key) {
    return std::find(std::begin(kColumnKeys), std::end(kColumnKeys), key) != std::end(kColumnKeys);
}

bool isUnderWay(const Gui& gui) {
    return gui.state.race && gui.state.race->phase != RacePhase::Over;
}

// At first the present settings race against those that do without light sampling, or with it.
void fillForm(Gui& gui) {
    std::vector<RaceEntrant>& entrants = gui.race.entrants;
    if (!entrants.empty()) return;
    using app::LightSampling;
    RaceEntrant entrant{gui.settings.request.settings};
    entrants.push_back(entrant);
    LightSampling& estimator = entrant.settings.lightSampling;
    estimator = estimator == LightSampling::Bsdf ? LightSampling::Mis : LightSampling::Bsdf;
    entrants.push_back(entrant);
}

// The lane that this entrant of the form had in the last race; null: none, or it has been changed since.
const RaceLane* laneOf(const Gui& gui, std::size_t entrant) {
    if (!gui.state.race || entrant >= gui.state.race->lanes.size()) return nullptr;
    const RaceLane& lane = gui.state.race->lanes[entrant];
    return lane.entrant == gui.race.entrants[entrant] ? &lane : nullptr;
}

// ---- who races -----------------------------------------------------------------------------------------------------

// The methods that have no column.
void drawMoreMethods(RaceEntrant& entrant) {
    const float em = ImGui::GetFontSize();
    ImGui::Dummy({30 * em, 0}); // the rows divide the menu's width
    const app::RenderSettings defaults;
    const auto draw = [](const char* key, const char* title, const char* help, const auto& table, auto& value,
                         const auto& byDefault) {
        if (hasColumn(key)) return;
        markNextRow(value != byDefault);
        combo(title, help, table, value);
    };
    app::forEachMethod(draw, entrant.settings, defaults);
}

bool hasMoreMethods(const RaceEntrant& entrant) {
    const app::RenderSettings defaults;
    bool any = false;
    const auto look = [&any](const char* key, const char*, const char*, const auto&, const auto& value,
                             const auto& byDefault) { any = any || (!hasColumn(key) && value != byDefault); };
    app::forEachMethod(look, entrant.settings, defaults);
    return any;
}

void drawColumns(RaceEntrant& entrant, float width) {
    const auto draw = [width](const char* key, const char* title, const char*, const auto& table, auto& value) {
        if (!hasColumn(key)) return;
        ImGui::SameLine();
        ImGui::SetNextItemWidth(width);
        comboField(key, table, value);
        tooltip((std::string(title) + ": " + app::titleOf(table, value)).c_str());
    };
    app::forEachMethod(draw, entrant.settings);
}

// The other program does the same work, and there is one device that it has.
std::string whyNotOnOther(const Gui& gui, std::size_t entrant) {
    const std::vector<RaceEntrant>& entrants = gui.race.entrants;
    for (std::size_t i = 0; i < entrants.size(); ++i)
        if (i != entrant && entrants[i].isOther) return "one at a time: it has one device";
    return gui.whyNotOther();
}

void drawProgram(Gui& gui, std::size_t entrant) {
    RaceEntrant& own = gui.race.entrants[entrant];
    const std::string why = own.isOther ? "" : whyNotOnOther(gui, entrant);
    if (button(own.isOther == gui.isGpu ? "CPU" : "GPU",
               "Which program renders it. The other one does so at the same time, on its own device and by its own "
               "clock; its pictures are raw",
               {why.empty(), why.c_str()}))
        own.isOther = !own.isOther;
    if (own.isOther) own.isDenoised = false;
}

// The colour and mark of its curve, which shows its picture.
void drawShow(Gui& gui, std::size_t entrant, bool canShow) {
    const float side = ImGui::GetFrameHeight();
    const bool isOn = canShow && gui.race.shown == entrant;
    if (isOn) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    const bool isPressed =
        button("##show", "Shows its picture; again: that of whoever leads", {canShow, "it has not raced yet"}, side);
    if (isOn) ImGui::PopStyleColor();
    const ImVec2 corner = ImGui::GetItemRectMin();
    drawMark(*ImGui::GetWindowDrawList(), kEntrantMarks[entrant], {corner.x + 0.5f * side, corner.y + 0.5f * side},
             0.25f * side, ImGui::ColorConvertFloat4ToU32(entrantColor(entrant, gui.settings.colorMode)), false);
    if (!isPressed) return;
    gui.race.shown = gui.race.shown == entrant ? std::nullopt : std::optional(entrant);
    gui.session.showInRace(gui.race.shown);
}

void drawStanding(const Gui& gui, const RaceLane& lane, std::size_t entrant) {
    std::string text = lane.name + ": " + shortDuration(lane.seconds);
    if (!lane.curve.empty()) {
        text += ", " + std::to_string(static_cast<std::uint64_t>(lane.curve.back().spp)) + " spp, relMSE " +
                errorText(lane.curve.back().relmse);
        const auto standing = app::standingOf(gui.state.race->lanes);
        const auto factor = standing ? app::factorOf(gui.state.race->lanes, *standing, entrant) : std::nullopt;
        if (factor) text += *factor > 1 ? ", " + factorText(*factor) + " behind" : ", leads";
    }
    if (!lane.trouble.empty()) return wrapped(lane.name + ": " + lane.trouble, errorColor(gui.settings.colorMode));
    ImGui::TextDisabled("%s", elided(text, ImGui::GetContentRegionAvail().x).c_str());
    tooltip((text + (lane.device.empty() ? "" : "\n" + lane.engine + ", " + lane.device)).c_str());
}

// False: it is to be removed.
bool drawEntrant(Gui& gui, std::size_t entrant) {
    std::vector<RaceEntrant>& entrants = gui.race.entrants;
    RaceEntrant& own = entrants[entrant];
    const RaceLane* lane = laneOf(gui, entrant);
    const float gap = ImGui::GetStyle().ItemSpacing.x, side = ImGui::GetFrameHeight();
    const float fixed = 3 * side + buttonWidth("...") + buttonWidth("GPU") + 7 * gap;
    const float all = ImGui::GetContentRegionAvail().x;
    const bool isTight = all - fixed < 3 * kMinColumn * side; // the buttons stand below
    const float width = std::max(side, std::floor((all - (isTight ? side + 3 * gap : fixed)) / 3));
    bool stays = true;
    ImGui::PushID(static_cast<int>(entrant));
    drawShow(gui, entrant, lane != nullptr && gui.state.race->isShown);
    {
        const Disabled rest(isUnderWay(gui), "the race is under way");
        drawColumns(own, width);
        if (!isTight) ImGui::SameLine();
        const bool isMarked = hasMoreMethods(own);
        if (isMarked) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_CheckMark));
        if (button("...", "The other methods; coloured where one is not at its default", true))
            ImGui::OpenPopup("##more");
        if (isMarked) ImGui::PopStyleColor();
        if (ImGui::BeginPopup("##more")) {
            drawMoreMethods(own);
            ImGui::EndPopup();
        }
        ImGui::SameLine();
        if (iconButton("denoise", Icon::Denoise, "Its pictures are filtered, and the filter's time counts",
                       {!own.isOther, "pictures of the other program are raw"}, own.isDenoised))
            own.isDenoised = !own.isDenoised;
        ImGui::SameLine();
        drawProgram(gui, entrant);
        ImGui::SameLine();
        stays = !iconButton("remove", Icon::Close, "Takes it out of the race",
                            {entrants.size() > app::kMinEntrants, "a race has two entrants at least"});
    }
    if (lane != nullptr) drawStanding(gui, *lane, entrant);
    ImGui::PopID();
    return stays;
}

void drawEntrants(Gui& gui) {
    std::vector<RaceEntrant>& entrants = gui.race.entrants;
    std::optional<std::size_t> removed;
    for (std::size_t i = 0; i < entrants.size(); ++i)
        if (!drawEntrant(gui, i)) removed = i;
    if (removed) entrants.erase(entrants.begin() + static_cast<std::ptrdiff_t>(*removed));
}

// ---- the race ------------------------------------------------------------------------------------------------------

const char* whyNotStart(const Gui& gui) {
    if (!gui.state.scene || !gui.state.stage.empty()) return "the scene is being prepared";
    if (gui.state.picture.isPreview) return "ray tracing is off";
    const auto isOther = [](const RaceEntrant& e) { return e.isOther; };
    const std::vector<RaceEntrant>& entrants = gui.race.entrants;
    const bool needsOther = std::any_of(entrants.begin(), entrants.end(), isOther);
    if (needsOther && !gui.whyNotOther().empty()) return "the other program cannot do the same: see its button";
    return nullptr;
}

void drawStart(Gui& gui) {
    std::vector<RaceEntrant>& entrants = gui.race.entrants;
    if (isUnderWay(gui)) {
        if (button("Stop race", "Ends it; what has been measured stays", true)) gui.session.stopRace();
    } else {
        const char* why = whyNotStart(gui);
        if (button("Start race",
                   "Renders a reference, if there is none that is good enough, then the entrants in turns: each gets "
                   "the same time of sampling. The film rests meanwhile and goes on when this panel is closed",
                   {why == nullptr, why})) {
            gui.race.shown.reset();
            gui.session.race({entrants, gui.settings.raceSeconds});
        }
    }
    const Disabled rest(isUnderWay(gui), "the race is under way");
    besideIfItFits(5 * ImGui::GetFontSize() + ImGui::CalcTextSize("s each").x);
    double& seconds = gui.settings.raceSeconds;
    ImGui::SetNextItemWidth(5 * ImGui::GetFontSize());
    ImGui::InputDouble("s each", &seconds, 0, 0, "%g");
    if (ImGui::IsItemDeactivatedAfterEdit()) seconds = std::clamp(seconds, app::kMinRaceSeconds, app::kMaxRaceSeconds);
    tooltip("Seconds of sampling that each entrant gets");
    besideIfItFits(buttonWidth("Add entrant"));
    if (button("Add entrant", "With the settings of the panel Rendering",
               {entrants.size() < app::kMaxEntrants, "four are the most"}))
        entrants.push_back({gui.settings.request.settings});
}

// What was raced must be what is edited still.
const char* whyNotRunFile(const Gui& gui) {
    if (!gui.state.race) return "there has been no race";
    if (const char* why = app::whyNoSuite(*gui.state.race)) return why;
    const std::uint64_t raced = gui.state.race->work.request.edits;
    const bool isSame = raced == 0 || (raced == gui.state.sceneEdits && gui.editor.isUpToDate(gui.state));
    return isSame ? nullptr : "the scene has been edited since the race";
}

// A new one in the folder of pictures.
std::filesystem::path raceFile(const Gui& gui, const char* extension) {
    const std::filesystem::path folder = saveFolder(gui.settings.saveFolder);
    for (int i = 1;; ++i) {
        std::filesystem::path file = folder / ("race" + (i > 1 ? "-" + std::to_string(i) : std::string()) + extension);
        std::error_code none;
        if (!std::filesystem::exists(file, none)) return file;
    }
}

void saveRunFile(Gui& gui) {
    const bool isEdited = gui.state.race->work.request.edits > 0;
    const std::string sceneFile = isEdited ? raceFile(gui, "-scene.json").string() : std::string();
    if (isEdited)
        gui.exporting.startEdited(gui.editor.document()->scene(), app::wholeSource(gui.state.source), gui.state.moment,
                                  gui.assetsBelow, sceneFile);
    gui.saveText(raceFile(gui, ".json"), app::raceSuite(*gui.state.race, gui.isGpu, sceneFile));
}

void drawSaves(Gui& gui) {
    const bool hasCurves = gui.state.race && std::any_of(gui.state.race->lanes.begin(), gui.state.race->lanes.end(),
                                                         [](const RaceLane& lane) { return !lane.curve.empty(); });
    constexpr const char* kNone = "there is nothing to save yet";
    if (button("Save table", "Every point of every curve as CSV, to the folder that pictures are saved to",
               {hasCurves, kNone}))
        gui.saveText(raceFile(gui, ".csv"), app::raceTable(*gui.state.race, gui.isGpu));
    besideIfItFits(buttonWidth("Save picture"));
    if (button("Save picture", "The chart with its headline as PNG, to the same folder", {hasCurves, kNone}))
        gui.partToSave = SavedPart{gui.race.chart, raceFile(gui, ".png")};
    besideIfItFits(buttonWidth("Save run file"));
    const char* why = whyNotRunFile(gui);
    if (button("Save run file",
               "A suite by which ray-tracing-bench repeats the race, to the same folder; of an edited scene with a "
               "scene file beside it",
               {why == nullptr, why}))
        saveRunFile(gui);
}

// What one should know of how it was measured.
void drawNotes(const Gui& gui) {
    const std::vector<RaceLane>& lanes = gui.state.race->lanes;
    const auto isOther = [](const RaceLane& lane) { return lane.entrant.isOther; };
    if (std::any_of(lanes.begin(), lanes.end(), isOther)) {
        const bool isShared =
            std::any_of(lanes.begin(), lanes.end(), [](const RaceLane& lane) { return lane.isSoftware; });
        note(std::string("CPU and GPU render at once, each by its own clock") +
             (isShared ? ". This GPU is software: both share the processor" : ""));
    }
    const auto isUncertain = [&gui](const RaceLane& lane) {
        return !lane.curve.empty() && kNoisyReference * gui.state.race->referenceError > lane.curve.back().relmse;
    };
    if (std::any_of(lanes.begin(), lanes.end(), isUncertain))
        wrapped("The reference is not much better than the best entrant: take a longer race",
                noticeColor(gui.settings.colorMode));
}

std::string headline(const Gui& gui) {
    if (!gui.state.race) return "No race yet";
    const app::RaceState& race = *gui.state.race;
    if (const auto standing = app::standingOf(race.lanes)) return app::headlineOf(race.lanes, *standing);
    switch (race.phase) {
        case RacePhase::Preparing:
            return race.stage;
        case RacePhase::Reference:
            return "Reference: " + roughDuration(race.referenceSeconds) + " of at least " +
                   roughDuration(race.referenceWanted);
        case RacePhase::Running:
            return "The first errors are yet to come";
        case RacePhase::Over:
            break;
    }
    return race.ending.empty() ? "Nobody can be compared" : "Over: " + race.ending;
}

void drawRaceChart(Gui& gui, ImVec2 size) {
    std::vector<ChartSeries> series;
    std::vector<ChartLegendRow> legend;
    const std::vector<RaceLane> lanes = gui.state.race ? gui.state.race->lanes : std::vector<RaceLane>();
    for (std::size_t i = 0; i < lanes.size(); ++i) {
        const ImU32 color = ImGui::ColorConvertFloat4ToU32(entrantColor(i, gui.settings.colorMode));
        ChartSeries line{color, Mark::Line, false, false, {}, {}};
        for (const app::ErrorPoint& point : lanes[i].curve) line.points.emplace_back(point.seconds, point.relmse);
        legend.push_back({lanes[i].name, color, kEntrantMarks[i], false});
        series.push_back(line);
        line.mark = kEntrantMarks[i];
        series.push_back(std::move(line));
    }
    drawLogLogChart("##race", "seconds each", "relMSE", series, legend, size);
}

} // namespace

void drawRacePanel(Gui& gui) {
    fillForm(gui);
    const ImVec2 all = ImGui::GetContentRegionAvail();
    const float space = ImGui::GetStyle().ItemSpacing.x, font = ImGui::GetFontSize();
    const bool isNarrow = all.x < kNarrowPanel * font; // the chart is below, not beside
    const float width = isNarrow ? all.x : std::floor(kChartShare * all.x);
    if (!isNarrow) ImGui::BeginChild("##entrants", {all.x - width - space, 0});
    drawStart(gui);
    drawEntrants(gui);
    drawSaves(gui);
    if (gui.state.race) drawNotes(gui);
    if (!isNarrow) {
        ImGui::EndChild();
        ImGui::SameLine(0, space);
    }
    ImGui::BeginGroup();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width);
    ImGui::TextUnformatted(headline(gui).c_str());
    ImGui::PopTextWrapPos();
    const float rest = ImGui::GetContentRegionAvail().y;
    drawRaceChart(gui, {width, std::max(kMinChart * font, rest)});
    ImGui::EndGroup();
    gui.race.chart = {corner.x, corner.y, width, ImGui::GetItemRectSize().y};
}

} // namespace rt::gui
