// What a path of a render has found, and how.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "Common/Probe/PathNames.h"
#include "Common/Probe/SceneFormulas.h"
#include "Common/Shared/Base/PathTypes.h"

namespace rt::probe {

enum class PointKind { Camera, Surface, Specular, Medium, Light, Sky };

struct PathPoint {
    shared::vec3 position{}; // in the world, as authored; of the sky a place beyond the scene
    PointKind kind = PointKind::Surface;
    std::uint32_t material = shared::kNone; // of the scene; kNone: of none
};

// Light that a path found.
struct FoundLight {
    Technique technique = Technique::Seen;
    std::uint32_t bounces = 0;           // between the camera and the light
    shared::vec3 radiance{};             // that it adds to the sample
    shared::vec3 throughput{};           // of the path where the light was found
    std::uint32_t light = shared::kNone; // its index; kNone: it is not among those that are sampled
    bool isSky = false;
    float selection = 0;         // probability with which light sampling chooses it there; 0: it was not asked for
    float lightPdf = 0;          // with which it then samples the direction, per steradian; 0: likewise, or a point
    float directionPdf = 0;      // of scattering, or of the mixture, per steradian; 0: there is none, as of a mirror
    float weight = 1;            // against other techniques that could have found it; 0: not known
    std::array<int, 2> from{};   // the pixel whose path it was, less the own one
    std::vector<PathPoint> line; // from the camera to the light
};

// What the path of a sample leaves to be shared, as SharedPaths.h of the CPU engine has it.
struct SharedEnd {
    shared::vec3 first{}, firstNormal{}; // of its first vertex that is no mirror and no glass, where rays start
    float aimed = 0;
    shared::vec3 throughput{};             // behind it
    shared::vec3 second{}, secondNormal{}; // of its second vertex
    shared::vec3 radiance{};               // that the second sends out
    std::uint32_t reuse = shared::kReuseNone;
    std::size_t firstPoint = 0; // the first vertex in `points`
};

struct PathRecord {
    shared::vec3 radiance{}; // what the path brings, but for connections and what is behind its second vertex if shared
    shared::vec3 connected{}; // what connections bring, likewise
    shared::vec3 connectedBehind{};
    std::vector<FoundLight> found;  // all that makes up both
    std::vector<FoundLight> behind; // what the second vertex sends out, in radiance there; lines are from the camera
    std::vector<PathPoint> points;  // camera and vertices
    SharedEnd shared;
};

// What paths of one render are traced with.
struct TracedRender {
    const SceneFormulas* scene = nullptr;
    shared::Features features;
    shared::RenderParams params{};
    shared::Camera camera{};
};

// Traces a path by stepPath(), the text that both engines compile, and asks its formulas once more for what they found.
PathRecord recordPath(const TracedRender& render, const shared::Sampler& sampler, const shared::PathState& begin);

} // namespace rt::probe
