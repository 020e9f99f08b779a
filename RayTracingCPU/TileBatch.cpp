#include "RayTracingCPU/TileBatch.h"

#include <algorithm>
#include <span>
#include <utility>

namespace rt::cpu {

using image::Film;

bool TileBatch::add(std::uint32_t tile, std::uint32_t replicate, std::uint32_t end) {
    if (film_.hasPlan()) end = std::min(end, film_.planEnd(tile, replicate));
    for (std::uint32_t sample = film_.samples(tile, replicate); sample < end;) {
        TileTask task = taskFor({tile, replicate}, sample, end);
        const std::uint32_t samples = task.samples();
        if ((count_ == kBlocks || samples_ + samples > kBatchSamples) && !flush()) return false;
        Film::TileBlock& block = blocks_[count_];
        if (sample == film_.samples(tile, replicate)) {
            film_.begin(tile, replicate, block);
        } else { // the tile's block before it waits as well
            block = {};
            block.firstSample = sample;
        }
        block.count += task.count;
        task.sum = block.sum;
        if (film_.isPilot()) task.squares = block.squares;
        slots_[count_] = {tile, replicate};
        tasks_[count_] = task;
        ++count_;
        samples_ += samples;
        sample += task.count;
    }
    return true;
}

bool TileBatch::flush() {
    const std::span<const TileTask> tasks(tasks_.data(), std::exchange(count_, 0));
    samples_ = 0;
    if (tasks.empty()) return true;
    if (!kernel_.renderTiles(context_, tasks, cancel_, counters_)) return false;
    for (std::size_t i = 0; i < tasks.size(); ++i) film_.commit(slots_[i].tile, slots_[i].replicate, blocks_[i]);
    return true;
}

// The samples from `first` to the end of their block, or to `end`.
TileTask TileBatch::taskFor(const Slot& slot, std::uint32_t first, std::uint32_t end) const {
    TileTask task;
    task.x = slot.tile % film_.tilesX() * Film::kTile;
    task.y = slot.tile / film_.tilesX() * Film::kTile;
    task.width = std::min(Film::kTile, film_.desc().width - task.x);
    task.height = std::min(Film::kTile, film_.desc().height - task.y);
    task.stride = Film::kTile;
    task.replicate = slot.replicate;
    task.first = first;
    task.count = std::min(Film::kBlock - first % Film::kBlock, end - first);
    if (film_.hasPlan()) task.plan = film_.plan(slot.tile, slot.replicate).data();
    return task;
}

} // namespace rt::cpu
