// What the paths of neighbouring pixels share. Included by one translation unit per instruction set; all it defines has
// internal linkage.
#pragma once
#include <algorithm>
#include <span>

#include "Common/Image/Film.h"
#include "Common/Shared/Technique/AimedScattering.h"
#include "RayTracingCPU/SceneAccess.h"

namespace rt::cpu {
namespace {

using namespace rt::shared;

// What the path of a sample shares.
struct SharedPath {
    vec3 first; // its first vertex, where rays start
    vec3 firstNormal;
    float aimed;     // SharedPart::aimed there
    vec3 throughput; // of the path behind it
    vec3 second;     // its second vertex, likewise
    vec3 secondNormal;
    vec3 radiance; // that the second sends out
    uint reuse;    // how the path has ended: kReuse...
};

// The samples of one number in a group of pixels.
struct ReuseGroup {
    uint count = 0u;
    uint samples[kReuseGroup];
};

// What the paths of a kernel's samples share, in the order of TileSamples.
template <Features kFeatures>
class SharedPaths {
  public:
    explicit SharedPaths(const KernelContext& context)
        : scene_(*context.scene),
          isUsed_(reusesPaths(kFeatures, context.params)),
          aims_(aimsPaths(kFeatures, context.params)) {}

    // After the path of a sample, whose PathState::reuse was `before`, has arrived at v. What it had brought before its
    // second vertex goes to the sample's radiance.
    void arrived(uint sample, uint before, const PathState& path, const vec3& prefix, const Vertex& v, vec3& radiance) {
        if (!isUsed_ || path.reuse == before) return;
        SharedPath& shared = paths_[sample];
        if (path.reuse == kReuseFirst) {
            shared.first = v.origin;
            shared.firstNormal = v.normal;
            shared.aimed = 0.0f;
            shared.throughput = path.throughput * v.bsdf.albedo;
        } else if (path.reuse == kReuseSuffix) {
            shared.second = v.origin;
            shared.secondNormal = v.normal;
            radiance = prefix;
        }
    }

    // At the first vertex of a sample's path this share of directions is aimed.
    void aimed(uint sample, float share) { paths_[sample].aimed = share; }

    // The path of a sample has ended.
    void ended(uint sample, const PathState& path, vec3& radiance) {
        SharedPath& shared = paths_[sample];
        shared.reuse = isUsed_ ? path.reuse : kReuseNone;
        (shared.reuse == kReuseSuffix ? shared.radiance : radiance) = path.radiance;
    }

    // What throughput that begins anew behind the second vertex is a part of.
    vec3 throughputBefore(uint sample, const PathState& path) const {
        return isUsed_ && path.reuse == kReuseSuffix ? paths_[sample].throughput : vec3(1.0f);
    }

    // To what the second vertex of an ended path sends out.
    void add(uint sample, const vec3& radiance) {
        if (paths_[sample].reuse == kReuseSuffix) paths_[sample].radiance += radiance;
    }

    // Adds to the radiances of all samples of the tasks what their groups' paths have found.
    void finish(std::span<const TileTask> tasks, vec3* radiances, KernelCounters& counters) {
        if (!isUsed_) return;
        uint first = 0u;
        for (const TileTask& task : tasks) {
            PixelSamples pixels[image::Film::kTilePixels];
            PixelSamples* next = pixels;
            for (uint y = 0u; y < task.height; ++y) {
                for (uint x = 0u; x < task.width; ++x) {
                    *next = {first, task.samplesOf(x, y)};
                    first += next++->count;
                }
            }
            for (uint y = 0u; y < task.height; y += kReuseSide)
                for (uint x = 0u; x < task.width; x += kReuseSide) share(task, pixels, x, y, radiances, counters);
        }
    }

  private:
    struct PixelSamples {
        uint first, count;
    };

    // Of the groups whose upper left pixel is this one of the task's, which are listed row by row.
    void share(const TileTask& task, const PixelSamples* ofTask, uint x, uint y, vec3* radiances,
               KernelCounters& counters) {
        PixelSamples pixels[kReuseGroup];
        uint pixelCount = 0u, maximum = 0u;
        for (uint row = y; row < std::min(y + kReuseSide, task.height); ++row) {
            for (uint column = x; column < std::min(x + kReuseSide, task.width); ++column) {
                pixels[pixelCount] = ofTask[row * task.width + column];
                maximum = std::max(maximum, pixels[pixelCount++].count);
            }
        }
        for (uint i = 0u; i < maximum; ++i) {
            ReuseGroup group;
            for (uint p = 0u; p < pixelCount; ++p) {
                const uint sample = pixels[p].first + i;
                if (i < pixels[p].count && sharesVertex(paths_[sample].reuse)) group.samples[group.count++] = sample;
            }
            share(group, radiances, counters);
        }
    }

    // Of the samples whose first vertices are shared.
    void share(const ReuseGroup& group, vec3* radiances, KernelCounters& counters) {
        vec3 received[kReuseGroup] = {}; // at their first vertices
        for (uint j = 0u; j < group.count; ++j) {
            const SharedPath& suffix = paths_[group.samples[j]];
            if (suffix.reuse != kReuseSuffix || !(maxComponent(suffix.radiance) > 0.0f)) continue;
            float densities[kReuseGroup]; // of scattering alone
            float sum = 0.0f;             // of those with which the second vertex was drawn
            for (uint k = 0u; k < group.count; ++k) {
                const SharedPath& path = paths_[group.samples[k]];
                densities[k] = density(path, suffix, k == j, counters);
                sum += densities[k] * ratio(path, suffix.second);
            }
            for (uint k = 0u; k < group.count; ++k) received[k] += suffix.radiance * (densities[k] / sum);
        }
        for (uint k = 0u; k < group.count; ++k)
            radiances[group.samples[k]] += paths_[group.samples[k]].throughput * received[k];
    }

    // With which a path's first vertex could have drawn the second of another, or of itself; > 0 then.
    float density(const SharedPath& path, const SharedPath& suffix, bool isItself, KernelCounters& counters) const {
        const float density = reuseDensity(path.first, path.firstNormal, suffix.second, suffix.secondNormal);
        if (isItself) return max(density, kMinReuseDensity);
        if (density == 0.0f) return 0.0f;
        ++counters.reuse;
        float tMax;
        const Ray ray = reuseRay(path.first, suffix.second, tMax);
        return isOccluded(scene_, ray, tMax) ? 0.0f : density;
    }

    // Of the density with which a path's first vertex draws y to that of scattering alone.
    float ratio(const SharedPath& path, const vec3& y) const {
        if (!aims_) return 1.0f;
        return aimedRatioTowards(scene_.globals.aimed, path.first, path.firstNormal, path.aimed, y);
    }

    const CpuScene& scene_;
    bool isUsed_;
    bool aims_;
    SharedPath paths_[kBatchSamples];
};

} // namespace
} // namespace rt::cpu
