#include "Common/Probe/PathRecord.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "Common/Probe/NextHit.h"
#include "Common/Shared/Path/PathStep.h"
#include "Common/Shared/Technique/EdgeRayPaths.h"

namespace rt::probe {

using namespace rt::shared;

namespace {

bool isAny(const shared::vec3& light) {
    return maxComponent(light) > 0.0f || !isFinite(light);
}

float ratioOf(const shared::vec3& part, const shared::vec3& whole) {
    return maxComponent(whole) > 0.0f ? maxComponent(part) / maxComponent(whole) : 1.0f;
}

// A path under way.
class Recording {
  public:
    Recording(const TracedRender& render, const Sampler& sampler, const PathState& begin)
        : scene_(*render.scene),
          view_(scene_.view()),
          features_(render.features),
          params_(render.params),
          sampler_(sampler),
          path_(begin) {
        add(path_.ray.origin, PointKind::Camera);
    }

    PathRecord trace() {
        while (step()) {
        }
        record_.shared.reuse = reusesPaths(features_, params_) ? path_.reuse : kReuseNone;
        const bool isShared = record_.shared.reuse == kReuseSuffix;
        (isShared ? record_.shared.radiance : record_.radiance) = path_.radiance;
        return std::move(record_);
    }

  private:
    bool step() {
        const PathState before = path_;
        const Hit hit = nextHit(scene_, features_, path_.ray, sampler_, 2u * path_.vertex, kInfinity);
        DirectLight direct = noDirectLight();
        TechniqueStep step = beginTechniqueStep();
        const bool goesOn = stepPath(features_, view_, params_, sampler_, hit, path_, direct, step);
        if (path_.reuse != before.reuse) keepShared(step.part);
        recordVertex(before, hit, direct);
        if (direct.distance > 0.0f) traceShadow(direct);
        traceConnection(step.connection);
        if (goesOn && path_.pdf > 0.0f) hasScattered_ = true;
        return goesOn;
    }

    // ---- what is shared --------------------------------------------------------------------------------------------

    void keepShared(const SharedPart& part) {
        SharedEnd& kept = record_.shared;
        if (path_.reuse == kReuseFirst) {
            const bool aims = aimsPaths(features_, params_);
            kept.first = path_.last.position;
            kept.firstNormal = path_.last.normal;
            kept.aimed = aims ? part.aimed : 0.0f;
            kept.throughput = aims ? part.throughput : path_.throughput;
            kept.firstPoint = record_.points.size(); // that recordVertex() adds
        } else if (path_.reuse == kReuseSuffix) {
            kept.second = path_.last.position;
            kept.secondNormal = path_.last.normal;
            record_.radiance = part.prefix;
        }
    }

    std::vector<FoundLight>& listOf(const PathState& path) {
        return path.reuse == kReuseSuffix ? record_.behind : record_.found;
    }

    // ---- light -----------------------------------------------------------------------------------------------------

    // What the step found in a state `before`: the same stages once more, from there.
    void recordVertex(const PathState& before, const Hit& hit, const DirectLight& direct) {
        PathState arriving = before;
        arriving.radiance = shared::vec3(0.0f);
        TechniqueStep step = beginTechniqueStep();
        Vertex v;
        const bool arrives = shadeHit(features_, view_, params_, sampler_, hit, arriving, step, v);
        const bool isSecond = arriving.reuse == kReuseSuffix && before.reuse != kReuseSuffix;
        recordEmission(before, hit, isSecond ? step.part.prefix : arriving.radiance);
        if (!arrives) return;
        completeVertex(features_, view_, v);
        const bool isSpecular = isDeltaVertex(features_, v);
        const PointKind kind = v.inMedium != 0u ? PointKind::Medium
                               : isSpecular     ? PointKind::Specular
                                                : PointKind::Surface;
        add(v.position, kind, v.inMedium != 0u ? kNone : makeSurface(features_, view_, before.ray, hit).material);
        atVertex_ = arriving;
        recordSample(arriving, v, direct);
    }

