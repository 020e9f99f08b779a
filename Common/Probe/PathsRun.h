// Why a pixel is noisy: its samples, their variance by how light was found and after how many bounces, and the paths
// that brought most. Worked out in small portions.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "Common/Probe/PixelPaths.h"

namespace rt::probe {

struct PathsSettings {
    std::uint32_t samples = 256;
    std::size_t listed = 16;               // paths, the brightest ones
    std::optional<std::uint32_t> selected; // a sample, of which all paths are wanted
    bool operator==(const PathsSettings&) const = default;
};

// A path of a sample to the light that it found.
struct ListedPath {
    std::uint32_t sample = 0;
    FoundLight found;
};

// What a part of the light has of the mean and of the variance. That is its covariance with the whole, so that shares
// sum to 1; one below 0 makes up for others.
struct NoiseShare {
    Technique technique = Technique::Seen;
    std::uint32_t bounces = 0;
    double mean = 0;  // luminance
    double share = 0; // of the variance
};

struct PathsResult {
    PathsSettings settings;
    std::vector<float> samples;           // their luminance, in order; of one that is dropped not a number
    std::vector<Technique> dominant;      // of each sample: what brought most of it
    std::uint32_t dropped = 0;            // as not finite: as the film does
    glm::dvec3 radiance{};                // mean
    double mean = 0;                      // of the luminance
    double variance = 0;                  // of a sample
    std::vector<NoiseShare> shares;       // by technique and bounces, the greatest first
    std::vector<ListedPath> listed;       // the brightest first
    std::vector<ListedPath> selected;     // of the sample that is selected
    std::optional<shared::vec3> position; // that the pixel shows
    bool sharesPaths = false;
    bool isDone = false;

    double standardError() const; // of the mean, as for independent samples
    // The sample that has most of the variance, and how much.
    std::pair<std::uint32_t, double> worst() const;
};

inline constexpr std::uint32_t kPooledBounces = 8; // so many, or more

// Of the result's shares, summed; the greatest first, bounces from 0 on.
std::vector<NoiseShare> sharesByTechnique(const PathsResult& result);
std::vector<NoiseShare> sharesByBounces(const PathsResult& result);

class PathsRun {
  public:
    // The scene must outlive it.
    PathsRun(const SceneFormulas& scene, const scene::CameraDesc& camera, std::uint32_t x, std::uint32_t y,
             const PathsSettings& settings);

    bool isDone() const { return samples_.size() == settings_.samples; }
    bool hasFirst() const { return samples_.size() >= kFirst || isDone(); }
    void advance();             // by a few milliseconds, mostly
    PathsResult result() const; // of the samples so far

  private:
    static constexpr std::size_t kFirst = 16, kPortion = 4;

    // Sums over samples of what one technique found after so many bounces, and of its product with the whole sample.
    struct Part {
        double sum = 0, product = 0;
    };
    void add(std::uint32_t sample, const TracedSample& traced);
    void list(std::uint32_t sample, const FoundLight& found);
    std::vector<NoiseShare> shares(double count, double squares) const;

    PixelPaths paths_;
    std::optional<shared::vec3> position_;
    PathsSettings settings_;
    std::vector<float> samples_;
    std::vector<Technique> dominant_;
    std::uint32_t dropped_ = 0;
    glm::dvec3 radiance_{};
    double sum_ = 0; // of luminances
    std::map<std::pair<Technique, std::uint32_t>, Part> parts_;
    std::vector<ListedPath> listed_, selected_;
};

} // namespace rt::probe
