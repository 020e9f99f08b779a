#include "Common/Bench/Comparison.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "Common/Bench/Cells.h"
#include "Common/Bench/ResultsJson.h"
#include "Common/Core/ReadFile.h"
#include "Common/Image/Summary.h"

namespace rt::bench {
namespace {

constexpr std::uint64_t kLargestResults = std::uint64_t{1} << 30;
constexpr double kMinTimeNoise = 0.05;
constexpr double kMinErrorNoise = 0.02;
constexpr double kCloseRatio = 1.1;

std::string keyOf(const Row& row) {
    const Figure step = row.timeBudget ? row.timeBudget : row.spp;
    return row.experiment + "|" + keyOf(row.config) + (row.timeBudget ? "s" : "spp") + std::to_string(step.value_or(0));
}

double spread(const Row& row) {
    if (!row.seconds || !row.secondsMin || !row.secondsMax || !(*row.seconds > 0)) return 0;
    return 0.5 * (*row.secondsMax - *row.secondsMin) / *row.seconds;
}

double errorNoise(const Row& row) {
    return row.mse && row.mseCi && *row.mse > 0 ? *row.mseCi / *row.mse : 0;
}

Figure quotient(const Figure& after, const Figure& before) {
    return after && before && *before > 0 && *after > 0 ? Figure(*after / *before) : std::nullopt;
}

Change compareRows(const Row& before, const Row& after) {
    Change change{&before,
                  &after,
                  quotient(after.seconds, before.seconds),
                  quotient(after.mse, before.mse),
                  quotient(after.efficiency, before.efficiency),
                  quotient(after.gain, before.gain)};
    const double timeNoise = std::max(kMinTimeNoise, 2 * std::hypot(spread(before), spread(after)));
    const double noise = std::max(kMinErrorNoise, std::hypot(errorNoise(before), errorNoise(after)));
    // With a time budget it is the samples that tell.
    const Figure slowness =
        before.timeBudget ? quotient(before.samplesPerSecond, after.samplesPerSecond) : change.seconds;
    if (slowness) {
        change.slower = *slowness > 1 + timeNoise;
        change.faster = *slowness < 1 / (1 + timeNoise);
    }
    if (change.mse) {
        change.noisier = *change.mse > 1 + noise;
        change.lessNoisy = *change.mse < 1 / (1 + noise);
    }
    return change;
}

// How far the rows of one run are from those of the other, all together.
std::string repeatability(const std::string& what, const Comparison& comparison, FigureOf<Change> figure) {
    std::vector<double> ratios;
    for (const Change& change : comparison.changes)
        if (change.*figure) ratios.push_back(*(change.*figure));
    if (ratios.empty()) return "";
    const auto close = std::count_if(ratios.begin(), ratios.end(),
                                     [](double ratio) { return std::max(ratio, 1 / ratio) <= kCloseRatio; });
    const image::Summary summary = image::summarise(ratios);
    return what + " B/A: median " + threeDigits(summary.median) + ", from " + threeDigits(summary.min) + " to " +
           threeDigits(summary.max) + ", " + std::to_string(close) + " of " + std::to_string(ratios.size()) +
           " rows within 10 %. ";
}

} // namespace

std::size_t Comparison::regressions() const {
    return static_cast<std::size_t>(
        std::count_if(changes.begin(), changes.end(), [](const Change& change) { return change.regressed(); }));
}

Comparison compareResults(const Results& before, const Results& after) {
    std::map<std::string, const Row*> rows;
    for (const Row& row : before.rows) rows[keyOf(row)] = &row;
    Comparison comparison;
    for (const Row& row : after.rows) {
        const auto found = rows.find(keyOf(row));
        if (found == rows.end()) {
            ++comparison.onlyAfter;
            continue;
        }
        comparison.changes.push_back(compareRows(*found->second, row));
        rows.erase(found);
    }
    comparison.onlyBefore = rows.size();
    return comparison;
}

Results loadResults(const std::filesystem::path& path) {
    std::error_code none;
    const std::filesystem::path file = std::filesystem::is_directory(path, none) ? path / "results.json" : path;
    const std::vector<std::byte> bytes = readFile(file, kLargestResults);
    return parseResults(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), file.string());
}

Document describe(const Comparison& comparison, const Results& before, const Results& after) {
    Document document{Heading{1, "Two runs of " + after.title}};
    Table machines{{"", "A", "B"}, {}};
    for (const Fact& fact : after.facts) {
        const auto found = std::find_if(before.facts.begin(), before.facts.end(),
                                        [&](const Fact& other) { return other.name == fact.name; });
        machines.rows.push_back({fact.name, found == before.facts.end() ? "–" : found->value, fact.value});
    }
    document.push_back(machines);
    Table table{
        {"experiment", "configuration", "spp", "s, A", "s, B", "time B/A", "mse B/A", "efficiency B/A", "gain B/A", ""},
        {}};
    for (const Change& change : comparison.changes) {
        std::string configuration = change.after->config.scene;
        for (const Axis& axis : axes())
            if (axis.name != "scene" && axis.get(change.after->config) != axis.get(Config()))
                configuration += ", " + axis.get(change.after->config);
        const std::string verdict = std::string(change.slower   ? "SLOWER "
                                                : change.faster ? "faster "
                                                                : "") +
                                    (change.noisier     ? "NOISIER"
                                     : change.lessNoisy ? "less noisy"
                                                        : "");
        table.rows.push_back({change.after->experiment, configuration, threeDigits(change.after->spp),
                              threeDigits(change.before->seconds), threeDigits(change.after->seconds),
                              threeDigits(change.seconds), threeDigits(change.mse), threeDigits(change.efficiency),
                              threeDigits(change.gain), verdict});
    }
    document.push_back(table);
    const std::string together = repeatability("Efficiency", comparison, &Change::efficiency) +
                                 repeatability("Gain over the baseline of the same run,", comparison, &Change::gain);
    if (!together.empty()) document.push_back(Paragraph{together});
    document.push_back(Paragraph{std::to_string(comparison.regressions()) + " of " +
                                 std::to_string(comparison.changes.size()) + " rows are worse beyond noise; " +
                                 std::to_string(comparison.onlyBefore) + " are in A only, " +
                                 std::to_string(comparison.onlyAfter) + " in B only."});
    return document;
}

} // namespace rt::bench
