// A chart with two logarithmic axes, drawn with ImGui.
#pragma once
#include <string>
#include <vector>

#include <imgui.h>

namespace rt::gui {

struct ChartSeries {
    std::string name; // in the legend, once for all of the same name
    ImU32 color = 0;
    bool line = false;                             // else points
    std::vector<std::pair<double, double>> points; // those that are not positive are left out
};

void drawLogLogChart(const char* id, const char* xLabel, const char* yLabel, const std::vector<ChartSeries>& series,
                     ImVec2 size);

} // namespace rt::gui
