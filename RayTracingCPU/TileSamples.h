// The samples of some tiles, whose paths begin sixteen at a time. Included by one translation unit per instruction set;
// all it defines has internal linkage.
#pragma once
#include "RayTracingCPU/SampleLanes.h"

namespace rt::cpu {
namespace {

using namespace rt::shared;

// Camera rays of the samples of tiles, pixel by pixel, and what they hit.
class TileSamples {
  public:
    // There is at least one task.
    TileSamples(const KernelContext& context, std::span<const TileTask> tasks)
        : context_(context), task_(tasks.data()), inPixel_(task_->samplesOf(0u, 0u)) {
        for (const TileTask& task : tasks) count_ += task.samples();
    }

    uint count() const { return count_; }

    // The index of the next sample, with its camera ray and pixel; its sampler and what the ray hits in a lane. kNone:
    // none is left.
    template <Features kFeatures>
    uint next(PathLanes& lanes, uint lane, Ray& ray, uvec2& pixel) {
        if (next_ == count_) return kNone;
        const uint i = next_ % kLanes;
        if (i == 0u) {
            generateRays<kFeatures>();
            traceRays<kFeatures>();
        }
        set(lanes.samplers, lane, get(samplers_, i));
        set(lanes.hits, lane, get(hits_, i));
        ray = get(rays_, i);
        pixel = uvec2(pixelX_.at[i], pixelY_.at[i]);
        return next_++;
    }

  private:
    // Of the samples from next_ on.
    template <Features kFeatures>
    void generateRays() {
        for (uint i = 0u; i < kLanes; ++i) {
            const bool isSample = next_ + i < count_; // those behind the last stay in its pixel
            while (isSample && sampleInPixel_ == inPixel_) nextPixel();
            if (sampleInPixel_ == 0u) {
                const uint index = (task_->y + y_) * context_.params.width + task_->x + x_;
                first_ = makeSampler(context_.params, index, task_->replicate, task_->first);
            }
            Sampler s = first_;
            s.index += sampleInPixel_++;
            set(samplers_, i, s);
            pixelX_.at[i] = task_->x + x_;
            pixelY_.at[i] = task_->y + y_;
        }
        RecordLanes<CameraSamples> u;
        const RenderParams params = context_.params; // of this function, so that no lane could overlap them
        const Camera camera = context_.camera;
        drawCameraSamples(kFeatures, samplers_, u);
        for (uint i = 0u; i < kLanes; ++i) {
            const uvec2 pixel(pixelX_.at[i], pixelY_.at[i]);
            set(rays_, i, cameraRay(kFeatures, params, camera, pixel, get(u, i)));
        }
    }

    // One after the other: they are alike, and do not wait for each other.
    template <Features kFeatures>
    void traceRays() {
        const uint count = min(kLanes, count_ - next_);
        for (uint i = 0u; i < count; ++i) {
            set(hits_, i, traceRay(kFeatures, *context_.scene, get(samplers_, i), 0u, get(rays_, i)));
        }
    }

    void nextPixel() {
        sampleInPixel_ = 0u;
        if (++x_ == task_->width) {
            x_ = 0u;
            if (++y_ == task_->height) {
                y_ = 0u;
                ++task_;
            }
        }
        inPixel_ = task_->samplesOf(x_, y_);
    }

    const KernelContext& context_;
    const TileTask* task_; // of the next sample
    uint count_ = 0u;      // samples
    uint next_ = 0u;       // sample of the tiles
    uint x_ = 0u;          // of the pixel in the tile
    uint y_ = 0u;
    uint inPixel_; // samples
    uint sampleInPixel_ = 0u;
    Sampler first_{}; // of the pixel's samples
    RecordLanes<Sampler> samplers_;
    RecordLanes<Ray> rays_;
    UintLanes pixelX_, pixelY_;
    RecordLanes<Hit> hits_;
};

} // namespace
} // namespace rt::cpu