    Technique techniqueOf(const PathState& before) const {
        if (isEdgeRay(features_, before)) return Technique::EdgeRay;
        if (!hasScattered_) return Technique::Seen;
        if (before.pdf == 0.0f) return Technique::BehindSpecular;
        return params_.lightSampling == kSampleMixture ? Technique::Mixture : Technique::Scattering;
    }

    void recordEmission(const PathState& before, const Hit& hit, const shared::vec3& radiance) {
        if (!isAny(radiance)) return;
        FoundLight found = begin(techniqueOf(before), before.vertex, radiance);
        found.throughput = before.throughput;
        found.directionPdf = before.pdf;
        shared::vec3 emitted;
        if (hit.t < 0.0f) {
            found.isSky = true;
            found.light = view_.globals.skyLight;
            emitted = skyRadiance(features_, view_, before.ray.direction);
            found.line.push_back(pointInSky(before.ray.origin, before.ray.direction));
        } else {
            const Surface surface = makeSurface(features_, view_, before.ray, hit);
            const Material material = loadMaterial(view_, surface.material);
            PathState absorbed = before;
            if (isPrincipled(features_, material)) absorbInside(view_, surface, hit.t, absorbed);
            found.throughput = absorbed.throughput;
            found.light = surface.light;
            emitted = surfaceEmission(features_, view_, material, surface);
            found.line.push_back({scene_.toWorld(surface.position), PointKind::Light, surface.material});
            askLights(before, surface, hit.t, found);
        }
        if (found.isSky) askSky(before, found);
        found.weight = ratioOf(radiance, found.throughput * emitted);
        listOf(before).push_back(std::move(found));
    }

    bool isWeighed(const PathState& before, const FoundLight& found) const {
        return has(features_, kFeatureLights) && found.light != kNone && usesMis(params_) && before.pdf > 0.0f;
    }
    float selectionOf(const PathState& before, uint light) const {
        return lightProbability(features_, view_, params_.lightSelection, view_.globals.lightCount, light, before.last);
    }
    void askLights(const PathState& before, const Surface& surface, float distance, FoundLight& found) const {
        if (!isWeighed(before, found)) return;
        found.selection = selectionOf(before, found.light);
        found.lightPdf =
            shared::lightPdf(features_, params_, loadLight(view_, found.light), before.last.position,
                             before.last.normal, before.ray.time, before.ray.direction, distance, surface.normal);
    }
    void askSky(const PathState& before, FoundLight& found) const {
        if (!isWeighed(before, found) || !has(features_, kFeatureSkyImage)) return;
        found.selection = selectionOf(before, found.light);
        found.lightPdf = skyPdf(view_, before.ray.direction);
    }

    // The light that was chosen and sampled at v, before its shadow ray is traced.
    void recordSample(PathState arriving, const Vertex& v, const DirectLight& direct) {
        sampled_ = {};
        if (!isAny(direct.radiance)) return;
        const VertexSamples u = vertexSamples(features_, sampler_, v.index);
        const shared::vec2 selection = lightSelectionSample(features_, params_, view_.globals, u);
        const LightChoice choice =
            chooseLight(features_, view_, params_.lightSelection, view_.globals.lightCount, selection, arriving.last);
        const Light light = loadLight(view_, choice.light);
        const LightSample sample = sampleChosenLight(features_, view_, params_, light, v, arriving.ray.time,
                                                     positionSample(features_, view_.globals, choice, u));
        const bool isPoint = isPunctual(features_, light);
        const Technique technique = isEdgeRay(features_, arriving) ? Technique::EdgeRay : Technique::LightSampling;
        sampled_ = begin(technique, v.index + 1u, direct.radiance);
        sampled_.throughput = arriving.throughput;
        sampled_.light = choice.light;
        sampled_.isSky = light.kind == kLightSky;
        sampled_.selection = choice.probability;
        sampled_.lightPdf = isPoint ? 0.0f : sample.pdf;
        sampled_.directionPdf = isPoint ? 0.0f : evalScattering(features_, v, sample.wi).w;
        if (!isPoint) sampled_.weight = emissionWeight(params_, choice.probability * sample.pdf, sampled_.directionPdf);
        sampled_.line.push_back(sample.distance < kInfinity
                                    ? PathPoint{scene_.toWorld(sample.point), PointKind::Light, light.material}
                                    : pointInSky(v.position, sample.wi));
        if (direct.distance == 0.0f) listOf(path_).push_back(sampled_);
    }

