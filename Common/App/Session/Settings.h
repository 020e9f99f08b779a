// What a render is asked to do. Defaults are those of the interface contract; comparing two values tells what changed.
#pragma once
#include <cstdint>
#include <optional>

#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/Types.h"

namespace rt::app {

enum class LightSampling : std::uint32_t {
    Bsdf = shared::kSampleBsdf,
    Mixture = shared::kSampleMixture,
    Mis = shared::kSampleMis, // power heuristic
    MisBalance = shared::kSampleMisBalance
};
enum class LightSelection : std::uint32_t {
    Uniform = shared::kSelectUniform,
    Power = shared::kSelectPower,
    Contribution = shared::kSelectContribution
};
// How a point or direction on a light of one shape is chosen; for spheres SolidAngle is the uniform cone.
enum class ShapeSampling : std::uint32_t {
    Auto = shared::kShapeAuto,
    SolidAngle = shared::kShapeSolidAngle,
    Projected = shared::kShapeProjected,
    Area = shared::kShapeArea
};
enum class PathReuse : std::uint32_t {
    Off,
    On,  // wherever the scene allows it
    Auto // where it wins
};

enum class SamplerKind : std::uint32_t {
    Independent = shared::kSamplerIndependent,
    Stratified = shared::kSamplerStratified,
    Sobol = shared::kSamplerSobol,
    SobolBlue = shared::kSamplerSobolBlue
};

inline constexpr std::uint32_t kErrorReplicates = 4; // at least, where a render ends by its estimated error

struct RenderSettings {
    std::uint32_t width = 600; // pixels
    std::uint32_t height = 600;
    std::uint32_t spp = 100; // 1 to 2^31 - 1
    bool sppIsKnown = true;  // false: a time or error limit may end the render earlier (strata come in rounds of 256)
    std::uint32_t maxDepth = 50; // path vertices after the camera, 1 to 4096
    LightSampling lightSampling = LightSampling::Mis;
    LightSelection lightSelection = LightSelection::Contribution;
    ShapeSampling sphereLight = ShapeSampling::Auto;
    ShapeSampling quadLight = ShapeSampling::Auto;
    ShapeSampling triangleLight = ShapeSampling::Auto;
    SamplerKind sampler = SamplerKind::Sobol;
    bool russianRoulette = true;
    bool specularConnections = true;       // to lights, by way of smooth spheres
    bool edgeRays = true;                  // more camera rays where the edge of a light crosses a pixel
    PathReuse pathReuse = PathReuse::Auto; // pixels share what their paths bring
    std::uint32_t seed = 0;
    std::uint32_t replicates = 1;
    bool secondMoments = false;               // keep what error estimates need
    bool adaptive = false;                    // spp is the mean; needs an even number of replicates
    std::optional<shared::Features> features; // forced feature mask, a superset of the scene's

    bool operator==(const RenderSettings&) const = default;
};

} // namespace rt::app
