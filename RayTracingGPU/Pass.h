// How far the film goes on at a time, and what part of that a launch takes.
#pragma once
#include <cstdint>

#include "RayTracingGPU/DeviceFilm.h"

namespace rt::gpu {

// Of a launch: its radiance takes 144 MB, what its paths share 768.
inline constexpr std::uint64_t kMaxSamples = 12'000'000;

// Takes every pixel of the film further, slot by slot of each region.
struct Pass {
    std::uint32_t end = 0;         // samples per pixel that it leads to
    std::uint32_t steps = 0;       // samples of a slot's pixels that it takes, at most
    std::uint64_t stepSamples = 0; // of the film's, when the pass began
    std::uint32_t nextSlot = 0;    // of each of the region's bands: the first that it has not launched
};

// From `begun` to at most `spp` > `begun` samples per pixel, with launches of about `fitting` samples; of `wanted`
// samples in all, or more where that is less than two launches, which may have `most` each.
Pass planPass(const DeviceFilm& region, std::uint64_t begun, std::uint64_t spp, std::uint64_t fitting,
              std::uint64_t wanted, std::uint64_t maximum);

// The next slots of the pass in all bands of the region, up to about `fitting` samples, and `most` in any case.
shared::FilmLaunch nextLaunch(const DeviceFilm& region, const Pass& pass, std::uint64_t fitting, std::uint64_t maximum);

} // namespace rt::gpu
