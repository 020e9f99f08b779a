#include "Common/Gui/Panels/EngineCards.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "Common/App/Interactive/RunGroups.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Panels/RunTexts.h"
#include "Common/Gui/Theme.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

using app::RunRecord;
using Phase = app::OtherState::Phase;

constexpr float kCardWidth = 15, kMinCardWidth = 13; // of a card, in heights of the font

struct CardLine {
    std::string name, value;
};

// A title in the engine's colour, then lines of a name at the left and a number at the right.
void drawCard(float width, const char* title, ImU32 color, const std::vector<CardLine>& lines, const std::string& tip) {
    const float em = ImGui::GetFontSize(), pad = 0.4f * em;
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size{width, line * static_cast<float>(lines.size() + 1) + 2 * pad};
    ImGui::Dummy(size);
    tooltip(tip.c_str());
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 end{corner.x + size.x, corner.y + size.y};
    list.AddRectFilled(corner, end, ImGui::GetColorU32(ImGuiCol_FrameBg), 0.3f * em);
    list.AddRectFilled(corner, {corner.x + 0.25f * em, end.y}, color, 0.3f * em);
    const ImU32 text = ImGui::GetColorU32(ImGuiCol_Text), dim = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    const float left = corner.x + 0.25f * em + pad;
    float y = corner.y + pad;
    list.AddText({left, y}, color, elided(title, width - 2 * pad).c_str());
    for (const CardLine& row : lines) {
        y += line;
        list.AddText({left, y}, dim, row.name.c_str());
        list.AddText({end.x - pad - ImGui::CalcTextSize(row.value.c_str()).x, y}, text, row.value.c_str());
    }
}

void drawRunCard(const Gui& gui, float width, const RunRecord* run, bool isGpu) {
    const ImU32 color = ImGui::ColorConvertFloat4ToU32(engineColor(isGpu, gui.settings.colorMode));
    if (run == nullptr)
        return drawCard(width, isGpu ? "GPU" : "CPU", color, {{"No run of this work yet", ""}, {"", ""}, {"", ""}},
                        "The cards show runs of what is in view: the same scene, camera, size, SPP, depth, estimator "
                        "and sampler. Two rows that are selected in the table are compared, whatever they are of");
    const std::string kind = errorKind(*run);
    drawCard(width, engineText(*run).c_str(), color,
             {{"Time", shortDuration(run->renderSeconds)},
              {"Samples/s", withPrefix(run->samplesPerSecond)},
              {kind.empty() ? "relMSE" : "relMSE, " + kind, errorText(run->relmse)}},
             runDetails(*run) + "\n" + whatErrorKindMeans(*run));
}

// What differs in what both did.
std::string differenceOf(const app::RunPair& pair) {
    const std::vector<app::WorkField> first = app::workOf(*pair.first), second = app::workOf(*pair.second);
    std::string text;
    for (std::size_t i = 0; i < first.size(); ++i)
        if (first[i].value != second[i].value) text += (text.empty() ? "" : ", ") + std::string(first[i].title);
    return text;
}

void drawSpeedUp(float width, const app::RunPair& pair) {
    const app::Comparison comparison = app::compareRuns(*pair.first, *pair.second);
    std::string toError = "not known",
                tip = "Needs the errors of both runs, of one kind and of one picture: render or load a reference";
    if (comparison.timeToEqualError > 0) {
        toError = ratioText(comparison.timeToEqualError);
        tip = std::string(
                  "Time to equal error: relMSE falls as the number of samples grows, so that the time to equal error "
                  "is as relMSE "
                  "times seconds. Errors are ") +
              (comparison.isMeasured ? "measured against a reference" : "the films' own estimates, no measurements");
    }
    const std::string kind = comparison.timeToEqualError <= 0 ? "" : comparison.isMeasured ? "measured" : "estimated";
    const std::string difference = differenceOf(pair);
    if (!difference.empty()) tip += "\nThe work differs in: " + difference;
    const auto name = [](const RunRecord& run) { return isGpuRun(run) ? "GPU" : "CPU"; };
    const bool areAlike = isGpuRun(*pair.first) == isGpuRun(*pair.second);
    const std::string title =
        areAlike ? "Second against first" : std::string(name(*pair.second)) + " against " + name(*pair.first);
    drawCard(width, title.c_str(), ImGui::GetColorU32(ImGuiCol_Text),
             {{"Equal error", toError},
              {"Errors", kind.empty() ? "-" : kind},
              {"Samples/s", ratioText(comparison.samplesPerSecond)}},
             tip);
}

