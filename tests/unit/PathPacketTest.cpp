// The paths of a packet are those of stepPath() alone, bit for bit: shaders compile its text, too.
#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Accel/CpuAccel.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Render/RenderParams.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/CameraRecord.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/Silhouettes.h"
#include "Common/Shared/Technique/EdgeRays.h"
#include "Common/Shared/Texture/Color.h"
#include "RayTracingCPU/PathPacket.h"
#include "tests/ConnectedScene.h"

namespace rt::cpu {
namespace {

constexpr uint kSide = 40;

// A scene as the engine prepares it.
struct TracedScene {
    explicit TracedScene(const std::string& id) : TracedScene(app::loadScene(id)) {}
    explicit TracedScene(const scene::SceneDesc& desc)
        : compiled(test::connectedThroughAll(*app::compile(desc, true, true))) {
        const scene::CompiledScene& s = *compiled;
        const accel::AccelInput input{s.spheres,   s.sphereMotions, s.quads,     s.positions,
                                      s.triangles, s.geometries,    s.instances, s.rounds};
        accel = accel::CpuAccel::build(input, {}, nullptr);
        view = CpuScene{viewOf(s, s.globals), accel->view(), {}};
        for (uint byte = 0; byte < 256; ++byte) linear[byte] = srgbToLinear(float(byte) / 255.0f);
        view.srgbToLinear = linear.data();
        view.tracer = accel::rayQuery().tracer(view.accel.kinds);
    }

    KernelContext context(const app::RenderSettings& settings) const {
        const Camera camera = scene::makeCamera(compiled->camera, settings.width, settings.height, compiled->origin);
        return {&view, app::makeRenderParams(*compiled, settings), camera};
    }

    // As context(), with edge rays.
    KernelContext contextWithEdges(const app::RenderSettings& settings, scene::Silhouettes& edges) const {
        KernelContext result = context(settings);
        edges = app::splitAtEdges(*compiled, result.camera, settings, result.params);
        if (result.params.edgeRays > 0u) result.edges = edges.parts.data();
        return result;
    }

    std::shared_ptr<const scene::CompiledScene> compiled;
    std::unique_ptr<const accel::CpuAccel> accel;
    std::array<float, 256> linear{};
    CpuScene view;
};

// The samples of tasks, one by one: their paths and edge rays by stepPath() alone.
class OneByOne {
  public:
    OneByOne(const KernelContext& context, std::span<const TileTask> tasks) : context_(context), shared_(context) {
        for (const TileTask& task : tasks) add(task);
        for (uint i = 0; i < radiances.size(); ++i) {
            radiances[i] += connected_[i].before;
            shared_.add(i, connected_[i].behind);
        }
        shared_.finish(tasks, radiances.data(), counters);
        for (std::size_t i = 0; i < radiances.size(); ++i) radiances[i] += ofEdgeRays_[i];
    }

    std::vector<vec3> radiances;
    KernelCounters counters;

  private:
    // What connections bring, summed apart as packets do: behind the second vertex of a path that is shared, and
    // before.
    struct Connected {
        vec3 before = vec3(0.0f);
        vec3 behind = vec3(0.0f);
    };

    void add(const TileTask& task) {
        for (uint y = task.y; y < task.y + task.height; ++y) {
            for (uint x = task.x; x < task.x + task.width; ++x) {
                for (uint i = 0; i < task.count; ++i)
                    add(makeSampler(context_.params, pixelIndex(x, y), task.replicate, task.first + i), uvec2(x, y));
            }
        }
    }

    void add(const Sampler& smp, uvec2 pixel) {
        const RenderParams& params = context_.params;
        const CameraSamples u = cameraSamples(kFeatureAll, smp);
        PathState path = startPath(cameraRay(kFeatureAll, params, context_.camera, pixel, u));
        vec3 ofEdgeRays(0.0f);
        if (const uint packed = context_.edgePart(pixelIndex(pixel.x, pixel.y)); packed != 0u) {
            const PixelPart part = pixelPart(packed);
            if (isInPart(part, u.pixel)) path.emission = kEmissionApart;
            for (uint i = 0; i < params.edgeRays; ++i)
                ofEdgeRays += traceEdgeRay(edgeSampler(params, smp, i), pixel, part);
        }
        ofEdgeRays_.push_back(ofEdgeRays);
        radiances.emplace_back(0.0f);
        connected_.emplace_back();
        trace(smp, path);
    }

    vec3 traceEdgeRay(const Sampler& smp, uvec2 pixel, const PixelPart& part) {
        CameraSamples u = cameraSamples(kFeatureAll, smp);
        const CameraRole role = roleInPart(context_.params, part, true, u.pixel);
        PathState path = startInRole(cameraRay(kFeatureAll, context_.params, context_.camera, pixel, u), role);
        ++counters.edge;
        for (bool goesOn = true; goesOn;) {
            TechniqueStep step = beginTechniqueStep();
            goesOn = stepFurther(smp, path, step);
            counters.scattered += goesOn ? 1u : 0u;
            EXPECT_EQ(step.connection.segments, 0u);
        }
        return path.radiance;
    }

