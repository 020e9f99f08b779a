#include "Common/Render/RenderParams.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include "Common/Image/SamplePlan.h"
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Material/Bsdf.h"
#include "Common/Shared/Technique/PathReuse.h"

namespace rt::app {
namespace {

// Cells per round: at least one for each sample where their number is known, so that a single round covers them all.
shared::uvec2 strata(const RenderSettings& settings) {
    if (!settings.sppIsKnown) return {16u, 16u};
    const std::uint32_t samples = (settings.spp + settings.replicates - 1) / settings.replicates;
    auto columns = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(samples)));
    if (columns * std::uint64_t{columns} < samples) ++columns;
    return {columns, (samples + columns - 1) / columns};
}

// RenderParams::russianRoulette, by error times time (docs/measurements/light-sampling.md). Paths in rooms go on more
// often than
// their throughput says: indirect light makes most of the noise. Where there are many lamps their edges make it. Most
// paths under a plain sky soon leave for it, which no light sampling has done for them: ending bright ones by chance
// saves little and triples the variance.
constexpr std::uint32_t kRoulette = 2;
constexpr std::uint32_t kRouletteOfManyLamps = 1;
constexpr std::uint32_t kRouletteUnderSky = 4;
constexpr std::ptrdiff_t kManyLamps = 32; // more are many
constexpr std::uint32_t kFewLamps = 16;   // are few

bool isUnderPlainSky(const scene::CompiledScene& scene) {
    return scene.globals.skyKind == shared::kSkyConstant || scene.globals.skyKind == shared::kSkyGradient;
}

// Triangles that shine are those of a few meshes, mostly.
bool hasManyLamps(const scene::CompiledScene& scene) {
    const auto isLamp = [](const shared::Light& light) { return light.kind != shared::kLightTriangle; };
    return std::ranges::count_if(scene.lights, isLamp) > kManyLamps;
}

std::uint32_t rouletteOf(const scene::CompiledScene& scene) {
    if (isUnderPlainSky(scene)) return kRouletteUnderSky;
    return hasManyLamps(scene) ? kRouletteOfManyLamps : kRoulette;
}

// RenderParams::edgeRays: a power of two, which keeps Sobol's strata whole, and fewer where that would be more rays for
// each of the image's samples than kMaxEdgeRays in the mean.
constexpr std::uint32_t kRaysAtEdge = 8;
constexpr double kMaxEdgeRays = 1.0;

// Whether anything sends light on into a range of directions, and what is of use only there.
bool scattersWidely(const scene::CompiledScene& scene) {
    return !scene.media.empty() || std::ranges::any_of(scene.materials, [](const shared::Material& material) {
        return shared::scattersWidely(shared::makeBsdf(material, material.albedo));
    });
}
constexpr shared::Features kLightSampling =
    shared::kFeatureLights | shared::kFeatureManyLights | shared::kFeatureSphereLights | shared::kFeatureQuadLights |
    shared::kFeatureTriangleLights | shared::kFeatureEllipsoidLights | shared::kFeaturePunctualLights;

bool usesMis(const RenderSettings& settings) {
    return settings.lightSampling == LightSampling::Mis || settings.lightSampling == LightSampling::MisBalance;
}

// Whether lights are connected to by way of smooth spheres. What layers of partial opacity let through is not traced.
bool connectsLights(const scene::CompiledScene& scene, const RenderSettings& settings) {
    return settings.specularConnections && usesMis(settings) && !scene.specularCasters.empty() &&
           !shared::has(scene.features, shared::kFeatureOpacity) && scattersWidely(scene);
}

// Whether pixels may share what their paths bring: where light goes from one diffuse surface to another, is not
// scattered in between and finds all as it is at any time.
bool mayReusePaths(const scene::CompiledScene& scene, const RenderSettings& settings) {
    constexpr shared::Features kPrevents =
        shared::kFeatureVolumes | shared::kFeatureMovingSpheres | shared::kFeatureOpacity;
    return settings.lightSampling != LightSampling::Mixture &&
           shared::has(scene.features, shared::kEvenSurfaceFeatures) && !shared::has(scene.features, kPrevents);
}

