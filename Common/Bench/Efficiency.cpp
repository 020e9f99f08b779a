#include "Common/Bench/Efficiency.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace rt::bench {
namespace {

using Rows = std::vector<const Row*>;

constexpr PixelSet kPixelSets[] = {{"all", &Row::mse, &Row::mseCi, &Row::efficiency},
                                   {"up to 1", &Row::mseUpTo1, &Row::mseUpTo1Ci, &Row::efficiencyUpTo1}};

Figure stepOf(const Row& row) {
    return row.timeBudget ? row.timeBudget : row.spp;
}

// Those at the last step that all configurations have.
Rows lastCommon(const Rows& rows) {
    std::set<std::string> keys;
    std::map<double, Rows> bySteps;
    for (const Row* row : rows) {
        keys.insert(keyOf(row->config));
        if (const Figure step = stepOf(*row)) bySteps[*step].push_back(row);
    }
    const auto found = std::find_if(bySteps.rbegin(), bySteps.rend(),
                                    [&](const auto& step) { return step.second.size() == keys.size(); });
    return found == bySteps.rend() ? Rows() : found->second;
}

// Whether the axes that vary among the rows have their default values.
bool isDefault(const Config& config, const Rows& rows) {
    const Config defaults;
    return std::all_of(axes().begin(), axes().end(), [&](const Axis& axis) {
        const bool varies = std::any_of(rows.begin(), rows.end(), [&](const Row* row) {
            return axis.get(row->config) != axis.get(rows.front()->config);
        });
        return !varies || axis.get(config) == axis.get(defaults);
    });
}

Match matchOf(const Rows& all, const PixelSet& pixels) {
    Match match{lastCommon(all)};
    for (const Row* row : match.rows) {
        if (isDefault(row->config, match.rows)) match.defaults = row;
        if (!isKnown(*row, pixels)) continue;
        if (match.best == nullptr || row->*pixels.efficiency > match.best->*pixels.efficiency) match.best = row;
    }
    return match;
}

double relativeCi(const Row& row, const PixelSet& pixels) {
    return (row.*pixels.mseCi).value_or(0) / *(row.*pixels.mse);
}

Reach reachOf(const std::vector<Match>& matches, const PixelSet& pixels) {
    Reach reach;
    double sum = 0, squares = 0;
    for (const Match& match : matches) {
        const auto known =
            std::count_if(match.rows.begin(), match.rows.end(), [&](const Row* row) { return isKnown(*row, pixels); });
        if (known < 2 || match.defaults == nullptr || !isKnown(*match.defaults, pixels)) continue;
        const double share = *(match.defaults->*pixels.efficiency) / *(match.best->*pixels.efficiency);
        const double ci = match.best == match.defaults
                              ? 0
                              : std::hypot(relativeCi(*match.best, pixels), relativeCi(*match.defaults, pixels));
        ++reach.places;
        sum += std::log(share);
        squares += ci * ci;
        if (reach.minimum && *reach.minimum <= share) continue;
        reach.minimum = share;
        reach.minCi = share * ci;
        reach.minBest = match.best;
        reach.minDefaults = match.defaults;
    }
    if (reach.places == 0) return reach;
    reach.mean = std::exp(sum / reach.places);
    reach.meanCi = *reach.mean * std::sqrt(squares) / reach.places;
    return reach;
}

} // namespace

std::span<const PixelSet> pixelSets() {
    return kPixelSets;
}

bool isKnown(const Row& row, const PixelSet& pixels) {
    const Figure mse = row.*pixels.mse;
    return row.*pixels.efficiency && mse && (row.*pixels.mseCi).value_or(0) < *mse;
}

std::vector<Match> matchesOf(const Rows& rows, const PixelSet& pixels) {
    std::vector<std::string> places;
    std::map<std::string, Rows> byPlace;
    for (const Row* row : rows) {
        const std::string place = keyOf(row->config, Axis::Says::Where);
        Rows& own = byPlace[place];
        if (own.empty()) places.push_back(place);
        own.push_back(row);
    }
    std::vector<Match> matches;
    matches.reserve(places.size());
    for (const std::string& place : places) matches.push_back(matchOf(byPlace[place], pixels));
    return matches;
}

std::vector<DefaultsRow> compareDefaults(const std::vector<Row>& rows) {
    std::vector<DefaultsRow> result;
    std::set<std::pair<std::string, std::string>> seen;
    for (const Row& first : rows) {
        if (!seen.insert({first.experiment, first.config.engine}).second) continue;
        Rows own;
        for (const Row& row : rows)
            if (row.experiment == first.experiment && row.config.engine == first.config.engine) own.push_back(&row);
        for (const PixelSet& pixels : pixelSets()) {
            const std::vector<Match> matches = matchesOf(own, pixels);
            const auto places =
                std::count_if(matches.begin(), matches.end(), [](const Match& match) { return match.rows.size() > 1; });
            DefaultsRow row{first.experiment, first.config.engine, &pixels, static_cast<int>(places),
                            reachOf(matches, pixels)};
            if (row.reach.places > 0) result.push_back(std::move(row));
        }
    }
    return result;
}

} // namespace rt::bench