    // The path of the last sample.
    void trace(const Sampler& smp, PathState path) {
        const uint sample = static_cast<uint>(radiances.size()) - 1u;
        for (bool goesOn = true; goesOn;) {
            const uint before = path.reuse;
            TechniqueStep step = beginTechniqueStep();
            goesOn = stepFurther(smp, path, step);
            if (path.reuse != before) keepVertex(sample, before, path, step.part);
            const bool isBehind = path.reuse == kReuseSuffix;
            traceConnection(step.connection, path, isBehind ? connected_[sample].behind : connected_[sample].before);
        }
        if (isCutOff(context_.params, path))
            counters.cutOff += cutOffThroughput(path, shared_.throughputBefore(sample, path));
        counters.scattered += std::min(path.vertex, context_.params.maxDepth) - 1u;
        shared_.ended(sample, path, radiances[sample]);
    }

    bool stepFurther(const Sampler& smp, PathState& path, TechniqueStep& step) {
        const CpuScene& scene = *context_.scene;
        DirectLight direct = noDirectLight();
        const Hit hit = traceRay(kFeatureAll, scene, smp, 2u * path.vertex, path.ray);
        const bool goesOn = stepPath(kFeatureAll, scene, context_.params, smp, hit, path, direct, step);
        if (!(direct.distance > 0.0f)) return goesOn;
        ++counters.shadow;
        const Ray shadow = shadowRay(path, direct);
        const bool arrives = traceRay(kFeatureAll, scene, smp, 2u * path.vertex + 1u, shadow, direct.distance).t < 0.0f;
        if (arrives) addDirectLight(kFeatureAll, scene, direct, path);
        return goesOn;
    }

    void traceConnection(SpecularConnection connection, const PathState& path, vec3& sum) {
        const CpuScene& scene = *context_.scene;
        while (connection.segments != 0u) {
            ++counters.shadow;
            float tMax;
            const Ray ray = connectionRay(connection, path.ray.time, tMax);
            endSegment(kFeatureAll, scene, !isOccluded(scene, ray, tMax), ray, tMax, connection, sum);
        }
    }

    // Of the vertex from which the path goes on, as GPUs know it.
    void keepVertex(uint sample, uint before, PathState path, const SharedPart& part) {
        Vertex v{};
        v.origin = path.last.position;
        v.normal = path.last.normal;
        v.bsdf.albedo = vec3(1.0f);
        const bool aims = aimsPaths(kFeatureAll, context_.params);
        if (aims) path.throughput = part.throughput;
        shared_.arrived(sample, before, path, part.prefix, v, radiances[sample]);
        if (aims && path.reuse == kReuseFirst) shared_.aimed(sample, part.aimed);
    }

    uint pixelIndex(uint x, uint y) const { return y * context_.params.width + x; }

