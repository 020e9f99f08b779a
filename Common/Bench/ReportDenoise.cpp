#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "Common/Bench/Cells.h"
#include "Common/Bench/ReportParts.h"
#include "Common/Image/Convergence.h"
#include "Common/Image/Summary.h"

namespace rt::bench {
namespace {

using Rows = std::vector<const Row*>;

// What renders in one way, raw and by one of the filters.
struct Pair {
    std::string name;   // of scene and settings, as far as these differ among the pairs
    std::string filter; // a value of the axis
    Rows raw, filtered; // ascending in samples
};

Rows withKey(const std::vector<Row>& rows, const std::string& experiment, const std::string& key) {
    Rows found;
    for (const Row& row : rows)
        if (row.experiment == experiment && row.relmse && keyOf(row.config) == key) found.push_back(&row);
    return found;
}

std::vector<Pair> pairsOf(const std::vector<Row>& rows) {
    std::vector<Pair> pairs;
    std::vector<const Config*> configs;
    std::set<std::string> seen;
    for (const Row& row : rows) {
        if (row.config.denoise == Denoise::Off || !row.relmse) continue;
        if (!seen.insert(row.experiment + "|" + keyOf(row.config)).second) continue;
        Config raw = row.config;
        raw.denoise = Denoise::Off;
        Pair pair{"", findAxis("denoise")->get(row.config), withKey(rows, row.experiment, keyOf(raw)),
                  withKey(rows, row.experiment, keyOf(row.config))};
        if (pair.raw.empty()) continue;
        configs.push_back(&row.config);
        pairs.push_back(std::move(pair));
    }
    const auto counts = [](const Axis& axis) {
        return axis.name != "scene" && axis.name != "height" && axis.name != "denoise";
    };
    for (Pair& pair : pairs) {
        const Config& config = pair.filtered.front()->config;
        const std::string rest = nameOf(config, configs, counts);
        pair.name = config.scene + (rest.empty() ? "" : ", " + rest);
    }
    return pairs;
}

std::vector<image::CurvePoint> curveOf(const Rows& rows) {
    std::vector<image::CurvePoint> points;
    for (const Row* row : rows)
        if (row->seconds) points.push_back({*row->seconds, *row->relmse});
    return points;
}

ChartLine lineOf(const std::string& name, const Rows& rows) {
    ChartLine line{name, {}};
    for (const Row* row : rows)
        if (row->seconds) line.points.push_back({*row->seconds, *row->relmse, row->relmseCi.value_or(0)});
    return line;
}

// One for each way to render, with a line for each filter.
std::vector<Chart> chartsOf(const std::vector<Pair>& pairs) {
    std::vector<Chart> charts;
    for (const Pair& pair : pairs) {
        const std::string title = pair.name + ": relMSE against time, raw and denoised";
        if (charts.empty() || charts.back().title != title)
            charts.push_back({title, "seconds, filter included", "relmse", {lineOf("raw", pair.raw)}, true});
        charts.back().lines.push_back(lineOf(pair.filter == "on" ? "denoised" : pair.filter, pair.filtered));
    }
    return charts;
}

std::string secondsTo(const Rows& rows, double relmse) {
    const auto when = image::whenBelow(curveOf(rows), relmse);
    return when ? (when->extrapolated ? "~" : "") + threeDigits(when->value) : kUnknown;
}

std::string ratioTo(const Rows& rows, const Row& other) {
    const auto when = image::whenBelow(curveOf(rows), *other.relmse);
    return when && *other.seconds > 0 ? threeDigits(when->value / *other.seconds) : kUnknown;
}

Table timeTable(const std::vector<Pair>& pairs) {
    Table table{{"", "filter", "relMSE, raw", "seconds", "denoised in", "share", "relMSE, denoised", "seconds",
                 "raw in", "times"},
                {}};
    for (const Pair& pair : pairs) {
        const Row &raw = *pair.raw.back(), &filtered = *pair.filtered.back();
        if (!raw.seconds || !filtered.seconds) continue;
        table.rows.push_back({pair.name, pair.filter, threeDigits(raw.relmse), threeDigits(raw.seconds),
                              secondsTo(pair.filtered, *raw.relmse), ratioTo(pair.filtered, raw),
                              threeDigits(filtered.relmse), threeDigits(filtered.seconds),
                              secondsTo(pair.raw, *filtered.relmse), ratioTo(pair.raw, filtered)});
    }
    return table;
}

Figure positiveRatio(const Figure& a, const Figure& b) {
    return a && b && *b > 0 && *a > 0 ? Figure(*a / *b) : std::nullopt;
}

Table sampleTable(const std::vector<Pair>& pairs) {
    Table table{{"", "filter", "spp", "relMSE, raw", "denoised", "gain", "FLIP, raw", "denoised", "estimated/measured"},
                {}};
    for (const Pair& pair : pairs)
        for (const Row* filtered : pair.filtered)
            for (const Row* raw : pair.raw)
                if (raw->spp && raw->spp == filtered->spp)
                    table.rows.push_back({pair.name, pair.filter, whole(raw->spp), threeDigits(raw->relmse),
                                          threeDigits(filtered->relmse),
                                          threeDigits(positiveRatio(raw->relmse, filtered->relmse)),
                                          threeDigits(raw->flip), threeDigits(filtered->flip),
                                          threeDigits(positiveRatio(filtered->estimatedRelmse, filtered->relmse))});
    return table;
}

// Over all pairs at one number of samples.
struct Gains {
    std::vector<double> gains, estimates;
    std::size_t worseInFlip = 0;
};

Table summaryTable(const std::vector<Pair>& pairs) {
    std::vector<std::pair<std::string, double>> steps; // filter, samples
    for (const Pair& pair : pairs)
        for (const Row* row : pair.filtered) {
            const std::pair step{pair.filter, row->spp.value_or(0)};
            if (std::find(steps.begin(), steps.end(), step) == steps.end()) steps.push_back(step);
        }
    std::sort(steps.begin(), steps.end());
    Table table{{"filter", "spp", "rows", "gain, geometric mean", "least", "worse in FLIP",
                 "estimated/measured, median", "least", "most"},
                {}};
    for (const auto& [filter, spp] : steps) {
        Gains found;
        for (const Pair& pair : pairs)
            for (const Row* filtered : pair.filtered)
                for (const Row* raw : pair.raw) {
                    if (pair.filter != filter || filtered->spp != spp || raw->spp != spp) continue;
                    if (const Figure gain = positiveRatio(raw->relmse, filtered->relmse)) found.gains.push_back(*gain);
                    if (const Figure share = positiveRatio(filtered->estimatedRelmse, filtered->relmse))
                        found.estimates.push_back(*share);
                    found.worseInFlip += filtered->flip.value_or(0) > raw->flip.value_or(0);
                }
        if (found.gains.empty()) continue;
        double logs = 0;
        for (const double gain : found.gains) logs += std::log(gain);
        const image::Summary estimates = image::summarise(found.estimates);
        const auto estimate = [&](double value) { return estimates.count > 0 ? threeDigits(value) : kUnknown; };
        table.rows.push_back({filter, whole(spp), std::to_string(found.gains.size()),
                              threeDigits(std::exp(logs / static_cast<double>(found.gains.size()))),
                              threeDigits(*std::min_element(found.gains.begin(), found.gains.end())),
                              std::to_string(found.worseInFlip), estimate(estimates.median), estimate(estimates.min),
                              estimate(estimates.max)});
    }
    return table;
}

} // namespace

Document denoiseBlocks(const std::vector<Row>& rows) {
    const std::vector<Pair> pairs = pairsOf(rows);
    if (pairs.empty()) return {};
    Document document{Heading{2, "Raw and denoised"}};
    for (Chart& chart : chartsOf(pairs)) document.push_back(std::move(chart));
    document.push_back(
        Paragraph{"The time that each takes to the error that the other ends with; ~: extrapolated with slope −1."});
    document.push_back(timeTable(pairs));
    document.push_back(Paragraph{"At equal samples. Gain: the raw picture's relMSE over the denoised one's."});
    document.push_back(summaryTable(pairs));
    document.push_back(sampleTable(pairs));
    return document;
}

} // namespace rt::bench