// Whether that gains more than it costs, by error times time (docs/measurements/light-sampling.md): where indirect
// light makes the noise, and not a sky, many lamps, the edges of a mesh's light or blurred mirrors.
bool gainsByReuse(const scene::CompiledScene& scene) {
    constexpr shared::Features kOtherNoise =
        shared::kFeatureSky | shared::kFeatureTriangleLights | shared::kFeatureFuzz;
    return !shared::has(scene.features, kOtherNoise) && scene.globals.lightCount <= kFewLamps &&
           scene.globals.lightCount > 0;
}

bool reusesPaths(const scene::CompiledScene& scene, const RenderSettings& settings) {
    if (settings.pathReuse == PathReuse::Off || !mayReusePaths(scene, settings)) return false;
    return settings.pathReuse == PathReuse::On || gainsByReuse(scene);
}

// Whether paths that are shared aim at a sphere of glass: where the light of vertices is known to compare with.
bool aimsPaths(const scene::CompiledScene& scene, const RenderSettings& settings) {
    return settings.specularConnections && usesMis(settings) &&
           settings.lightSelection == LightSelection::Contribution && scene.globals.aimed.gain > 0;
}

// What the settings ask for and the scene has a use for.
shared::Features methodsOf(const scene::CompiledScene& scene, const RenderSettings& settings) {
    shared::Features methods;
    const auto use = [&](bool used, shared::Features method) {
        if (used) methods |= method;
    };
    const bool mixes = settings.lightSampling == LightSampling::Mixture;
    use(mixes && scattersWidely(scene) && scene.globals.lightCount + scene.globals.targetCount > 0,
        shared::kMethodMixture);
    for (const ShapeSampling shape : {settings.sphereLight, settings.quadLight, settings.triangleLight})
        use(shape == ShapeSampling::Projected && scattersWidely(scene), shared::kMethodProjected);
    use(connectsLights(scene, settings), shared::kMethodConnections);
    use(reusesPaths(scene, settings), shared::kMethodReuse);
    use(reusesPaths(scene, settings) && aimsPaths(scene, settings), shared::kMethodAiming);
    use(mayHaveEdges(scene, settings), shared::kMethodEdgeRays);
    return methods;
}

// Of the samples that a pixel takes: a power of two that covers them, if the image leaves so many of 2^32.
std::uint32_t logOfBlock(const RenderSettings& settings) {
    const std::uint32_t samples = (settings.spp + settings.replicates - 1) / settings.replicates;
    std::uint32_t wanted = settings.sppIsKnown ? static_cast<std::uint32_t>(std::bit_width(samples - 1)) : 4u;
    if (isAdaptive(settings)) wanted = std::max(wanted, 4u); // a block of the film must not go beyond
    const auto side = static_cast<std::uint32_t>(std::bit_width(std::max(settings.width, settings.height) - 1));
    return std::min(wanted, 32u - 2u * std::min(side, 16u));
}

} // namespace

shared::RenderParams makeRenderParams(const scene::CompiledScene& scene, const RenderSettings& settings) {
    shared::RenderParams params{};
    params.width = settings.width;
    params.height = settings.height;
    params.maxDepth = settings.maxDepth;
    params.seed = settings.seed;
    params.lightSampling = static_cast<std::uint32_t>(settings.lightSampling);
    params.lightSelection = static_cast<std::uint32_t>(settings.lightSelection);
    params.sphereLight = static_cast<std::uint32_t>(settings.sphereLight);
    params.quadLight = static_cast<std::uint32_t>(settings.quadLight);
    params.triangleLight = static_cast<std::uint32_t>(settings.triangleLight);
    params.samplerKind = static_cast<std::uint32_t>(settings.sampler);
    params.strataX = settings.sampler == SamplerKind::SobolBlue ? logOfBlock(settings) : strata(settings).x;
    params.strataY = strata(settings).y;
    if (connectsLights(scene, settings))
        params.connectedSpheres = static_cast<std::uint32_t>(scene.specularCasters.size());
    params.methods = methodsOf(scene, settings).methods;
    if (settings.russianRoulette) params.russianRoulette = rouletteOf(scene);
    return params;
}

std::uint32_t dependentSide(shared::Features features) {
    return shared::has(features, shared::kMethodReuse) ? shared::kReuseSide : 1u;
}

