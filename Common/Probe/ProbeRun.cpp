#include "Common/Probe/ProbeRun.h"

#include <algorithm>
#include <utility>

namespace rt::probe {
namespace {

constexpr std::uint32_t kCoarseRows = 16;
constexpr std::uint32_t kPortion = 256; // samples
constexpr std::uint32_t kTests = 64;    // as samples grow, about
constexpr std::size_t kLikelyLights = 16;
constexpr std::uint32_t kPointsOfEdge = 96;

MapSettings mapSettings(const ProbeSettings& settings, Projection projection) {
    return {settings.quantity, projection, settings.rows, settings.side, settings.paths, settings.samples};
}

// Whether it is the map by which samples are tested.
bool isDensity(const ProbeSettings& settings, Projection projection) {
    return settings.quantity == Quantity::Density && projection == Projection::Sphere;
}

// What the lines between the cells of the unit square become; broken where a line's directions are dropped or leap.
std::vector<std::vector<shared::vec3>> edgesOf(const Probe& probe, const ProbeSettings& settings) {
    constexpr float kLeap = 0.35f; // of neighbours on a line, as a chord
    constexpr float kBelowOne = 1 - 1.0f / 16777216;
    std::vector<std::vector<shared::vec3>> lines;
    const auto cells = static_cast<float>(settings.numbers.strata);
    for (std::uint32_t line = 0; line < 2 * (settings.numbers.strata + 1); ++line) {
        const std::uint32_t border = line / 2; // of a column and of a row
        const float across = std::min(static_cast<float>(border) / cells, kBelowOne);
        lines.emplace_back();
        for (std::uint32_t i = 0; i <= kPointsOfEdge; ++i) {
            const float along = std::min(static_cast<float>(i) / kPointsOfEdge, kBelowOne);
            const auto direction = probe.directionAt(
                settings.strategy, line % 2 == 0 ? shared::vec2(across, along) : shared::vec2(along, across));
            std::vector<shared::vec3>& last = lines.back();
            const bool isLeap = direction && !last.empty() && shared::length(*direction - last.back()) > kLeap;
            if ((!direction || isLeap) && !last.empty()) lines.emplace_back();
            if (direction) lines.back().push_back(*direction);
        }
    }
    std::erase_if(lines, [](const std::vector<shared::vec3>& points) { return points.size() < 2; });
    return lines;
}

} // namespace

ProbeRun::ProbeRun(const Probe& probe, const ProbeSettings& settings)
    : probe_(&probe),
      settings_(settings),
      density_(probe, settings.strategy,
               {Quantity::Density, Projection::Sphere, settings.rows, settings.side, 1, settings.samples},
               settings.numbers.seed),
      counts_(std::size_t{2} * settings.rows * settings.rows) {
    for (const Projection projection : settings.projections)
        if (!isDensity(settings, projection))
            builders_.emplace_back(probe, settings.strategy, mapSettings(settings, projection), settings.numbers.seed);
    prepareEstimates();
}

void ProbeRun::prepareEstimates() {
    const std::uint32_t seed = settings_.numbers.seed;
    for (const auto& row : kStrategies) {
        if (!probe_->whyNoDensity({row.value}).empty()) continue;
        estimates_.emplace_back(*probe_, Strategy{row.value}, seed);
        estimated_.push_back({std::string(row.name), row.title});
    }
    const Strategy lights{StrategyKind::Lights};
    if (!probe_->whyNoDensity(lights).empty()) return;
    for (const auto& row : kShapeStrategies) {
        app::Options options = probe_->scene().options();
        options.settings.sphereLight = options.settings.quadLight = options.settings.triangleLight = row.value;
        const auto formulas = probe_->scene().with(std::move(options));
        shapes_.push_back({formulas, std::make_unique<const Probe>(probe_->with(*formulas))});
        estimates_.emplace_back(*shapes_.back().probe, lights, seed);
        estimated_.push_back({std::string(row.name), row.title});
    }
}

std::size_t ProbeRun::shownCount() const {
    return std::min<std::size_t>(settings_.samples, ProbeResult::kShown);
}

bool ProbeRun::isDone() const {
    const auto isUnfinished = [this](const DirectEstimate& e) { return e.samples() < settings_.samples / 2 * 2; };
    return hasFirst() && density_.isDone() && samples_ == settings_.samples &&
           std::ranges::all_of(builders_, &MapBuilder::isDone) && std::ranges::none_of(estimates_, isUnfinished);
}

void ProbeRun::begin() {
    for (const Projection projection : settings_.projections) {
        MapSettings coarse = mapSettings(settings_, projection);
        coarse.height = std::min(coarse.height, kCoarseRows);
        coarse.side = coarse.paths = 1;
        coarse_.push_back(mapOf(*probe_, settings_.strategy, coarse, settings_.numbers.seed));
    }
    if (settings_.showsStrata) edges_ = edgesOf(*probe_, settings_);
    for (std::uint32_t i = 0; i < shownCount(); ++i)
        shown_.push_back(probe_->draw(settings_.strategy, settings_.numbers, i));
}

void ProbeRun::growSamples() {
    if (tested_.values.empty()) tested_ = density_.map();
    const std::uint32_t end = std::min(samples_ + kPortion, settings_.samples);
    for (; samples_ < end; ++samples_) {
        const auto direction = probe_->draw(settings_.strategy, settings_.numbers, samples_).direction;
        direction ? (void)++counts_[tested_.cellOf(*direction)] : (void)++dropped_;
    }
    const std::uint32_t step = std::max(settings_.samples / kTests / kPortion, 1u) * kPortion;
    if (samples_ % step == 0 || samples_ == settings_.samples)
        tests_.push_back({samples_, testDensity(counts_, dropped_, tested_)});
}

void ProbeRun::growEstimates() {
    for (DirectEstimate& estimate : estimates_)
        estimate.advance(std::min(kPortion, settings_.samples / 2 * 2 - estimate.samples()));
}

// First what is seen at once, then the map that the samples are tested by, then all else by turns.
void ProbeRun::advance() {
    if (isDone()) return;
    if (!hasFirst()) return begin();
    const bool isTurnOfDensity = !density_.isDone() && turn_++ % 2 == 0;
    if (isTurnOfDensity || (!density_.isDone() && builders_.empty())) return density_.advance();
    for (MapBuilder& builder : builders_) builder.advance();
    if (!density_.isDone()) return;
    if (samples_ < settings_.samples) growSamples();
    growEstimates();
}

ProbeResult ProbeRun::result() const {
    ProbeResult result;
    result.settings = settings_;
    result.position = probe_->position();
    result.normal = probe_->vertex().shading;
    const scene::CompiledScene& scene = *probe_->scene().compiled();
    result.material = scene.materialNames[probe_->material()];
    result.lights = scene.globals.lightCount;
    result.selection = probe_->likelyLights(kLikelyLights);
    result.density = density_.map();
    result.maps = maps();
    result.shown = shown_;
    result.edges = edges_;
    result.samples = samples_;
    result.dropped = dropped_;
    result.tests = tests_;
    result.estimates = estimated_;
    for (std::size_t i = 0; i < estimates_.size(); ++i) {
        const DirectEstimate& estimate = estimates_[i];
        result.estimates[i].mean = estimate.mean();
        result.estimates[i].variance = estimate.variance();
        result.estimates[i].samples = estimate.samples();
    }
    result.isDone = isDone();
    return result;
}

std::vector<DirectionMap> ProbeRun::maps() const {
    std::vector<DirectionMap> maps;
    for (std::size_t i = 0, other = 0; i < settings_.projections.size(); ++i) {
        const bool isTested = isDensity(settings_, settings_.projections[i]);
        const MapBuilder& builder = isTested ? density_ : builders_[other++];
        if (builder.hasPass())
            maps.push_back(builder.map());
        else if (i < coarse_.size())
            maps.push_back(coarse_[i]);
    }
    return maps;
}

} // namespace rt::probe
