// What a window shows while its camera moves: few samples a frame, through the live filter. The camera goes along a
// path around what it looks at, and then is back at the path's begin at once: a cut.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "Common/Bench/Document.h"
#include "Common/Bench/Engines.h"
#include "Common/Bench/ReferenceStore.h"
#include "Common/Bench/Results.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::bench {

struct LiveRequest {
    std::string scene = "cornell-box-lights"; // id or file
    std::string engine = "multi";
    std::uint32_t width = 320;
    std::uint32_t frames = 12;     // on the path, before the cut
    std::uint32_t framesAfter = 4; // the path once more
    double degrees = 1;            // around what is looked at, from frame to frame
    std::vector<std::uint32_t> spp = {1, 2, 4};
    double referenceSeconds = 10; // most that may be spent on a frame's reference
};

struct LiveFrame {
    std::uint32_t frame = 0, spp = 0;
    double seconds = 0;   // of samples
    Figure secondsFilter; // none: this engine has no live picture of so few samples
    Figure relmse, flip;  // of the picture as it is; none: there is no reference
    Figure relmseLive, flipLive;
};

// The camera of a frame: turned around what it looks at.
scene::CameraDesc cameraOfFrame(const scene::CameraDesc& first, const LiveRequest& request, std::uint32_t frame);

// All frames of each number of samples; fewer when `stop` becomes true. Throws as the engine and its scene do.
std::vector<LiveFrame> measureLive(Engines& engines, ReferenceStore& references, const LiveRequest& request,
                                   const std::atomic<bool>& stop,
                                   const std::function<void(const std::string&)>& say = {});

// How much worse the first frame after the cut is than that of the same camera before which there was none, in relMSE
// of the live picture: above 1 where a picture remembers what is no longer there.
Figure ghosting(const LiveRequest& request, const std::vector<LiveFrame>& frames, std::uint32_t spp);

// A row for each number of samples, then all frames.
Document describeLive(const LiveRequest& request, const std::vector<LiveFrame>& frames);

} // namespace rt::bench
