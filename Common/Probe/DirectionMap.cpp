#include "Common/Probe/DirectionMap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace rt::probe {

using namespace rt::shared;

namespace {

constexpr float kUnequal = 0.2f;         // of the most that a cell's places have
constexpr std::uint32_t kSought = 16384; // samples, for what lies between places
constexpr std::uint32_t kSoughtNumbers = 0x2545f491;

} // namespace

double DirectionMap::integral() const {
    double sum = 0;
    for (const float value : values) sum += value;
    return values.empty() ? 0 : sum * cellSolidAngle();
}

double DirectionMap::integralError() const {
    double sum = 0;
    for (const float error : errors) sum += static_cast<double>(error) * error;
    return std::sqrt(sum) * cellSolidAngle();
}

double DirectionMap::cellSolidAngle() const {
    // A disk of the area pi, in a square of the area 4, is half of all directions.
    const double all = projection == Projection::Sphere ? 4 * std::numbers::pi : 8;
    return all / (static_cast<double>(width()) * height);
}

float DirectionMap::maximum() const {
    return values.empty() ? 0.0f : *std::max_element(values.begin(), values.end());
}

std::optional<glm::dvec2> DirectionMap::placeOf(const shared::vec3& direction) const {
    if (projection == Projection::Sphere)
        return glm::dvec2(
            (std::atan2(static_cast<double>(direction.z), static_cast<double>(direction.x)) + std::numbers::pi) /
                (2 * std::numbers::pi),
            (1 - static_cast<double>(direction.y)) / 2);
    const shared::vec3 local = toLocal(frame, direction);
    if (!(local.z > 0.0f)) return std::nullopt;
    const double share = 1 / std::sqrt(1.0 + local.z);
    return glm::dvec2((local.x * share + 1) / 2, (1 - local.y * share) / 2);
}

std::optional<shared::vec3> DirectionMap::directionOf(const glm::dvec2& place) const {
    if (projection == Projection::Sphere) {
        const double y = 1 - 2 * place.y, angle = 2 * std::numbers::pi * place.x;
        const double radius = std::sqrt(std::max(0.0, 1 - y * y));
        return shared::vec3(static_cast<float>(-radius * std::cos(angle)), static_cast<float>(y),
                            static_cast<float>(-radius * std::sin(angle)));
    }
    const double x = 2 * place.x - 1, y = 1 - 2 * place.y, squared = x * x + y * y; // 1 - cosine
    if (!(squared < 1)) return std::nullopt;
    const double share = std::sqrt(2 - squared);
    return toWorld(frame, shared::vec3(static_cast<float>(x * share), static_cast<float>(y * share),
                                       static_cast<float>(1 - squared)));
}

std::size_t DirectionMap::cellAt(const glm::dvec2& place) const {
    const auto cell = [](double share, std::uint32_t n) {
        return std::min(static_cast<std::uint32_t>(std::max(share, 0.0) * n), n - 1);
    };
    return std::size_t{cell(place.y, height)} * width() + cell(place.x, width());
}

MapBuilder::MapBuilder(const Probe& probe, const Strategy& strategy, const MapSettings& settings, std::uint32_t seed)
    : probe_(&probe),
      strategy_(strategy),
      settings_(settings),
      numbers_{app::SamplerKind::Sobol, 1, seed},
      map_{settings.projection, settings.height, makeFrame(probe.vertex().shading), {}, {}},
      sums_(std::size_t{map_.width()} * map_.height),
      passes_(isTraced(settings.quantity) ? settings.paths : settings.side * settings.side) {
    if (!isRefined()) return;
    least_.assign(sums_.size(), std::numeric_limits<float>::max());
    most_.assign(sums_.size(), 0.0f);
}

// At the i-th of side * side places of a cell.
double MapBuilder::placeValue(std::uint32_t column, std::uint32_t row, std::uint32_t i) const {
    const std::uint32_t side = settings_.side;
    const std::uint32_t across = i % side, down = i / side;
    const glm::dvec2 inCell((across + 0.5) / side, (down + 0.5) / side);
    return valueAt((glm::dvec2(column, row) + inCell) / glm::dvec2(map_.width(), map_.height), {});
}

double MapBuilder::pathValue(std::uint32_t column, std::uint32_t row) const {
    const Sampler sampler = samplerOf(numbers_, 1u + row * map_.width() + column, pass_);
    const glm::dvec2 inCell(sample2D(sampler, kDimensionPixel));
    return valueAt((glm::dvec2(column, row) + inCell) / glm::dvec2(map_.width(), map_.height), sampler);
}

double MapBuilder::valueAt(const glm::dvec2& place, const Sampler& sampler) const {
    const auto direction = map_.directionOf(place);
    return direction ? probe_->value(settings_.quantity, strategy_, *direction, sampler) : 0;
}