    const KernelContext& context_;
    SharedPaths<kFeatureAll> shared_;
    std::vector<Connected> connected_;
    std::vector<vec3> ofEdgeRays_;
};

// Rays of techniques that have been compared, so that none is left out in silence.
KernelCounters seen;

bool hasSameBits(vec3 a, vec3 b) {
    const auto same = [](float x, float y) { return std::bit_cast<uint>(x) == std::bit_cast<uint>(y); };
    return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
}

// The upper left corner of the part of the image in which most pixels are split at edges.
uvec2 cornerOfMostEdges(const KernelContext& context, uint width, uint height) {
    uvec2 best(11, 17);
    uint maximum = 0;
    for (uint y = 0; y + height <= kSide; ++y) {
        for (uint x = 0; x + width <= kSide; ++x) {
            uint count = 0;
            for (uint i = 0; i < width * height; ++i)
                count += context.edgePart((y + i / width) * kSide + x + i % width) != 0u ? 1 : 0;
            if (count > maximum) best = uvec2(x, y);
            maximum = std::max(maximum, count);
        }
    }
    return best;
}

void comparePaths(const TracedScene& scene, const app::RenderSettings& settings) {
    scene::Silhouettes edges;
    const KernelContext context = scene.contextWithEdges(settings, edges);
    TileTask tasks[2];
    tasks[0].width = 7;
    tasks[0].height = 6;
    const uvec2 corner = cornerOfMostEdges(context, tasks[0].width, tasks[0].height);
    tasks[0].x = corner.x;
    tasks[0].y = corner.y;
    tasks[0].first = 3;
    tasks[0].count = 5; // a batch of camera rays belongs to several pixels, and one to both tiles
    tasks[1] = tasks[0];
    tasks[1].x = 2;
    tasks[1].width = 3;
    tasks[1].replicate = 1;
    const OneByOne expected(context, tasks);
    KernelCounters counters;
    std::vector<vec3> radiances(expected.radiances.size(), vec3(-1.0f));
    ASSERT_TRUE(PathPacket<kFeatureAll>(context, tasks, nullptr, radiances.data(), counters).trace());
    for (std::size_t i = 0; i < radiances.size(); ++i)
        ASSERT_TRUE(hasSameBits(radiances[i], expected.radiances[i])) << i;
    EXPECT_EQ(counters.scattered, expected.counters.scattered);
    EXPECT_EQ(counters.shadow, expected.counters.shadow);
    EXPECT_EQ(counters.edge, expected.counters.edge);
    EXPECT_EQ(counters.reuse, expected.counters.reuse);
    EXPECT_NEAR(counters.cutOff, expected.counters.cutOff, 1e-9 * (1 + expected.counters.cutOff));
    seen.edge += counters.edge;
    seen.reuse += counters.reuse;
}

app::RenderSettings smallImage() {
    app::RenderSettings settings;
    settings.width = settings.height = kSide;
    settings.spp = 16;
    return settings;
}

void compareEstimators(const TracedScene& scene) {
    for (uint estimator : {kSampleBsdf, kSampleMixture, kSampleMis, kSampleMisBalance}) {
        SCOPED_TRACE("estimator " + std::to_string(estimator));
        app::RenderSettings settings = smallImage();
        settings.lightSampling = static_cast<decltype(settings.lightSampling)>(estimator);
        for (const bool connections : {false, true}) {
            for (const bool sharesAndSplits : {false, true}) {
                SCOPED_TRACE(std::to_string(connections) + std::to_string(sharesAndSplits));
                settings.specularConnections = connections;
                settings.pathReuse = sharesAndSplits ? app::PathReuse::On : app::PathReuse::Off;
                settings.edgeRays = sharesAndSplits;
                comparePaths(scene, settings);
                if (::testing::Test::HasFatalFailure()) return;
            }
        }
    }
}

// Without and with shared paths and edge rays. Short tables and a tree of lights, media, targets, metal, glass, thin
// lens, sky; principled surfaces and layers; instances; a sky image.
TEST(PathPacket, PathsAreThoseOfStepPath) {
    seen = {};
    for (const char* id :
         {"cornell-box-lights", "next-week-cornell-smoke", "rest-of-life-cornell-box-glass", "next-week-final",
          "one-weekend-final", "many-lights:200", "veach-mis", RT_TEST_DATA_DIR "/scenes/principled.json",
          RT_TEST_DATA_DIR "/scenes/lacquer.json", RT_TEST_DATA_DIR "/scenes/gltf-extensions.json",
          RT_TEST_DATA_DIR "/scenes/glass-instances.json", RT_TEST_DATA_DIR "/scenes/sun.json",
          RT_TEST_DATA_DIR "/scenes/disks-and-cylinders.json"}) {
        const TracedScene scene(id);
        SCOPED_TRACE(id);
        compareEstimators(scene);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(seen.edge, 0u);
    EXPECT_GT(seen.reuse, 0u);
}

// Beside a lamp, and in a medium.
TEST(PathPacket, WithPunctualLights) {
    for (const char* id : {"cornell-box-lights", "next-week-cornell-smoke"}) {
        scene::SceneDesc desc = scene::findBuiltinScene(id);
        desc.objects.push_back({scene::PointLightDesc{{200, 300, 100}, glm::dvec3(3e4)}});
        desc.objects.push_back({scene::SpotLightDesc{{300, 500, 300}, {0.1, -1, 0}, glm::dvec3(2e5), 10, 40}});
        desc.objects.push_back({scene::DirectionalLightDesc{{0.1, -0.5, 1}, glm::dvec3(0.5)}});
        SCOPED_TRACE(id);
        compareEstimators(TracedScene(desc));
        if (HasFatalFailure()) return;
    }
}

TEST(PathPacket, WithEverySamplerAndSelection) {
    const TracedScene scene("cornell-box-lights");
    for (uint sampler : {kSamplerIndependent, kSamplerStratified, kSamplerSobol, kSamplerSobolBlue}) {
        for (uint selection : {kSelectUniform, kSelectPower, kSelectContribution}) {
            SCOPED_TRACE("sampler " + std::to_string(sampler) + ", selection " + std::to_string(selection));
            app::RenderSettings settings = smallImage();
            settings.sampler = static_cast<decltype(settings.sampler)>(sampler);
            settings.lightSelection = static_cast<decltype(settings.lightSelection)>(selection);
            comparePaths(scene, settings);
            if (HasFatalFailure()) return;
        }
    }
}

TEST(PathPacket, CancelledPathsAreNotFinished) {
    const TracedScene scene("cornell-box-lights");
    const KernelContext context = scene.context(smallImage());
    const std::atomic<bool> cancel{true};
    TileTask task;
    task.width = task.height = task.count = 2;
    KernelCounters counters;
    vec3 radiances[8];
    EXPECT_FALSE(PathPacket<kFeatureAll>(context, {&task, 1}, &cancel, radiances, counters).trace());
}

} // namespace
} // namespace rt::cpu
