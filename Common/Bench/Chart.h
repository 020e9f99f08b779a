// Line charts on logarithmic axes, as SVG that needs nothing else.
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace rt::bench {

using Origin = const void*; // what a point or a row of a table shows: the same address where it is the same

struct ChartPoint {
    double x = 0, y = 0;      // > 0
    double error = 0;         // half the interval in y
    Origin origin = nullptr;  // null: nothing else shows it
    std::string caption = {}; // what the point says when it is pointed at
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

// Empty when no line has a point. Points that are not positive are left out. `linkOf`, which may be empty, gives where a
// point leads to, or "".
std::string toSvg(const Chart& chart, const std::function<std::string(Origin)>& linkOf = {});

} // namespace rt::bench
