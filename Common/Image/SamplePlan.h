// Adaptive sampling that stays unbiased: how many samples each pixel gets, decided once, from a pilot.
//
// A pixel's number of samples must not depend on the samples that are averaged in it: one that missed its rare bright
// paths would look done and stay too dark. So an adaptive film has two halves, its even and its odd replicates, whose
// random numbers are independent. The pilot of one decides on the samples of the other:
//
//     half A   | pilot |----.  .---> more of A, n_A pixel by pixel
//                            \/
//                            /\                                       picture = (mean of A + mean of B) / 2
//     half B   | pilot |----'  `---> more of B, n_B pixel by pixel
//
// Given its number of samples, each half's mean is that of any independent samples, and the weights of the halves are
// fixed: what the picture is expected to be is what it is expected to be with uniform samples.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "Common/Image/Film.h"

namespace rt::image {

// Samples per pixel of the pilot of a film that is to have `spp` in the mean: at most half of these, a power of two in
// each half, so that it is well spread. 0: `spp` is too small for a plan, or vast, and samples are uniform.
std::uint32_t pilotSamples(std::uint32_t spp);

struct PlanWork {
    std::size_t threads = 0; // 0: as many as the machine has; the plan does not depend on it
    const std::atomic<bool>* cancel = nullptr;
};

// What Film::setPlan() takes, for a film whose pixels have pilotSamples(spp) samples, which is not 0. No pixel gets
// fewer than it has; all together get spp times the number of pixels. Empty: cancelled.
//
// A half's samples are spread in proportion to the root of a pixel's part in the error per sample, which minimises the
// error: of a blend of MSE and relMSE (see Metrics.h), each in units of what it is over the image, since either alone
// would cost the other. Variances and means are those of the other half's pilot, weighed over 3x3 pixels: a few samples
// say little of one pixel's rare events. What is added to all, and a limit, keep what a pilot has missed, or taken for
// more than it is, from costing much.
//
// Pixels of a square of `dependentSide`, a divisor of Film::kTile, bring each other what their samples meet, and get as
// many as their mean part in the error asks for. The first square begins at the first pixel.
std::vector<std::uint32_t> makeSamplePlan(const Film& film, std::uint32_t spp, std::uint32_t dependentSide,
                                          const PlanWork& work = {});

// To how many samples per pixel a film that is to have `spp` goes on: to those of its pilot, and from there to the most
// that the plan gives a pixel; to `spp` if it is not adaptive.
std::uint64_t goalOf(const Film& film, std::uint32_t spp);

} // namespace rt::image
