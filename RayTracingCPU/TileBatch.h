// What a worker renders at a time: a block of a tile's samples, or blocks of several tiles where a plan gives samples
// to few pixels, so that packets of paths stay full.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>

#include "Common/Image/Film.h"
#include "RayTracingCPU/KernelArgs.h"

namespace rt::cpu {

// Of one worker.
class TileBatch {
  public:
    TileBatch(const Kernel& kernel, const KernelContext& context, image::Film& film, const std::atomic<bool>* cancel)
        : kernel_(kernel), context_(context), film_(film), cancel_(cancel) {}

    // Takes all pixels of the tile to sample `end` of the replicate, or to where its plan ends. Some samples may wait
    // for flush(). False: cancelled; what the film does not have by then is dropped.
    bool add(std::uint32_t tile, std::uint32_t replicate, std::uint32_t end);
    // Renders what waits and commits it to the film.
    bool flush();

    const KernelCounters& counters() const { return counters_; }

  private:
    struct Slot {
        std::uint32_t tile, replicate;
    };

    TileTask taskFor(const Slot& slot, std::uint32_t first, std::uint32_t end) const;

    static constexpr std::uint32_t kBlocks = 32;

    const Kernel& kernel_;
    const KernelContext& context_;
    image::Film& film_;
    const std::atomic<bool>* cancel_;
    KernelCounters counters_;
    std::uint32_t count_ = 0;   // of the blocks that wait
    std::uint32_t samples_ = 0; // that these are to get
    std::array<Slot, kBlocks> slots_{};
    std::array<TileTask, kBlocks> tasks_;
    std::array<image::Film::TileBlock, kBlocks> blocks_;
};

} // namespace rt::cpu
