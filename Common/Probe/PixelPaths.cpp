#include "Common/Probe/PixelPaths.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "Common/Probe/NextHit.h"
#include "Common/Render/RenderParams.h"
#include "Common/Scene/CameraRecord.h"
#include "Common/Scene/Silhouettes.h"
#include "Common/Shared/Technique/EdgeRays.h"

namespace rt::probe {

using namespace rt::shared;

PixelPaths::PixelPaths(const SceneFormulas& scene, const scene::CameraDesc& camera, std::uint32_t x, std::uint32_t y) {
    const scene::CompiledScene& s = *scene.compiled();
    const app::RenderSettings& settings = scene.options().settings;
    render_ = {&scene, app::renderFeatures(s, camera, settings), scene.params(),
               scene::makeCamera(camera, settings.width, settings.height, s.origin)};
    const scene::Silhouettes silhouettes = app::splitAtEdges(s, render_.camera, settings, render_.params);
    const std::uint32_t side = app::dependentSide(render_.features), left = x / side * side, top = y / side * side;
    for (std::uint32_t row = top; row < std::min(top + side, settings.height); ++row)
        for (std::uint32_t column = left; column < std::min(left + side, settings.width); ++column) {
            if (column == x && row == y) own_ = group_.size();
            group_.push_back({column, row});
            const std::size_t pixel = std::size_t{row} * settings.width + column;
            edges_.push_back(render_.params.edgeRays > 0 ? silhouettes.parts[pixel] : 0u);
        }
}

std::optional<shared::vec3> PixelPaths::seen() const {
    const shared::vec2 middle(0.5f, 0.5f);
    const uvec2 pixel(group_[own_].x, group_[own_].y), size(render_.params.width, render_.params.height);
    const Ray ray = generateCameraRay(kFeatureAll, render_.camera, pixel, size, middle, middle, 0.0f);
    const Hit hit = nextHit(*render_.scene, kFeatureNone, ray, {}, 0u, kInfinity);
    if (hit.t < 0.0f) return std::nullopt;
    return render_.scene->toWorld(ray.origin + ray.direction * hit.t);
}

bool PixelPaths::sharesPaths() const {
    return reusesPaths(render_.features, render_.params);
}

Sampler PixelPaths::samplerOf(const Pixel& pixel, std::uint32_t sample) const {
    const std::uint32_t of = replicates();
    return makeSampler(render_.params, pixel.y * render_.params.width + pixel.x, sample % of, sample / of);
}

std::uint32_t PixelPaths::edgePart(const Pixel& pixel) const {
    const auto at = std::ranges::find_if(group_, [&](const Pixel& p) { return p.x == pixel.x && p.y == pixel.y; });
    return edges_[static_cast<std::size_t>(std::distance(group_.begin(), at))];
}

PathRecord PixelPaths::ownPath(const Pixel& pixel, const Sampler& sampler) const {
    CameraSamples u = cameraSamples(render_.features, sampler);
    const std::uint32_t packed = edgePart(pixel);
    const CameraRole role = packed != 0u ? roleInPart(render_.params, pixelPart(packed), false, u.pixel) : wholePixel();
    const Ray ray = cameraRay(render_.features, render_.params, render_.camera, uvec2(pixel.x, pixel.y), u);
    return recordPath(render_, sampler, startInRole(ray, role));
}

// Sums in the order of the CPU engine: path, connections, what is shared, edge rays.
TracedSample PixelPaths::trace(std::uint32_t sample) const {
    std::vector<PathRecord> group;
    for (const Pixel& pixel : group_) {
        const bool isWanted = sharesPaths() || (pixel.x == group_[own_].x && pixel.y == group_[own_].y);
        group.push_back(isWanted ? ownPath(pixel, samplerOf(pixel, sample)) : PathRecord{});
        group.back().shared.radiance += group.back().connectedBehind;
    }
    TracedSample traced;
    PathRecord& own = group[own_];
    traced.radiance = own.radiance + own.connected;
    traced.found = std::move(own.found);
    if (sharesPaths()) addShared(group, own_, traced);
    if (edges_[own_] != 0u) addEdgeRays(samplerOf(group_[own_], sample), traced);
    return traced;
}

// ---- edge rays -----------------------------------------------------------------------------------------------------

void PixelPaths::addEdgeRays(const Sampler& sampler, TracedSample& traced) const {
    const PixelPart part = pixelPart(edges_[own_]);
    shared::vec3 sum(0.0f);
    for (std::uint32_t i = 0; i < render_.params.edgeRays; ++i) {
        const Sampler numbers = edgeSampler(render_.params, sampler, i);
        CameraSamples u = cameraSamples(render_.features, numbers);
        const CameraRole role = roleInPart(render_.params, part, true, u.pixel);
        const uvec2 pixel(group_[own_].x, group_[own_].y);
        const Ray ray = cameraRay(render_.features, render_.params, render_.camera, pixel, u);
        PathRecord record = recordPath(render_, numbers, startInRole(ray, role));
        sum += record.radiance;
        std::ranges::move(record.found, std::back_inserter(traced.found));
    }
    traced.radiance += sum;
}

// ---- what is shared ------------------------------------------------------------------------------------------------

float PixelPaths::densityFrom(const SharedEnd& path, const SharedEnd& suffix, bool isItself) const {
    const float density = reuseDensity(path.first, path.firstNormal, suffix.second, suffix.secondNormal);
    if (isItself) return max(density, kMinReuseDensity);
    if (density == 0.0f) return 0.0f;
    float tMax;
    const Ray ray = reuseRay(path.first, suffix.second, tMax);
    return nextHit(*render_.scene, kFeatureNone, ray, {}, 0u, tMax).t < 0.0f ? density : 0.0f;
}

float PixelPaths::ratioOf(const SharedEnd& path, const shared::vec3& place) const {
    if (!aimsPaths(render_.features, render_.params)) return 1.0f;
    const AimedSphere& sphere = render_.scene->view().globals.aimed;
    return aimedRatioTowards(sphere, path.first, path.firstNormal, path.aimed, place);
}

// What the group's second vertices send to the first vertex of `own`.
void PixelPaths::addShared(const std::vector<PathRecord>& group, std::size_t own, TracedSample& traced) const {
    const SharedEnd& self = group[own].shared;
    if (!sharesVertex(self.reuse)) return;
    shared::vec3 received(0.0f);
    for (std::size_t j = 0; j < group.size(); ++j) {
        const SharedEnd& suffix = group[j].shared;
        if (suffix.reuse != kReuseSuffix || !(maxComponent(suffix.radiance) > 0.0f)) continue;
        float density = 0, sum = 0; // from this pixel's first vertex, and of those with which the second was drawn
        for (std::size_t k = 0; k < group.size(); ++k) {
            const SharedEnd& path = group[k].shared;
            if (!sharesVertex(path.reuse)) continue;
            const float from = densityFrom(path, suffix, k == j);
            sum += from * ratioOf(path, suffix.second);
            if (k == own) density = from;
        }
        const float share = density / sum;
        received += suffix.radiance * share;
        if (share == 0.0f) continue;
        for (const FoundLight& behind : group[j].behind) {
            FoundLight found = behind;
            found.radiance *= self.throughput * share;
            found.throughput *= self.throughput;
            if (j != own) {
                const auto& points = group[own].points;
                found.technique = Technique::SharedPath;
                found.from = {static_cast<int>(group_[j].x) - static_cast<int>(group_[own].x),
                              static_cast<int>(group_[j].y) - static_cast<int>(group_[own].y)};
                found.bounces += static_cast<std::uint32_t>(self.firstPoint - suffix.firstPoint);
                found.line.assign(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(self.firstPoint) + 1);
                found.line.insert(found.line.end(),
                                  behind.line.begin() + static_cast<std::ptrdiff_t>(suffix.firstPoint) + 1,
                                  behind.line.end());
            }
            traced.found.push_back(std::move(found));
        }
    }
    traced.radiance += self.throughput * received;
}

} // namespace rt::probe
