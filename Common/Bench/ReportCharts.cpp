#include <algorithm>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "Common/Bench/Cells.h"
#include "Common/Bench/ReportParts.h"

namespace rt::bench {
namespace {

using Rows = std::vector<const Row*>;

constexpr std::size_t kMaxLines = 10; // of a chart

// Axes, but `except`, with more than one value among the rows.
std::vector<const Axis*> varied(const Rows& rows, const std::set<std::string_view>& except) {
    std::vector<const Axis*> found;
    for (const Axis& axis : axes()) {
        std::set<std::string> values;
        for (const Row* row : rows) values.insert(axis.get(row->config));
        if (values.size() > 1 && !except.count(axis.name)) found.push_back(&axis);
    }
    return found;
}

std::string nameOf(const Row& row, const std::vector<const Axis*>& axes) {
    if (row.config.imported) return row.config.engine;
    std::string name;
    for (const Axis* axis : axes) name += (name.empty() ? "" : ", ") + axis->get(row.config);
    return name.empty() ? row.config.engine : name;
}

std::string captionOf(const Row& row, const std::vector<const Axis*>& axes) {
    std::string text = nameOf(row, axes);
    if (row.spp) text += ", " + whole(row.spp) + " spp";
    if (row.seconds) text += ", " + threeDigits(row.seconds) + " s";
    if (row.relmse) text += ", relMSE " + threeDigits(row.relmse);
    return text;
}

ChartLine& lineNamed(Chart& chart, const std::string& name) {
    const auto found =
        std::find_if(chart.lines.begin(), chart.lines.end(), [&](const ChartLine& l) { return l.name == name; });
    return found == chart.lines.end() ? chart.lines.emplace_back(ChartLine{name, {}}) : *found;
}

Chart errorChart(const Rows& rows, const std::string& title, FigureOf<Row> x, const std::string& xTitle) {
    Chart chart{title + ": relMSE against " + xTitle, xTitle, "relmse", {}, true};
    const std::vector<const Axis*> axes = varied(rows, {"scene", "height"});
    for (const Row* row : rows)
        if (row->*x && row->relmse)
            lineNamed(chart, nameOf(*row, axes))
                .points.push_back({*(row->*x), *row->relmse, row->relmseCi.value_or(0), row, captionOf(*row, axes)});
    return chart;
}

// One picture's rows by title: all, or those of each engine where they are too many lines to tell apart.
std::vector<std::pair<std::string, Rows>> readable(const Rows& rows, const std::string& scene) {
    std::set<std::string> lines;
    for (const Row* row : rows) lines.insert(keyOf(row->config));
    if (lines.size() <= kMaxLines) return {{scene, rows}};
    std::vector<std::pair<std::string, Rows>> parts;
    for (const std::string_view engine : kEngines) {
        Rows own;
        std::copy_if(rows.begin(), rows.end(), std::back_inserter(own),
                     [&](const Row* row) { return row->config.engine == engine || row->config.imported; });
        if (std::any_of(own.begin(), own.end(), [](const Row* row) { return !row->config.imported; }))
            parts.emplace_back(scene + ", " + std::string(engine), std::move(own));
    }
    return parts;
}

double countOf(const std::string& scene) { // N of "id:N"; 0: none
    const std::size_t colon = scene.find(':');
    return colon == std::string::npos ? 0 : std::strtod(scene.c_str() + colon + 1, nullptr);
}

struct NumberAxis {
    std::string title;
    std::set<std::string_view> axes; // that it stands for
    std::function<double(const Row&)> value;
};

const std::vector<NumberAxis>& numberAxes() {
    static const std::vector<NumberAxis> all = {
        {"count of the scene", {"scene"}, [](const Row& r) { return countOf(r.config.scene); }},
        {"pixels",
         {"width", "height"},
         [](const Row& r) { return double(r.config.settings.width) * r.config.settings.height; }},
        {"ranks", {"ranks"}, [](const Row& r) { return r.config.ranks; }},
        {"threads", {"threads"}, [](const Row& r) { return r.threadsUsed.value_or(0); }},
    };
    return all;
}

std::vector<Chart> scalingCharts(const Rows& rows) {
    for (const NumberAxis& axis : numberAxes()) {
        std::set<double> values;
        for (const Row* row : rows) values.insert(axis.value(*row));
        if (values.size() < 2 || *values.begin() <= 0) continue;
        Chart chart{"Samples per second", axis.title, "samples/s", {}, false};
        std::set<std::string_view> except = axis.axes;
        const std::vector<const Axis*> names = varied(rows, except);
        for (const Row* row : rows) {
            const std::string family =
                axis.axes.count("scene") ? row->config.scene.substr(0, row->config.scene.find(':')) + ", " : "";
            if (row->samplesPerSecond)
                lineNamed(chart, family + nameOf(*row, names))
                    .points.push_back({axis.value(*row), *row->samplesPerSecond, 0, row, captionOf(*row, names)});
        }
        for (ChartLine& line : chart.lines)
            std::sort(line.points.begin(), line.points.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
        return {chart};
    }
    return {};
}

} // namespace

std::vector<Chart> makeCharts(const Rows& rows) {
    std::vector<std::string> scenes;
    for (const Row* row : rows)
        if (row->mse && std::find(scenes.begin(), scenes.end(), row->config.scene) == scenes.end())
            scenes.push_back(row->config.scene);
    if (scenes.empty()) return scalingCharts(rows);
    std::vector<Chart> charts;
    for (const std::string& scene : scenes) {
        Rows own;
        std::copy_if(rows.begin(), rows.end(), std::back_inserter(own),
                     [&](const Row* row) { return row->config.scene == scene && row->relmse; });
        for (const auto& [title, part] : readable(own, sceneName(scene))) {
            charts.push_back(errorChart(part, title, &Row::spp, "samples per pixel"));
            charts.push_back(errorChart(part, title, &Row::seconds, "seconds"));
        }
    }
    return charts;
}

} // namespace rt::bench
