// Motion blur by any engine: its samples are of a scene that is posed at one time of the shutter after the other
// (Haeberli & Akeley, "The Accumulation Buffer", 1990, with times that are random, so that the mean has no bias).
#pragma once
#include <cstdint>
#include <functional>
#include <memory>

#include "Common/Render/Engine.h"

namespace rt::app {

// The scene at a time in seconds, with its camera. Throws InputError, and Interrupted where Interruptible says so.
using PoseScene = std::function<std::shared_ptr<const scene::CompiledScene>(double seconds)>;

// Where sample `sample` of a replicate stands among its poses: it shares pose `pose`, of this level, with those up to
// `end`. The first samples have a pose each; from then on a pose has twice as many whenever the samples have become
// four times as many, so that poses cost less and less beside them, and the error that is left of having so few times
// falls with the samples all the same. It depends on nothing else: a render may end anywhere, and go on.
struct PoseOfSample {
    std::uint32_t level = 0; // of 2^level samples a pose
    std::uint32_t pose = 0;
    std::uint32_t end = 1;
};
inline constexpr std::uint32_t kPosesOfOneSample = 64; // a replicate's first
PoseOfSample poseOfSample(std::uint32_t sample);

// When that is, as a share of the shutter's interval: uniform over [0,1), and stratified over each replicate's poses,
// however many there are.
double timeOfPose(std::uint32_t seed, std::uint32_t replicate, const PoseOfSample& pose);

// Renders what `pose` makes of the scene while the shutter is open, from `open` to `close` in seconds. What it is given
// is one of its poses; a camera of that follows its motion (FollowedCamera.h), any other stays. Each replicate is a
// render of its own with times of its own, so that they tell the error that times leave as well. Of features of
// surfaces it makes the mean over kAovPoses times. Not for adaptive films nor for leases.
std::unique_ptr<Engine> makeShutterEngine(std::unique_ptr<Engine> engine, double open, double close, PoseScene pose);
// By an engine that outlives it, and that is used by nobody else until a scene is set there again.
std::unique_ptr<Engine> makeShutterEngine(Engine& engine, double open, double close, PoseScene pose);

inline constexpr std::uint32_t kAovPoses = 32; // at most: two for each sample that is asked for

} // namespace rt::app
