// Means of a quantity over cells of directions, each of one solid angle.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "Common/Probe/CellIntegrals.h"
#include "Common/Probe/Probe.h"
#include "Common/Shared/Base/Sampling.h"

namespace rt::probe {

struct DirectionMap {
    Projection projection = Projection::Sphere;
    std::uint32_t height = 0;
    shared::Frame frame{}; // of Hemisphere: the normal is seen in the middle
    std::vector<float> values;
    std::vector<float> errors; // standard errors of the values, of a density whose integrals are known; else empty

    std::uint32_t width() const { return projection == Projection::Sphere ? 2 * height : height; }
    // Over all directions, or those above the surface: of a density 1, less what the strategy drops.
    double integral() const;
    double integralError() const; // its standard error; 0 without errors
    double cellSolidAngle() const;
    float maximum() const;
    // Where a direction is, in shares of the map from its upper left; nothing below the surface where that is not seen.
    std::optional<glm::dvec2> placeOf(const shared::vec3& direction) const;
    // The reverse; nothing outside of the hemisphere's disk.
    std::optional<shared::vec3> directionOf(const glm::dvec2& place) const;
    std::size_t cellAt(const glm::dvec2& place) const;
    // Of Sphere, where each direction has one.
    std::size_t cellOf(const shared::vec3& direction) const { return cellAt(*placeOf(direction)); }
};

// What a map is of.
struct MapSettings {
    Quantity quantity = Quantity::Density;
    Projection projection = Projection::Sphere;
    std::uint32_t height = 128;
    std::uint32_t side = 4;   // places of a cell, squared; of a density more where those differ, as at edges of lights
    std::uint32_t paths = 16; // of a cell instead, where rays are traced
    std::uint32_t samples = 4096; // that a density is to be known well enough for, when they are tested by it
};

// Makes a map row by row, in passes over all of it: there is one of fewer places at any time. Then cells of a density
// whose places differ, or samples from them, and their neighbours are integrated (CellIntegrals), as lamps may be
// smaller than what is between two places.
class MapBuilder {
  public:
    // The probe must outlive it.
    MapBuilder(const Probe& probe, const Strategy& strategy, const MapSettings& settings, std::uint32_t seed);

    bool isDone() const { return pass_ == passes_ && unequal_.isDone(); }
    bool hasPass() const { return pass_ > 0; } // over all of it
    void advance();                            // by a row of a pass
    DirectionMap map() const;

  private:
    double placeValue(std::uint32_t column, std::uint32_t row, std::uint32_t i) const;
    double pathValue(std::uint32_t column, std::uint32_t row) const;
    double valueAt(const glm::dvec2& place, const shared::Sampler& sampler) const;
    bool isRefined() const { return settings_.quantity == Quantity::Density && settings_.side > 1; }
    void findUnequal();

    const Probe* probe_;
    Strategy strategy_;
    MapSettings settings_;
    NumberSettings numbers_;
    DirectionMap map_; // without values
    std::vector<double> sums_;
    std::uint32_t passes_, pass_ = 0, row_ = 0;
    std::vector<float> least_, most_; // of each cell's places, of a density
    CellIntegrals unequal_;           // of cells where those differ
};

// At once.
DirectionMap mapOf(const Probe& probe, const Strategy& strategy, const MapSettings& settings, std::uint32_t seed);

} // namespace rt::probe
