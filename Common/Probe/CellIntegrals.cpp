#include "Common/Probe/CellIntegrals.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace rt::probe {
namespace {

constexpr std::uint32_t kFinestSide = 1u << 20; // leaves along the map: directions are of single precision
constexpr std::size_t kMostDivisions = 16384;   // some ten milliseconds of a light's density
constexpr double kSmallUncertainty = 0.05;      // of the statistic, whose deviation is 1.4 or more
constexpr double kFewest = 5;                   // samples that are expected in a pool of cells
constexpr std::size_t kRootsAtOnce = 4, kDivisionsAtOnce = 16, kMeasuredAtOnce = 64;
// Places of a leaf, squared: of any, of uncertain ones, of those that may get more.
constexpr std::uint32_t kSide = 2, kGoodSide = 4, kMostSide = 32;
constexpr double kMostError = 0.01;       // of a leaf's integral, before it gets more places
constexpr double kInset = 1e-3;           // of corners, in the leaf: an edge of the density may be one of the map's
constexpr std::uint32_t kMostGuides = 64; // looked at in a leaf

// As of quadrants 0 to 3.
glm::dvec2 quadrant(std::uint32_t i) {
    return {i % 2 == 0 ? 0 : 0.5, i < 2 ? 0 : 0.5};
}

} // namespace

CellIntegrals::CellIntegrals(Density density, const Settings& settings, std::vector<std::size_t> cells,
                             std::vector<Guide> guides, double drawn)
    : density_(std::move(density)),
      settings_(settings),
      cells_(std::move(cells)),
      guides_(std::move(guides)),
      numbers_(settings.seed),
      means_(cells_.size()) {
    // A place in the map becomes one of its cell.
    std::vector<std::pair<std::size_t, Guide>> placed;
    for (const Guide& guide : guides_) {
        const glm::dvec2 scaled = guide.place * glm::dvec2(settings.width, settings.height);
        const glm::dvec2 cell =
            glm::clamp(glm::floor(scaled), glm::dvec2(0), glm::dvec2(settings.width - 1.0, settings.height - 1.0));
        const std::size_t index = static_cast<std::size_t>(cell.y) * settings.width + static_cast<std::size_t>(cell.x);
        if (std::ranges::binary_search(cells_, index)) placed.push_back({index, {scaled - cell, guide.density}});
    }
    std::ranges::stable_sort(placed, {}, &std::pair<std::size_t, Guide>::first);
    guides_.clear();
    counts_.assign(cells_.size(), 0);
    std::size_t cell = 0;
    for (const auto& [index, guide] : placed) {
        while (cells_[cell] != index) ++cell;
        ++counts_[cell];
        guides_.push_back(guide);
    }
    for (const std::uint32_t count : counts_)
        importance_.push_back(settings.samples / std::max(count / drawn, kFewest / settings.samples));
}

glm::dvec2 CellIntegrals::placeIn(const Leaf& leaf, const glm::dvec2& inLeaf) const {
    const std::size_t cell = cells_[leaf.cell];
    const glm::dvec2 inCell = leaf.corner + inLeaf * std::ldexp(1.0, -static_cast<int>(leaf.level));
    const std::size_t column = cell % settings_.width, row = cell / settings_.width;
    const glm::dvec2 corner(static_cast<double>(column), static_cast<double>(row));
    return (corner + inCell) / glm::dvec2(settings_.width, settings_.height);
}

// At a fresh place in each of side * side parts.
CellIntegrals::Moments CellIntegrals::valuesIn(const Leaf& leaf, std::uint32_t side) {
    const auto random = [this] { return (numbers_() + 0.5) / 4294967296.0; };
    Moments moments;
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const double x = random(), y = random();
        const std::uint32_t column = i % side, row = i / side;
        const glm::dvec2 part(column, row);
        moments.add(density_(placeIn(leaf, (part + glm::dvec2(x, y)) / static_cast<double>(side))));
    }
    return moments;
}

double CellIntegrals::solidAngleOf(const Leaf& leaf) const {
    return std::ldexp(settings_.solidAngle, -2 * static_cast<int>(leaf.level));
}

// What an error of its mean value, squared, adds to the statistic of a test.
double CellIntegrals::uncertaintyOf(const Leaf& leaf, double squaredError) const {
    return importance_[leaf.cell] * squaredError * solidAngleOf(leaf) * solidAngleOf(leaf);
}

// ---- where to look -------------------------------------------------------------------------------------------------

