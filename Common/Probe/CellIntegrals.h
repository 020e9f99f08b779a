// Integrals of a density over cells of directions, each with its standard error: lights may be thin, or have densities
// without a bound at their edges.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

namespace rt::probe {

// Where the density is worth a look: a sample of it, in shares of the map, and what it is there.
struct Guide {
    glm::dvec2 place{};
    double density = 0;
};

// Cells of a map of equal areas become leaves of a tree, each of which is divided in four: always the one whose
// integral is least certain, by how its values differ, for what it adds to a test by chi-square. Once that is small, or
// the work is done that there is a bound for, fresh places in all leaves give the integrals: stratified sampling, whose
// error is known. Guides say where to divide, and are no part of the integrals.
class CellIntegrals {
  public:
    using Density = std::function<double(const glm::dvec2& place)>;
    struct Settings {
        std::uint32_t width = 0, height = 0; // of the map, in cells
        double solidAngle = 0;               // of a cell
        double samples = 4096;               // that will be tested
        std::uint32_t seed = 0;
    };
    // Of the means over a cell.
    struct Mean {
        double value = 0, error = 0;
    };

    CellIntegrals() = default;
    // `cells`: ascending. `guides`: of `drawn` samples those that have a direction.
    CellIntegrals(Density density, const Settings& settings, std::vector<std::size_t> cells, std::vector<Guide> guides,
                  double drawn);

    bool isDone() const { return rooted_ == cells_.size() && measured_ == leaves_.size(); }
    void advance(); // by some hundred values of the density
    std::span<const std::size_t> cells() const { return cells_; }
    std::span<const Mean> means() const { return means_; } // of cells(), once all is done

  private:
    struct Leaf {
        glm::dvec2 corner{};                    // in its cell
        std::uint32_t level = 0;                // of a side of 1 / 2^level
        std::uint32_t cell = 0;                 // of cells_
        std::uint32_t guides = 0, guideEnd = 0; // in guides_
        double variance = 0;                    // of values in it
    };
    struct Moments {
        double sum = 0, squares = 0, count = 0;
        void add(double value) {
            sum += value;
            squares += value * value;
            ++count;
        }
        void add(const Moments& more) {
            sum += more.sum;
            squares += more.squares;
            count += more.count;
        }
        double mean() const { return sum / count; }
        double variance() const { return std::max(squares - sum * sum / count, 0.0) / (count - 1); }
    };

    glm::dvec2 placeIn(const Leaf& leaf, const glm::dvec2& inLeaf) const;
    std::uint32_t divideGuides(std::uint32_t first, std::uint32_t end, int axis, double at);
    std::array<Leaf, 4> quartersOf(const Leaf& leaf);
    Moments valuesIn(const Leaf& leaf, std::uint32_t side);
    double solidAngleOf(const Leaf& leaf) const;
    double uncertaintyOf(const Leaf& leaf, double squaredError) const;
    void put(const Leaf& leaf, std::size_t index);
    void makeRoot();
    void divide();
    void measure();

    Density density_;
    Settings settings_;
    std::vector<std::size_t> cells_;
    std::vector<Guide> guides_;         // by cells
    std::vector<std::uint32_t> counts_; // of guides in a cell
    std::vector<double> importance_;    // of a cell's squared error in the test
    std::vector<Leaf> leaves_;
    std::priority_queue<std::pair<double, std::size_t>> uncertain_; // leaves by what they add
    double uncertainty_ = 0;                                        // of all of those
    std::size_t rooted_ = 0, divided_ = 0, measured_ = 0;
    std::uint32_t nextGuide_ = 0; // of a cell without a root
    std::mt19937 numbers_;
    std::vector<Mean> means_;
};

} // namespace rt::probe
