// The samples of one pixel, traced again: numbers depend on pixel, sample, dimension and seed alone, so the paths are
// those of a render, and what they bring together is what its film was given.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "Common/Probe/PathRecord.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::probe {

struct TracedSample {
    shared::vec3 radiance{};       // as a film gets it
    std::vector<FoundLight> found; // whose sum that is, but for rounding
};

class PixelPaths {
  public:
    // Of the render that the options of `scene`, which must outlive it, ask for. Throws UsageError where the camera
    // cannot be.
    PixelPaths(const SceneFormulas& scene, const scene::CameraDesc& camera, std::uint32_t x, std::uint32_t y);

    // Sample s belongs to replicate s mod R, as in a film.
    TracedSample trace(std::uint32_t sample) const;
    // Where the middle of the pixel shows a surface, in the world; nothing: it shows none.
    std::optional<shared::vec3> seen() const;
    bool sharesPaths() const; // with the pixels of its group, whose paths are then traced, too
    std::uint32_t replicates() const { return render_.scene->options().settings.replicates; }

  private:
    struct Pixel {
        std::uint32_t x, y;
    };
    shared::Sampler samplerOf(const Pixel& pixel, std::uint32_t sample) const;
    std::uint32_t edgePart(const Pixel& pixel) const;
    PathRecord ownPath(const Pixel& pixel, const shared::Sampler& sampler) const;
    void addEdgeRays(const shared::Sampler& sampler, TracedSample& traced) const;
    void addShared(const std::vector<PathRecord>& group, std::size_t own, TracedSample& traced) const;
    float densityFrom(const SharedEnd& path, const SharedEnd& suffix, bool isItself) const;
    float ratioOf(const SharedEnd& path, const shared::vec3& place) const;

    TracedRender render_;
    std::vector<Pixel> group_;         // row by row, with the pixel itself
    std::size_t own_ = 0;              // of these
    std::vector<std::uint32_t> edges_; // of the group
};

} // namespace rt::probe
