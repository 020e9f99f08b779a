// The paths of a packet are those of stepPath() alone, bit for bit: shaders compile its text, too.
#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Accel/CpuAccel.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/Render/RenderParams.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"
#include "Common/Scene/CameraRecord.h"
#include "Common/Scene/CompiledScene.h"
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
        const accel::AccelInput input{s.spheres,   s.sphereMotions, s.quads,    s.positions,
                                      s.triangles, s.geometries,    s.instances};
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

    std::shared_ptr<const scene::CompiledScene> compiled;
    std::unique_ptr<const accel::CpuAccel> accel;
    std::array<float, 256> linear{};
    CpuScene view;
};

vec3 tracePath(const KernelContext& context, const Sampler& smp, uvec2 pixel, KernelCounters& counters) {
    const CpuScene& scene = *context.scene;
    PathState path =
        startPath(cameraRay(kFeatureAll, context.params, context.camera, pixel, cameraSamples(kFeatureAll, smp)));
    vec3 connected(0.0f); // summed apart, as packets do
    for (bool goesOn = true; goesOn;) {
        DirectLight direct = noDirectLight();
        TechniqueStep step = beginTechniqueStep();
        const Hit hit = traceRay<kFeatureAll>(scene, smp, 2u * path.vertex, path.ray);
        goesOn = stepPath(kFeatureAll, scene, context.params, smp, hit, path, direct, step);
        while (step.connection.segments != 0u) {
            ++counters.shadow;
            float tMax;
            const Ray ray = connectionRay(step.connection, path.ray.time, tMax);
            endSegment(kFeatureAll, scene, !isOccluded(scene, ray, tMax), ray, tMax, step.connection, connected);
        }
        if (!(direct.distance > 0.0f)) continue;
        ++counters.shadow;
        const Ray shadow = shadowRay(path, direct);
        if (traceRay<kFeatureAll>(scene, smp, 2u * path.vertex + 1u, shadow, direct.distance).t < 0.0f) {
            addDirectLight(kFeatureAll, scene, direct, path);
        }
    }
    counters.scattered += std::min(path.vertex, context.params.maxDepth) - 1u;
    return path.radiance + connected;
}

std::vector<vec3> traceOneByOne(const KernelContext& context, const TileTask& task, KernelCounters& counters) {
    std::vector<vec3> radiances;
    for (uint y = task.y; y < task.y + task.height; ++y) {
        for (uint x = task.x; x < task.x + task.width; ++x) {
            for (uint i = 0; i < task.count; ++i) {
                const Sampler smp =
                    makeSampler(context.params, y * context.params.width + x, task.replicate, task.first + i);
                radiances.push_back(tracePath(context, smp, uvec2(x, y), counters));
            }
        }
    }
    return radiances;
}

bool hasSameBits(vec3 a, vec3 b) {
    const auto same = [](float x, float y) { return std::bit_cast<uint>(x) == std::bit_cast<uint>(y); };
    return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
}

void comparePaths(const TracedScene& scene, const app::RenderSettings& settings) {
    KernelContext context = scene.context(settings);
    context.params.methods &= ~kMethodReuse.methods; // which has a test of its own
    TileTask tasks[2];
    tasks[0].x = 11;
    tasks[0].y = 17;
    tasks[0].width = 7;
    tasks[0].height = 6;
    tasks[0].first = 3;
    tasks[0].count = 5; // a batch of camera rays belongs to several pixels, and one to both tiles
    tasks[1] = tasks[0];
    tasks[1].x = 2;
    tasks[1].width = 3;
    tasks[1].replicate = 1;
    KernelCounters expectedCounters;
    std::vector<vec3> expected = traceOneByOne(context, tasks[0], expectedCounters);
    const std::vector<vec3> others = traceOneByOne(context, tasks[1], expectedCounters);
    expected.insert(expected.end(), others.begin(), others.end());
    KernelCounters counters;
    std::vector<vec3> radiances(expected.size(), vec3(-1.0f));
    ASSERT_TRUE(PathPacket<kFeatureAll>(context, tasks, nullptr, radiances.data(), counters).trace());
    for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_TRUE(hasSameBits(radiances[i], expected[i])) << i;
    EXPECT_EQ(counters.scattered, expectedCounters.scattered);
    EXPECT_EQ(counters.shadow, expectedCounters.shadow);
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
            settings.specularConnections = connections;
            comparePaths(scene, settings);
            if (::testing::Test::HasFatalFailure()) return;
        }
    }
}

// Short tables and a tree of lights, media, targets, metal, glass, thin lens, sky; principled surfaces and layers;
// instances; a sky image.
TEST(PathPacket, PathsAreThoseOfStepPath) {
    for (const char* id : {"cornell-box-lights", "next-week-cornell-smoke", "rest-of-life-cornell-box-glass",
                           "next-week-final", "one-weekend-final", "many-lights:200", "veach-mis",
                           RT_TEST_DATA_DIR "/scenes/principled.json", RT_TEST_DATA_DIR "/scenes/lacquer.json",
                           RT_TEST_DATA_DIR "/scenes/glass-instances.json", RT_TEST_DATA_DIR "/scenes/sun.json"}) {
        const TracedScene scene(id);
        SCOPED_TRACE(id);
        compareEstimators(scene);
        if (HasFatalFailure()) return;
    }
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
