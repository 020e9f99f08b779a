// A chart with two logarithmic axes, drawn with ImGui.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <imgui.h>

namespace rt::gui {

enum class Mark { Circle, Square, Diamond, Triangle, Line };

struct ChartSeries {
    ImU32 color = 0;
    Mark mark = Mark::Circle;
    bool isHollow = false;
    bool isStressed = false;                       // drawn larger
    std::optional<std::size_t> id{};               // of what can be pointed at
    std::vector<std::pair<double, double>> points; // those that are not positive are left out
};
struct ChartLegendRow {
    std::string text;
    ImU32 color = 0;
    Mark mark = Mark::Circle;
    bool isHollow = false;
};

struct ChartPointer {
    std::optional<std::size_t> hovered; // id of the nearest point, where the pointer is close to it
    bool isClicked = false;
};
ChartPointer drawLogLogChart(const char* id, const char* xLabel, const char* yLabel,
                             const std::vector<ChartSeries>& series, const std::vector<ChartLegendRow>& legend,
                             ImVec2 size);

void drawMark(ImDrawList& list, Mark mark, ImVec2 at, float radius, ImU32 color, bool isHollow);

} // namespace rt::gui