bool mayHaveEdges(const scene::CompiledScene& scene, const RenderSettings& settings) {
    return settings.edgeRays && scattersWidely(scene) && scene::mayHaveSilhouettes(scene);
}

scene::Silhouettes splitAtEdges(const scene::CompiledScene& scene, const shared::Camera& camera,
                                const RenderSettings& settings, shared::RenderParams& params) {
    params.edgeRays = 0;
    if (!mayHaveEdges(scene, settings)) return {};
    scene::Silhouettes edges = scene::findSilhouettes(scene, camera, settings.width, settings.height);
    const double share = static_cast<double>(edges.count) / settings.width / settings.height;
    std::uint32_t rays = kRaysAtEdge;
    while (rays > 0 && rays * share > kMaxEdgeRays) rays /= 2;
    if (edges.count == 0 || rays < 2) return {};
    params.edgeRays = rays;
    return edges;
}

bool isAdaptive(const RenderSettings& settings) {
    return settings.adaptive && settings.sampler != SamplerKind::Stratified && image::pilotSamples(settings.spp) > 0;
}

bool isMadeForSpp(const RenderSettings& settings) {
    const bool hasStrata = settings.sampler == SamplerKind::Stratified || settings.sampler == SamplerKind::SobolBlue;
    return isAdaptive(settings) || (hasStrata && settings.sppIsKnown);
}

void settleReplicates(RenderSettings& settings) {
    if (isAdaptive(settings)) settings.replicates += settings.replicates % 2;
}

image::FilmDesc filmDesc(const RenderSettings& settings) {
    const bool adaptive = isAdaptive(settings);
    return {settings.width, settings.height, settings.replicates, settings.secondMoments && !adaptive, adaptive};
}

shared::Features renderFeatures(const scene::CompiledScene& scene, const scene::CameraDesc& camera,
                                const RenderSettings& settings) {
    // The camera may have been given another lens than the scene's.
    shared::Features features = scene.features & ~shared::kFeatureThinLens;
    if (camera.defocusAngle > 0) features |= shared::kFeatureThinLens;
    // Mirrors, glass and emitters alone leave light sampling nothing to do.
    if (!scattersWidely(scene)) features &= ~kLightSampling;
    return features | methodsOf(scene, settings) | settings.features.value_or(shared::kFeatureNone);
}

std::string describeLightShapes(const RenderSettings& settings, shared::Features features) {
    std::string text;
    const auto describe = [&](shared::Features feature, ShapeSampling method, const char* shape, const char* solidAngle,
                              const char* strategies) {
        if (!shared::has(features, feature)) return;
        const char* used = method == ShapeSampling::Area        ? "area"
                           : method == ShapeSampling::Auto      ? strategies
                           : method == ShapeSampling::Projected ? "projected (of surfaces, unless tiny)"
                                                                : solidAngle;
        text += (text.empty() ? "" : ", ") + std::string(shape) + ": " + used;
    };
    if (settings.lightSampling == LightSampling::Bsdf) return "none";
    describe(shared::kFeatureSphereLights, settings.sphereLight, "sphere", "cone",
             "auto (nearly projected, cone when far)");
    describe(shared::kFeatureQuadLights, settings.quadLight, "quad", "solid-angle",
             "auto (area when far, strip when thin, else solid-angle by the cosine)");
    // There are no projected ones.
    const bool isRoundProjected = settings.quadLight == ShapeSampling::Projected;
    const ShapeSampling roundLight = isRoundProjected ? ShapeSampling::SolidAngle : settings.quadLight;
    describe(shared::kFeatureDiskLights, roundLight, "disk", "solid-angle",
             "auto (area when far, else solid-angle by the cosine)");
    describe(shared::kFeatureCylinderLights, roundLight, "cylinder", "solid-angle", "auto (solid-angle by the cosine)");
    describe(shared::kFeatureTriangleLights, settings.triangleLight, "triangle", "solid-angle",
             "auto (area when far, else solid-angle)");
    const bool isProjected = settings.sphereLight == ShapeSampling::Projected; // there are no projected ellipsoids
    describe(shared::kFeatureEllipsoidLights, isProjected ? ShapeSampling::Auto : settings.sphereLight, "ellipsoid",
             "cone", "cone");
    return text.empty() ? "none" : text;
}

} // namespace rt::app
