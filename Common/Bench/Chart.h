// Line charts on logarithmic axes, as SVG that needs nothing else.
#pragma once
#include <string>
#include <vector>

namespace rt::bench {

struct ChartPoint {
    double x = 0, y = 0; // > 0
    double error = 0;    // half the interval in y
};
struct ChartLine {
    std::string name;
    std::vector<ChartPoint> points;
};
struct Chart {
    std::string title, xTitle, yTitle;
    std::vector<ChartLine> lines;
    bool minusOne = false; // a dotted guide of slope -1
};

// Empty when no line has a point. Points that are not positive are left out.
std::string toSvg(const Chart& chart);

} // namespace rt::bench
