// What the live denoiser hands to its kernel, which is compiled for several instruction sets: only plain data crosses.
#pragma once
#include <cstddef>

#include "Common/Shared/Denoise/DenoiseLive.h"

namespace rt::image {

inline constexpr int kLiveFeatures = 7; // albedo, normal, depth
// Of each row of a plane, at both ends: what no pixel of the image is. Tones there are like none of any pixel.
inline constexpr int kLiveMargin = shared::kLiveReach << (shared::kLiveLevels - 1);
inline constexpr std::size_t kLiveOverrun = 8; // floats that may be read behind the end of a plane
inline constexpr float kLiveOutside = 1.0e6f;

// What is filtered by the weights of one half: the other half's radiance, so that noise does not choose its own
// weights, and this half's tones, of which the next level makes weights. Pointers are to the first pixel of the row.
struct LiveHalf {
    const float *radiance[3] = {}, *tones[3] = {}, *variance = nullptr; // as the level before has left it
    float *newRadiance[3] = {}, *newTones[3] = {}, *newVariance = nullptr;
};

// One row of one level, of both halves.
struct LiveRow {
    int width = 0;
    int step = 1;             // pixels from one of the level's grid to the next
    int above = 0, below = 0; // rows of the grid that are inside of the image, at most kLiveReach
    std::ptrdiff_t pitch = 0; // floats from one row of a plane to the next
    int featureCount = 0;
    const float* features[kLiveFeatures] = {};
    LiveHalf half[2];
};

using LiveKernel = void (*)(const LiveRow&);

// Of each instruction set; only those of the architecture at hand exist.
LiveKernel liveKernel_x86_64_v2();
LiveKernel liveKernel_x86_64_v3();
LiveKernel liveKernel_x86_64_v4();
LiveKernel liveKernel_generic();

} // namespace rt::image
