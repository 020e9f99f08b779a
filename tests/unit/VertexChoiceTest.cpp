// What a path chooses at a vertex before it scatters there: the side of a surface that transmits diffusely, the colour
// channel where glass disperses.
#include <cmath>

#include <gtest/gtest.h>

#include "Common/Shared/Path/VertexChoice.h"
#include "tests/unit/DirectionCells.h"
#include "tests/unit/PrincipledSurfaces.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using test::kUp;
using test::Mean;
using test::principledOf;
using test::principledTables;

Vertex translucentVertex(const Principled& p, const vec3& albedo, const vec3& wo) {
    Surface surface{};
    surface.tangent = vec4(1, 0, 0, 1);
    Vertex v{};
    v.index = 2;
    v.front = 1;
    v.bsdf.kind = kMaterialPrincipled;
    v.bsdf.albedo = albedo;
    v.bsdf.lobes = noLobes();
    v.normal = v.shading = kUp;
    v.wo = wo;
    v.position = vec3(1, 2, 3);
    v.error = vec3(1e-6f);
    v.origin = offsetOrigin(v.position, v.error, v.normal, v.normal);
    v.values = principledValues(kFeatureAll, principledTables(p.ior), p, surface);
    addRareValues(kFeatureAll, principledTables(p.ior), p, surface, kUp, 1, v.values);
    return v;
}

PathState pathOf(const vec3& throughput) {
    PathState s{};
    s.throughput = throughput;
    return s;
}

// The mean of what paths go on with is what the surface scatters to each side, and the lights there are in sight.
TEST(VertexChoice, BothSidesGetWhatIsScatteredThere) {
    const vec3 albedo(0.3f, 0.5f, 0.2f), color(1, 0.6f, 0.1f), throughput(0.5f, 1, 2);
    for (const float share : {0.1f, 0.6f, 1.0f}) {
        test::PrincipledCase leaf{};
        leaf.beyond = share;
        leaf.sheen = 0.2f;
        Principled p = principledOf(leaf, 0.4f);
        p.diffuseTransmissionColor.color = color;
        const vec3 wo = test::outgoingAt(0.5);
        const vec3 above = normalize(vec3(0.3f, -0.2f, 0.5f)), below(above.x, above.y, -above.z);
        const vec4 reflected = evalPrincipledReflection(kFeatureAll, test::bsdfOf(p, albedo, wo).lobes, wo, above);
        const vec3 transmitted = test::bsdfOf(p, albedo, wo, true, kUp, true).lobes.diffuse * (above.z * kInvPi);
        Mean here, beyond;
        Sampler smp{};
        smp.kind = kSamplerIndependent;
        for (smp.index = 0; smp.index < 20000; ++smp.index) {
            Vertex v = translucentVertex(p, albedo, wo);
            PathState s = pathOf(throughput);
            chooseSide(kFeatureAll, smp, s, v);
            completeVertex(kFeatureAll, principledTables(p.ior), v);
            const bool isBeyond = v.values.rare.isBeyond != 0;
            ASSERT_EQ(v.normal.z < 0, isBeyond);
            ASSERT_EQ(v.origin.z < v.position.z, isBeyond);
            ASSERT_GT(dot(v.wo, v.shading), 0);
            here.add(double((s.throughput * vec3(evalScattering(kFeatureAll, v, above))).y));
            beyond.add(double((s.throughput * vec3(evalScattering(kFeatureAll, v, below))).x));
            const BsdfSample b = sampleScattering(kFeatureAll, v, vec2(0.3f, 0.7f));
            ASSERT_EQ(b.transmitted, 0u);
            if (isBeyond) {
                ASSERT_LT(b.wi.z, 0);
            }
        }
        EXPECT_TRUE(test::agrees(here, double(throughput.y * reflected.y))) << share;
        EXPECT_TRUE(test::agrees(beyond, double(throughput.x * transmitted.x))) << share;
    }
}

// Nothing is drawn, and nothing changes, where nothing is transmitted so.
TEST(VertexChoice, OpaqueSurfacesHaveOneSide) {
    const Vertex before = translucentVertex(principledOf({"dielectric"}, 0.4f), vec3(0.5f), test::outgoingAt(0.5));
    Vertex v = before;
    PathState s = pathOf(vec3(1));
    chooseSide(kFeatureAll, Sampler{}, s, v);
    EXPECT_EQ(s.throughput, vec3(1));
    EXPECT_EQ(v.wo, before.wo);
    EXPECT_EQ(v.normal, before.normal);
    EXPECT_EQ(v.values.rare.isBeyond, 0u);
}

// Every channel keeps its mean, and has its own index and table; a path of one channel keeps it.
TEST(VertexChoice, ChannelsKeepTheirMeans) {
    Principled p = principledOf({"glass", 0, 1}, 0.3f);
    p.channelIor = vec3(1.4f, 1.5f, 1.7f);
    p.channelGlass = uvec3(100, 200, 300);
    SceneArraysOf<std::vector> arrays;
    arrays.principled = {p};
    const SceneView scene = viewOf(arrays, {});
    const Vertex before = translucentVertex(p, vec3(1), test::outgoingAt(0.5));
    Sampler smp{};
    smp.kind = kSamplerIndependent;
    for (const vec3& throughput : {vec3(1), vec3(0.5f, 0, 2), vec3(0, 0, 3), vec3(0, 0.1f, 0)}) {
        Mean means[3];
        for (smp.index = 0; smp.index < 20000; ++smp.index) {
            Vertex v = before;
            PathState s = pathOf(throughput);
            chooseChannel(kFeatureAll, scene, smp, 0, s, v);
            int left = 0;
            for (int c = 0; c < 3; ++c) {
                means[c].add(double(s.throughput[c]));
                if (s.throughput[c] == 0) continue;
                ++left;
                ASSERT_EQ(v.values.ior, p.channelIor[c]);
                ASSERT_EQ(v.values.glass, p.channelGlass[c]);
            }
            ASSERT_EQ(left, 1);
        }
        for (int c = 0; c < 3; ++c) EXPECT_TRUE(test::agrees(means[c], double(throughput[c]))) << c;
    }
}

} // namespace
} // namespace rt::shared