void drawHeadline(const Gui& gui) {
    const app::RunPair& pair = gui.runs.pair();
    if (pair.first == nullptr)
        return ImGui::TextDisabled("%s", elided("Compared are two rows that are selected, or runs of both programs of "
                                                "what is in view: there are none yet",
                                                ImGui::GetContentRegionAvail().x)
                                             .c_str());
    const std::string text = headlineOf(pair, app::compareRepeats(pair, gui.runs.groups().rows));
    ImGui::TextUnformatted(elided(text, ImGui::GetContentRegionAvail().x).c_str());
    tooltip((text + ".\nRuns repeat each other where work, engine, device and threads are equal; two engines are told "
                    "apart where no run of one is within the range of the other's")
                .c_str());
}

std::string otherLabel(const Gui& gui) {
    return std::string("Run on the other engine (") + (gui.isGpu ? "CPU" : "GPU") + ")";
}

void drawOther(Gui& gui) {
    const app::OtherState state = gui.other.state();
    const std::string name = gui.isGpu ? "CPU" : "GPU";
    if (state.phase == Phase::Running || gui.otherIsWanted) {
        const bool runs = state.phase == Phase::Running;
        const float share =
            runs && state.sppWanted > 0
                ? static_cast<float>(static_cast<double>(state.spp) / static_cast<double>(state.sppWanted))
                : 0.0f;
        const std::string text = !runs            ? "after this render"
                                 : state.spp == 0 ? name + ": starting"
                                                  : name + ": " + std::to_string(state.spp) + " / " +
                                                        std::to_string(state.sppWanted) + " spp";
        const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
        ImGui::ProgressBar(share, {buttonWidth(otherLabel(gui).c_str()) - buttonWidth("Cancel") - gap, 0},
                           text.c_str());
        ImGui::SameLine(0, gap);
        if (button("Cancel", "Ends the other program; nothing is kept of its render", true)) gui.cancelOther();
        return;
    }
    const std::string why = gui.whyNotOther();
    const std::string tip =
        "The same scene, camera, size, samples and settings by the other program, without a "
        "window. Its picture is pinned beside this one, its run goes to the table. This render "
        "ends first: two at a time would slow each other down" +
        (why.empty() ? "" : ".\n" + why);
    if (button(otherLabel(gui).c_str(), tip.c_str(), why.empty())) gui.otherIsWanted = true;
    if (state.phase == Phase::Failed) wrapped(state.error, errorColor(gui.settings.colorMode));
    if (state.phase == Phase::Cancelled) note(name + ": cancelled");
}

} // namespace

void drawEngineCards(Gui& gui, const std::function<void()>& drawMore) {
    const app::RunPair& pair = gui.runs.pair();
    const bool isPair = pair.first != nullptr;
    drawHeadline(gui);
    const float em = ImGui::GetFontSize(), gap = ImGui::GetStyle().ItemSpacing.x, cards = isPair ? 3 : 2;
    const float rest = ImGui::GetContentRegionAvail().x - buttonWidth(otherLabel(gui).c_str()) - cards * gap;
    const float width = std::floor(std::clamp(rest / cards, kMinCardWidth * em, kCardWidth * em));
    drawRunCard(gui, width, isPair ? pair.first : gui.runs.cpuRun(), isPair && isGpuRun(*pair.first));
    besideIfItFits(width);
    drawRunCard(gui, width, isPair ? pair.second : gui.runs.gpuRun(), !isPair || isGpuRun(*pair.second));
    if (isPair) {
        besideIfItFits(width);
        drawSpeedUp(width, pair);
    }
    besideIfItFits(buttonWidth(otherLabel(gui).c_str()));
    ImGui::BeginGroup();
    drawOther(gui);
    drawMore();
    ImGui::EndGroup();
}

} // namespace rt::gui
