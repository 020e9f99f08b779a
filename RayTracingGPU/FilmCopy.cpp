#include "RayTracingGPU/FilmCopy.h"

#include <algorithm>
#include <atomic>

namespace rt::gpu {
namespace {

using image::Film;
using shared::kTilePixels;

std::span<const double> toDoubles(std::span<const shared::FilmSum> sums, std::vector<double>& values) {
    values.resize(kTileValues);
    for (std::size_t i = 0; i < kTilePixels; ++i) {
        const glm::dvec3 exact = glm::dvec3(sums[i].high) + glm::dvec3(sums[i].low);
        for (int c = 0; c < 3; ++c) values[3 * i + static_cast<std::size_t>(c)] = exact[c];
    }
    return values;
}

} // namespace

Film::TileState StateReader::read(std::size_t slot, std::uint32_t samples) {
    const std::size_t pixel = slot * kTilePixels;
    Film::TileState state;
    state.samples = samples;
    state.sums = toDoubles(copy_.sums.subspan(pixel, kTilePixels), sums_);
    if (!copy_.squares.empty()) state.squares = toDoubles(copy_.squares.subspan(pixel, kTilePixels), squares_);
    if (samples % Film::kBlock != 0) state.open = {&copy_.open[pixel].x, kTileValues};
    return state;
}

std::shared_ptr<const vulkan::Buffer> ReadBackPool::take(VkDeviceSize bytes) {
    constexpr VkDeviceSize kGrain = VkDeviceSize{1} << 20;
    const auto isUnused = [](const auto& buffer) { return buffer.use_count() == 1; };
    const auto fits = [&](const auto& buffer) { return isUnused(buffer) && buffer->bytes() >= bytes; };
    const auto found = std::find_if(buffers_.begin(), buffers_.end(), fits);
    if (found != buffers_.end()) {
        std::atomic_thread_fence(std::memory_order_acquire); // another thread may have read it until now
        return *found;
    }
    std::erase_if(buffers_, isUnused); // too small
    const VkDeviceSize size = (bytes + kGrain - 1) / kGrain * kGrain;
    return buffers_.emplace_back(std::make_shared<const vulkan::Buffer>(context_.memory(), size, 0,
                                                                        vulkan::Memory::ReadBack, "tiles of a film"));
}

} // namespace rt::gpu
