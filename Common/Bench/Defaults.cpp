#include "Common/Bench/Defaults.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace rt::bench {
namespace {

bool isPlace(const Axis& axis) {
    return axis.name == "scene" || axis.name == "engine" || axis.name == "width" || axis.name == "height" ||
           axis.name == "threads";
}

// Whether the axes that vary among the rows have their default values.
bool isDefault(const Config& config, const std::vector<const Row*>& rows) {
    const Config defaults;
    return std::all_of(axes().begin(), axes().end(), [&](const Axis& axis) {
        const bool varies = std::any_of(rows.begin(), rows.end(), [&](const Row* row) {
            return axis.get(row->config) != axis.get(rows.front()->config);
        });
        return isPlace(axis) || !varies || axis.get(config) == axis.get(defaults);
    });
}

// Those with the most samples that all configurations have.
std::vector<const Row*> lastCommon(const std::vector<const Row*>& rows) {
    std::set<std::string> keys;
    for (const Row* row : rows) keys.insert(keyOf(row->config));
    double most = -1;
    for (const Row* candidate : rows) {
        const auto same = [&](const Row* row) { return row->spp == candidate->spp; };
        if (candidate->spp && static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), same)) == keys.size())
            most = std::max(most, *candidate->spp);
    }
    std::vector<const Row*> result;
    for (const Row* row : rows)
        if (row->spp && *row->spp == most) result.push_back(row);
    return result;
}

struct Share {
    double share, relativeCi;
    const Row* best;
};

std::optional<Share> shareOf(const std::vector<const Row*>& all) {
    const std::vector<const Row*> rows = lastCommon(all);
    const bool known = std::all_of(rows.begin(), rows.end(), [](const Row* row) {
        return row->efficiency && row->mse && *row->mse > 0 && (!row->mseCi || *row->mseCi < *row->mse);
    });
    if (rows.size() < 2 || !known) return std::nullopt;
    const auto own =
        std::find_if(rows.begin(), rows.end(), [&](const Row* row) { return isDefault(row->config, rows); });
    if (own == rows.end()) return std::nullopt;
    const Row* best = *std::max_element(rows.begin(), rows.end(),
                                        [](const Row* a, const Row* b) { return *a->efficiency < *b->efficiency; });
    const auto relative = [](const Row* row) { return row->mseCi.value_or(0) / *row->mse; };
    const double ci = best == *own ? 0 : std::hypot(relative(best), relative(*own));
    return Share{*(*own)->efficiency / *best->efficiency, ci, best};
}

} // namespace

std::vector<DefaultsRow> compareDefaults(const std::vector<Row>& rows) {
    std::vector<DefaultsRow> result;
    std::set<std::pair<std::string, std::string>> seen;
    for (const Row& first : rows) {
        if (!seen.insert({first.experiment, first.config.engine}).second) continue;
        std::vector<std::pair<std::string, std::vector<const Row*>>> scenes;
        for (const Row& row : rows) {
            if (row.experiment != first.experiment || row.config.engine != first.config.engine) continue;
            auto scene = std::find_if(scenes.begin(), scenes.end(),
                                      [&](const auto& known) { return known.first == row.config.scene; });
            if (scene == scenes.end()) scene = scenes.insert(scene, {row.config.scene, {}});
            scene->second.push_back(&row);
        }
        DefaultsRow out;
        out.experiment = first.experiment;
        out.engine = first.config.engine;
        double sum = 0, squares = 0;
        for (const auto& [scene, own] : scenes) {
            const std::optional<Share> share = shareOf(own);
            if (!share) continue;
            ++out.scenes;
            sum += std::log(share->share);
            squares += share->relativeCi * share->relativeCi;
            if (out.least && *out.least <= share->share) continue;
            out.least = share->share;
            out.leastCi = share->share * share->relativeCi;
            out.leastScene = scene;
            out.leastBest = share->best->config;
        }
        if (out.scenes == 0) continue;
        out.mean = std::exp(sum / out.scenes);
        out.meanCi = *out.mean * std::sqrt(squares) / out.scenes;
        result.push_back(std::move(out));
    }
    return result;
}

} // namespace rt::bench