// Guides below `at` come first; gives where the others begin.
std::uint32_t CellIntegrals::divideGuides(std::uint32_t first, std::uint32_t end, int axis, double at) {
    const auto isBelow = [axis, at](const Guide& guide) { return guide.place[axis] < at; };
    const auto middle = std::partition(guides_.begin() + first, guides_.begin() + end, isBelow);
    return static_cast<std::uint32_t>(middle - guides_.begin());
}

std::array<CellIntegrals::Leaf, 4> CellIntegrals::quartersOf(const Leaf& leaf) {
    const double half = std::ldexp(0.5, -static_cast<int>(leaf.level));
    const glm::dvec2 middle = leaf.corner + half;
    const std::uint32_t upper = divideGuides(leaf.guides, leaf.guideEnd, 1, middle.y);
    const std::uint32_t ends[] = {leaf.guides, divideGuides(leaf.guides, upper, 0, middle.x), upper,
                                  divideGuides(upper, leaf.guideEnd, 0, middle.x), leaf.guideEnd};
    std::array<Leaf, 4> quarters;
    for (std::uint32_t i = 0; i < 4; ++i)
        quarters[i] = {leaf.corner + 2 * half * quadrant(i), leaf.level + 1, leaf.cell, ends[i], ends[i + 1], 0};
    return quarters;
}

// As leaf `index`.
void CellIntegrals::put(const Leaf& leaf, std::size_t index) {
    if (index == leaves_.size()) leaves_.emplace_back();
    leaves_[index] = leaf;
    // No straight edge passes between corners.
    Moments moments = valuesIn(leaf, kSide);
    for (std::uint32_t i = 0; i < 4; ++i) moments.add(density_(placeIn(leaf, kInset + (2 - 4 * kInset) * quadrant(i))));
    for (std::uint32_t i = leaf.guides; i < std::min(leaf.guideEnd, leaf.guides + kMostGuides); ++i)
        moments.add(guides_[i].density);
    leaves_[index].variance = moments.variance();
    const double added = uncertaintyOf(leaf, moments.variance() / (kSide * kSide));
    if (!(added > 0) || std::max(settings_.width, settings_.height) << leaf.level >= kFinestSide) return;
    uncertainty_ += added;
    uncertain_.emplace(added, index);
}

void CellIntegrals::makeRoot() {
    Leaf all;
    all.cell = static_cast<std::uint32_t>(rooted_++);
    all.guides = nextGuide_;
    all.guideEnd = nextGuide_ += counts_[all.cell];
    for (const Leaf& quarter : quartersOf(all))
        for (const Leaf& leaf : quartersOf(quarter)) put(leaf, leaves_.size());
}

void CellIntegrals::divide() {
    const auto [added, index] = uncertain_.top();
    uncertain_.pop();
    uncertainty_ -= added;
    ++divided_;
    const std::array<Leaf, 4> quarters = quartersOf(leaves_[index]);
    put(quarters[0], index);
    for (std::size_t i = 1; i < quarters.size(); ++i) put(quarters[i], leaves_.size());
}

// ---- how much is there ---------------------------------------------------------------------------------------------

// The places that led to the division would tell too little where a leaf was left alone because they missed something.
void CellIntegrals::measure() {
    const Leaf& leaf = leaves_[measured_++];
    const double added = uncertaintyOf(leaf, leaf.variance / (kSide * kSide));
    std::uint32_t side = added * static_cast<double>(leaves_.size()) > uncertainty_ ? kGoodSide : kSide;
    Moments moments = valuesIn(leaf, side);
    // Where a density has no bound, one place in thousands may tell more than all of the others.
    while (side < kMostSide && std::sqrt(moments.variance() / moments.count) * solidAngleOf(leaf) > kMostError)
        moments.add(valuesIn(leaf, side *= 2));
    const double share = std::ldexp(1.0, -2 * static_cast<int>(leaf.level));
    const double error = share * std::sqrt(std::max(moments.variance(), leaf.variance) / moments.count);
    Mean& mean = means_[leaf.cell];
    mean.value += share * moments.mean();
    mean.error = std::hypot(mean.error, error);
}

void CellIntegrals::advance() {
    if (rooted_ < cells_.size()) {
        for (std::size_t i = 0; i < kRootsAtOnce && rooted_ < cells_.size(); ++i) makeRoot();
        return;
    }
    const auto isCertain = [this] {
        return uncertain_.empty() || uncertainty_ < kSmallUncertainty || divided_ == kMostDivisions;
    };
    if (measured_ == 0 && !isCertain()) {
        for (std::size_t i = 0; i < kDivisionsAtOnce && !isCertain(); ++i) divide();
        return;
    }
    for (std::size_t i = 0; i < kMeasuredAtOnce && measured_ < leaves_.size(); ++i) measure();
}

} // namespace rt::probe
