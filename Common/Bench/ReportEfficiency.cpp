#include <algorithm>
#include <iterator>
#include <set>
#include <string>

#include "Common/Bench/Cells.h"
#include "Common/Bench/Efficiency.h"
#include "Common/Bench/ReportParts.h"

namespace rt::bench {
namespace {

// What the best one has otherwise.
std::string differences(const Config& best, const Config& defaults) {
    std::string text;
    for (const Axis& axis : axes())
        if (axis.get(best) != axis.get(defaults)) text += (text.empty() ? "" : ", ") + axis.get(best);
    return text.empty() ? "the default" : text;
}

std::string shareOfBest(const Row& row, const PixelSet& pixels, double best) {
    if (!isKnown(row, pixels)) return "error ~ 0";
    const double share = *(row.*pixels.efficiency) / best;
    const Figure ci = row.*pixels.mseCi;
    return withInterval(share, ci ? Figure(share * *ci / *(row.*pixels.mse)) : std::nullopt);
}

} // namespace

Document efficiencyBlocks(const std::vector<const Row*>& rows) {
    std::vector<const Config*> settings; // in the order of their first rows
    std::set<std::string> keys;
    for (const Row* row : rows)
        if (keys.insert(keyOf(row->config, Axis::Says::How)).second) settings.push_back(&row->config);
    std::vector<Column<Row>> places;
    for (Column<Row>& column : axisColumns(rows))
        if (findAxis(column.header)->says == Axis::Says::Where) places.push_back(std::move(column));
    places.push_back(
        {"at", [](const Row& r) { return r.timeBudget ? threeDigits(r.timeBudget) + " s" : whole(r.spp) + " spp"; }});

    Table table;
    for (const Column<Row>& place : places) table.header.push_back(place.header);
    table.header.insert(table.header.end(), {"pixels", "least mse × s"});
    for (const Config* setting : settings)
        table.header.push_back(
            nameOf(*setting, settings, [](const Axis& axis) { return axis.says == Axis::Says::How; }));
    const auto append = [&](const Match& match, const PixelSet& pixels) {
        if (match.best == nullptr || match.rows.size() < 2) return;
        const double best = *(match.best->*pixels.efficiency);
        std::vector<std::string> cells;
        cells.reserve(places.size() + 2 + settings.size());
        for (const Column<Row>& place : places) cells.push_back(place.cell(*match.best));
        cells.insert(cells.end(), {pixels.name, threeDigits(1 / best)});
        for (const Config* setting : settings) {
            const auto found = std::find_if(match.rows.begin(), match.rows.end(), [&](const Row* row) {
                return keyOf(row->config, Axis::Says::How) == keyOf(*setting, Axis::Says::How);
            });
            cells.push_back(found == match.rows.end() ? kUnknown : shareOfBest(**found, pixels, best));
        }
        table.rows.push_back(std::move(cells));
    };
    std::vector<std::vector<Match>> bySet;
    for (const PixelSet& pixels : pixelSets()) bySet.push_back(matchesOf(rows, pixels));
    for (std::size_t place = 0; place < bySet.front().size(); ++place)
        for (std::size_t set = 0; set < bySet.size(); ++set) append(bySet[set][place], pixelSets()[set]);
    if (table.rows.empty()) return {};
    return {Paragraph{"Efficiency, 1 / (mse s), over that of the row's best setting:"}, table};
}

Document defaultsBlocks(const std::vector<Row>& rows) {
    Table table{{"experiment", "engine", "pixels", "scenes", "geometric mean", "least", "in", "where the best is"}, {}};
    for (const DefaultsRow& row : compareDefaults(rows)) {
        const Reach& reach = row.reach;
        table.rows.push_back({row.experiment, row.engine, row.pixels->name,
                              std::to_string(reach.places) + " of " + std::to_string(row.places),
                              withInterval(reach.mean, reach.meanCi), withInterval(reach.minimum, reach.minCi),
                              reach.minBest->config.scene,
                              differences(reach.minBest->config, reach.minDefaults->config)});
    }
    if (table.rows.empty()) return {};
    return {
        Heading{2, "What the defaults reach of the best efficiency, 1 / (mse s)"},
        Paragraph{
            "Left out are settings whose error cannot be told from zero, and scenes where that holds for the default "
            "or for all others. \"up to 1\" counts the pixels alone that the reference has at 1 or less in every "
            "channel: without visible lights. ± is by the errors' intervals, not by the spread of seconds."},
        table};
}

} // namespace rt::bench
