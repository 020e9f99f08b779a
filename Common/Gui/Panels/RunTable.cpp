#include "Common/Gui/Panels/RunTable.h"

#include <string>
#include <vector>

#include <imgui.h>

#include "Common/Gui/Panels/RunTexts.h"
#include "Common/Gui/Theme.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

using app::RunRow;

constexpr float kComparedShare = 0.22f; // of the accent's colour, in rows that are compared

void cell(const std::string& text) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(text.c_str());
}

// Numbers end below each other.
void numberCell(const std::string& text) {
    ImGui::TableNextColumn();
    const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
    if (room > 0) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + room);
    ImGui::TextUnformatted(text.c_str());
}

bool isNumber(const std::string& text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

// A, B, ... Z, AA, AB, ...
std::string letters(std::size_t number) {
    std::string text(1, static_cast<char>('A' + number % 26));
    return number < 26 ? text : letters(number / 26 - 1) + text;
}

struct Column {
    std::string title;
    const char* tip;
};
std::vector<Column> columnsOf(const app::RunGroups& groups) {
    // What runs are compared by stays in sight, whatever differs between them.
    std::vector<Column> columns = {{"Engine", "The mark is that of the chart"},
                                   {"Time", "Seconds of sampling alone"},
                                   {"relMSE", "Mean squared error relative to the reference"}};
    if (groups.groups > 1) columns.push_back({"Work", "Runs of one letter did the same work: only they are compared"});
    for (const char* title : groups.columns) columns.push_back({title, "Differs between the runs that are shown"});
    const Column figures[] = {{"Error is", "Measured against a reference, or estimated by the film itself"},
                              {"1/(error\u00b7s)", "Efficiency: 1 / (relMSE x seconds)"},
                              {"Samples/s", nullptr},
                              {"Rays/s", nullptr},
                              {"Device", nullptr},
                              {"When", "UTC"}};
    columns.insert(columns.end(), std::begin(figures), std::end(figures));
    return columns;
}

// Titles with what they mean; a right click chooses columns and fits them.
void drawHeaders(const std::vector<Column>& columns) {
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    for (const Column& column : columns) {
        ImGui::TableNextColumn();
        ImGui::TableHeader(column.title.c_str());
        const std::string tip = std::string(column.tip != nullptr ? column.tip : "") +
                                (column.tip != nullptr ? "\n" : "") + "Right click: choose and fit columns";
        tooltip(tip.c_str());
    }
}

void drawEngineCell(Gui& gui, const RunRow& row) {
    const app::RunRecord& r = *row.record;
    ImGui::TableNextColumn();
    ImGui::PushID(&r);
    const float em = ImGui::GetFontSize();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    // In another colour than rows that are compared.
    ImGui::PushStyleColor(ImGuiCol_Header, ImGui::GetStyleColorVec4(ImGuiCol_HeaderActive));
    if (ImGui::Selectable("##run", gui.runs.isSelected(r), ImGuiSelectableFlags_SpanAllColumns))
        gui.runs.select(r, ImGui::GetIO().KeyCtrl);
    ImGui::PopStyleColor();
    if (ImGui::IsItemHovered()) gui.runs.hover(r);
    tooltip((runDetails(r) + "\nClick: select; with Ctrl: also. Two that are selected are compared").c_str());
    ImGui::PopID();
    const ImU32 color = ImGui::ColorConvertFloat4ToU32(engineColor(isGpuRun(r), gui.settings.colorMode));
    drawMark(*ImGui::GetWindowDrawList(), markOf(r.lightSampling), {corner.x + 0.5f * em, corner.y + 0.5f * em},
             0.25f * em, color, !r.hasReference);
    ImGui::SameLine(1.1f * em);
    ImGui::TextUnformatted(engineText(r).c_str());
}

void drawRow(Gui& gui, const RunRow& row) {
    const app::RunRecord& r = *row.record;
    ImGui::TableNextRow();
    const app::RunPair& pair = gui.runs.pair();
    if (row.record == pair.first || row.record == pair.second)
        ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg0, ImGui::GetColorU32(ImGuiCol_CheckMark, kComparedShare));
    if (gui.runs.isHovered(r))
        ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg1, ImGui::GetColorU32(ImGuiCol_HeaderHovered));
    drawEngineCell(gui, row);
    numberCell(shortDuration(r.renderSeconds));
    numberCell(errorText(r.relmse));
    if (gui.runs.groups().groups > 1) cell(letters(row.group));
    for (const std::string& text : row.cells) isNumber(text) ? numberCell(text) : cell(text);
    const bool isNoisy = r.hasReference && app::isReferenceTooNoisy(r.relmse, r.referenceError);
    cell(errorKind(r) + (isNoisy ? ", noisy reference" : ""));
    tooltip(whatErrorKindMeans(r).c_str());
    numberCell(r.efficiency() > 0 ? withPrefix(r.efficiency()) : "-");
    numberCell(withPrefix(r.samplesPerSecond));
    numberCell(withPrefix(r.raysPerSecond));
    cell(r.device + (r.isSoftware ? " (software)" : ""));
    cell(whenText(r));
}

// What all runs have in common, but for what is not meant to be read.
std::string commonText(const app::RunGroups& groups) {
    std::string text = "All: ";
    for (const app::WorkField& field : groups.common) {
        if (!field.isShort || field.value.empty()) continue;
        const std::string title = field.title;
        const bool tellsItself = title == "Scene" || title == "Size" || title == "Estimator" || title == "Sampler";
        text += (text.size() > 5 ? ", " : "") + (tellsItself ? field.value : title + " " + field.value);
    }
    return text;
}

} // namespace

void drawRunTable(Gui& gui, ImVec2 size) {
    const app::RunGroups& groups = gui.runs.groups();
    if (groups.rows.empty()) {
        ImGui::BeginChild("##none", size);
        note("No runs yet: each render that ends becomes a row");
        return ImGui::EndChild();
    }
    const std::string common = commonText(groups);
    ImGui::TextDisabled("%s", elided(common, size.x > 0 ? size.x : ImGui::GetContentRegionAvail().x).c_str());
    tooltip(common.c_str());
    size.y -= ImGui::GetTextLineHeightWithSpacing();
    const std::vector<Column> columns = columnsOf(groups);
    // Which columns are hidden belongs to those that there are.
    std::string id = "##runs";
    for (const char* title : groups.columns) id += title;
    constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_ScrollX | ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg |
                                       ImGuiTableFlags_BordersInnerV | ImGuiTableFlags_SizingFixedFit |
                                       ImGuiTableFlags_Resizable | ImGuiTableFlags_Hideable |
                                       ImGuiTableFlags_NoSavedSettings;
    if (!ImGui::BeginTable(id.c_str(), static_cast<int>(columns.size()), kFlags, size)) return;
    ImGui::TableSetupScrollFreeze(1, 1);
    for (std::size_t i = 0; i < columns.size(); ++i)
        ImGui::TableSetupColumn(columns[i].title.c_str(), i == 0 ? ImGuiTableColumnFlags_NoHide : 0);
    drawHeaders(columns);
    for (const RunRow& row : groups.rows) drawRow(gui, row);
    ImGui::EndTable();
}

} // namespace rt::gui