    void traceShadow(const DirectLight& direct) {
        const Ray ray = shadowRay(path_, direct);
        const Hit occluder = nextHit(scene_, features_, ray, sampler_, 2u * path_.vertex + 1u, direct.distance);
        if (occluder.t >= 0.0f) return;
        addDirectLight(features_, view_, direct, path_);
        sampled_.radiance = direct.radiance * rayTransmittance(features_, view_, ray, direct.distance);
        listOf(path_).push_back(sampled_);
    }

    void traceConnection(SpecularConnection connection) {
        if (connection.segments == 0u) return;
        const auto crossings = static_cast<std::uint32_t>(std::popcount(connection.segments)) - 1u;
        FoundLight found = begin(Technique::Connection, atVertex_.vertex + crossings, {});
        found.throughput = atVertex_.throughput;
        found.weight = 0;
        found.line.push_back({scene_.toWorld(connection.entry[0]), PointKind::Specular});
        if ((connection.segments & kSegmentAgain) != 0u)
            found.line.push_back({scene_.toWorld(connection.bounce), PointKind::Specular});
        if ((connection.segments & kSegmentInside) != 0u)
            found.line.push_back({scene_.toWorld(connection.leave[1]), PointKind::Specular});
        found.line.push_back({scene_.toWorld(connection.end), PointKind::Light});
        while (connection.segments != 0u) {
            float tMax;
            const Ray ray = connectionRay(connection, path_.ray.time, tMax);
            const bool isFree = nextHit(scene_, features_, ray, sampler_, 0u, tMax).t < 0.0f;
            endSegment(features_, view_, isFree, ray, tMax, connection, found.radiance);
        }
        if (!isAny(found.radiance)) return;
        (path_.reuse == kReuseSuffix ? record_.connectedBehind : record_.connected) += found.radiance;
        listOf(path_).push_back(std::move(found));
    }

    // ---- points ----------------------------------------------------------------------------------------------------

    void add(const shared::vec3& position, PointKind kind, std::uint32_t material = kNone) {
        record_.points.push_back({scene_.toWorld(position), kind, material});
    }
    // With the line up to here.
    FoundLight begin(Technique technique, std::uint32_t bounces, const shared::vec3& radiance) const {
        FoundLight found;
        found.technique = technique;
        found.bounces = bounces;
        found.radiance = radiance;
        found.line = record_.points;
        return found;
    }
    PathPoint pointInSky(const shared::vec3& from, const shared::vec3& direction) const {
        const auto size = static_cast<float>(glm::length(scene_.compiled()->upper - scene_.compiled()->lower));
        return {scene_.toWorld(from + direction * std::max(size, 1.0f)), PointKind::Sky, kNone};
    }

    const SceneFormulas& scene_;
    const SceneView& view_;
    const Features features_;
    const RenderParams& params_;
    const Sampler& sampler_;
    PathState path_, atVertex_{}; // now, and when it had arrived at its last vertex
    PathRecord record_;
    FoundLight sampled_;
    bool hasScattered_ = false;
};

} // namespace

PathRecord recordPath(const TracedRender& render, const Sampler& sampler, const PathState& begin) {
    return Recording(render, sampler, begin).trace();
}

} // namespace rt::probe