void MapBuilder::advance() {
    if (isDone()) return;
    if (pass_ == passes_) return unequal_.advance();
    for (std::uint32_t column = 0; column < map_.width(); ++column) {
        const std::size_t cell = std::size_t{row_} * map_.width() + column;
        const double value = isTraced(settings_.quantity) ? pathValue(column, row_) : placeValue(column, row_, pass_);
        sums_[cell] += value;
        if (least_.empty()) continue;
        least_[cell] = std::min(least_[cell], static_cast<float>(value));
        most_[cell] = std::max(most_[cell], static_cast<float>(value));
    }
    if (++row_ < map_.height) return;
    row_ = 0;
    if (++pass_ == passes_ && !least_.empty()) findUnequal();
}

void MapBuilder::findUnequal() {
    const auto width = static_cast<std::int64_t>(map_.width()), height = static_cast<std::int64_t>(map_.height);
    std::vector<char> isFound(sums_.size()), isUnequal(sums_.size());
    for (std::size_t cell = 0; cell < sums_.size(); ++cell)
        isFound[cell] = most_[cell] - least_[cell] > kUnequal * most_[cell] ? 1 : 0;
    const NumberSettings numbers{app::SamplerKind::Sobol, 1, numbers_.seed ^ kSoughtNumbers};
    std::vector<Guide> guides;
    for (std::uint32_t i = 0; i < kSought; ++i) {
        const auto direction = probe_->draw(strategy_, numbers, i).direction;
        const auto place = direction ? map_.placeOf(*direction) : std::nullopt;
        if (!place) continue;
        const std::size_t cell = map_.cellAt(*place);
        const double own = probe_->density(strategy_, *direction), mean = sums_[cell] / passes_;
        if (std::abs(own - mean) > kUnequal * std::max(own, mean)) isFound[cell] = 1;
        guides.push_back({*place, own});
    }
    // An edge may lie between places of two cells.
    const auto isEdge = [&](std::size_t a, std::size_t b) {
        return std::abs(sums_[a] - sums_[b]) > kUnequal * std::max(sums_[a], sums_[b]);
    };
    for (std::int64_t row = 0; row < height; ++row)
        for (std::int64_t column = 0; column < width; ++column) {
            const auto cell = static_cast<std::size_t>(row * width + column);
            const auto beside = static_cast<std::size_t>(row * width + (column + 1) % width);
            const auto below = static_cast<std::size_t>(std::min(row + 1, height - 1) * width + column);
            if (isFound[cell] == 0 && !isEdge(cell, beside) && !isEdge(cell, below)) continue;
            for (std::int64_t y = std::max<std::int64_t>(row - 1, 0); y <= std::min(row + 1, height - 1); ++y)
                for (std::int64_t x = column - 1; x <= column + 1; ++x)
                    isUnequal[static_cast<std::size_t>(y * width + (x + width) % width)] = 1;
        }
    std::vector<std::size_t> unequal;
    for (std::size_t cell = 0; cell < isUnequal.size(); ++cell)
        if (isUnequal[cell] != 0) unequal.push_back(cell);
    const auto density = [probe = probe_, strategy = strategy_, cells = map_](const glm::dvec2& place) {
        const auto direction = cells.directionOf(place);
        return direction ? static_cast<double>(probe->density(strategy, *direction)) : 0;
    };
    const CellIntegrals::Settings settings{map_.width(), map_.height, map_.cellSolidAngle(),
                                           static_cast<double>(settings_.samples), numbers_.seed};
    unequal_ = CellIntegrals(density, settings, std::move(unequal), std::move(guides), kSought);
}

DirectionMap MapBuilder::map() const {
    DirectionMap map = map_;
    map.values.resize(sums_.size());
    for (std::size_t i = 0; i < sums_.size(); ++i) {
        const std::uint32_t count = pass_ + (i / map.width() < row_ ? 1 : 0);
        map.values[i] = count > 0 ? static_cast<float>(sums_[i] / count) : 0.0f;
    }
    if (least_.empty() || !isDone()) return map;
    for (std::size_t i = 0; i < sums_.size(); ++i)
        map.errors.push_back((most_[i] - least_[i]) / static_cast<float>(passes_));
    for (std::size_t i = 0; i < unequal_.cells().size(); ++i) {
        map.values[unequal_.cells()[i]] = static_cast<float>(unequal_.means()[i].value);
        map.errors[unequal_.cells()[i]] = static_cast<float>(unequal_.means()[i].error);
    }
    return map;
}

DirectionMap mapOf(const Probe& probe, const Strategy& strategy, const MapSettings& settings, std::uint32_t seed) {
    MapBuilder builder(probe, strategy, settings, seed);
    while (!builder.isDone()) builder.advance();
    return builder.map();
}

} // namespace rt::probe
