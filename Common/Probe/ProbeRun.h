// All that there is to know of a surface: a map, samples and their test, the variance of each strategy. It is worked
// out in small portions, and there is something to show after the first ones.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "Common/Probe/DensityTest.h"
#include "Common/Probe/DirectionMap.h"
#include "Common/Probe/Estimate.h"
#include "Common/Probe/Probe.h"

namespace rt::probe {

struct ProbeSettings {
    Strategy strategy;
    Quantity quantity = Quantity::Density;
    std::vector<Projection> projections{Projection::Sphere}; // of the quantity's maps
    std::uint32_t rows = 128;                                // of a map
    std::uint32_t side = 4, paths = 16;                      // as MapSettings
    std::uint32_t samples = 4096;
    NumberSettings numbers;
    bool showsStrata = false; // the cells' edges
    bool operator==(const ProbeSettings&) const = default;
};

struct EstimateOf {
    std::string name, title;       // of the strategy
    double mean = 0, variance = 0; // as DirectEstimate
    std::uint32_t samples = 0;

    // Whether all samples have the same value, but for rounding in single precision.
    bool isExact() const { return mean > 0 && variance < 1e-9 * mean * mean; }
};

// Of the first so many samples.
struct TestOf {
    std::uint32_t samples = 0;
    DensityTest test;
};

struct ProbeResult {
    static constexpr std::size_t kShown = 512; // of the samples, at most

    ProbeSettings settings;
    shared::vec3 position{}, normal{};
    std::string material;
    std::uint32_t lights = 0;
    std::vector<LightShare> selection;            // the likeliest ones
    DirectionMap density;                         // of the strategy over all directions; by it samples are tested
    std::vector<DirectionMap> maps;               // as settings.projections
    std::vector<Drawn> shown;                     // the first samples
    std::vector<std::vector<shared::vec3>> edges; // of the strata, as lines of directions
    std::uint32_t samples = 0, dropped = 0;
    std::vector<TestOf> tests; // as samples grow; the last is of all of them
    std::vector<EstimateOf> estimates;
    bool isDone = false;
};

class ProbeRun {
  public:
    // The probe must outlive it. The strategy has a density there.
    ProbeRun(const Probe& probe, const ProbeSettings& settings);

    bool isDone() const;
    bool hasFirst() const { return shown_.size() == shownCount(); } // samples, and a coarse map
    void advance();                                                 // by what takes a few milliseconds at most, mostly
    // Of what there is by now; it does not depend on how the work was portioned once that is done.
    ProbeResult result() const;

  private:
    std::size_t shownCount() const;
    void prepareEstimates();
    void begin();
    void growSamples();
    void growEstimates();
    std::vector<DirectionMap> maps() const;

    const Probe* probe_;
    ProbeSettings settings_;
    std::vector<DirectionMap> coarse_; // until there is a pass of the others
    MapBuilder density_;
    std::vector<MapBuilder> builders_; // of other quantities, or projections
    std::vector<Drawn> shown_;
    std::vector<std::vector<shared::vec3>> edges_;
    std::vector<double> counts_; // of samples, in the cells of density_
    std::uint32_t samples_ = 0, dropped_ = 0;
    DirectionMap tested_; // as density_ says, once it is done
    std::vector<TestOf> tests_;
    // A strategy of kShapeStrategies.
    struct Shapes {
        std::shared_ptr<const SceneFormulas> formulas;
        std::unique_ptr<const Probe> probe;
    };
    std::vector<Shapes> shapes_;
    std::vector<DirectEstimate> estimates_;
    std::vector<EstimateOf> estimated_; // the names of estimates_
    std::size_t turn_ = 0;
};

} // namespace rt::probe
