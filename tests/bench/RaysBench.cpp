// Rays per second of one thread, ours and Embree's (robust mode, single-ray calls), on the same rays in one run. The
// two take turns and medians are compared, so that a busy machine disturbs both alike.
//   rays-bench [REPEATS] [SCENE...]
#include <algorithm>
#include <cstdio>

#ifndef RT_HAS_EMBREE

int main() {
    std::puts("rays-bench compares with Embree 3, which this build has not found.");
    return 1;
}

#else

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <functional>

#include "Common/Accel/Traverse/RayQuery.h"
#include "tests/bench/AccelBenchScenes.h"

namespace rt::bench {
namespace {

using shared::Hit;
using shared::Ray;

constexpr int kSide = 512; // pixels of the image whose paths give the rays
constexpr int kTile = 8;

struct RaySet {
    std::string name;
    std::vector<Ray> rays;
    std::vector<float> ends; // of the intervals that any-hit asks for
};

float uniform(std::mt19937& random) {
    return static_cast<float>(random() >> 8) * 0x1p-24f;
}

std::vector<Ray> cameraRays(const BenchScene& s) {
    const vec3 forward = shared::normalize(s.target - s.eye);
    const vec3 right = shared::normalize(shared::cross(forward, vec3(0.0f, 1.0f, 0.0f)));
    const vec3 up = shared::cross(right, forward);
    const float reach = std::tan(s.fieldOfView * 0.5f * shared::kPi / 180.0f);
    std::vector<Ray> rays;
    for (int tile = 0; tile < (kSide / kTile) * (kSide / kTile); ++tile) {
        for (int pixel = 0; pixel < kTile * kTile; ++pixel) {
            const int x = tile % (kSide / kTile) * kTile + pixel % kTile;
            const int y = tile / (kSide / kTile) * kTile + pixel / kTile;
            const float a = (2.0f * (static_cast<float>(x) + 0.5f) / kSide - 1.0f) * reach;
            const float b = (1.0f - 2.0f * (static_cast<float>(y) + 0.5f) / kSide) * reach;
            rays.push_back({s.eye, shared::normalize(forward + a * right + b * up), 0.0f});
        }
    }
    return rays;
}

vec3 normalAt(const BenchScene& s, const Hit& hit, vec3 point) {
    if (hit.kind == shared::kSphere) return shared::normalize(point - s.spheres[hit.primitive].center);
    const shared::uvec3 t = s.triangles[hit.primitive];
    return shared::normalize(shared::cross(s.positions[t.y] - s.positions[t.x], s.positions[t.z] - s.positions[t.x]));
}

vec3 cosineDirection(vec3 normal, std::mt19937& random) {
    for (;;) {
        const vec3 v(2.0f * uniform(random) - 1.0f, 2.0f * uniform(random) - 1.0f, 2.0f * uniform(random) - 1.0f);
        const float squared = shared::dot(v, v);
        if (squared > 1.0f || squared < 1e-4f) continue;
        const vec3 d = normal + v / std::sqrt(squared);
        if (shared::dot(d, d) > 1e-6f) return shared::normalize(d);
    }
}

// Primary rays, one cosine-distributed bounce of each that hits, the same shuffled, and shadow rays to a point above.
std::vector<RaySet> makeRays(const BenchScene& s, const accel::AccelView& view) {
    std::vector<RaySet> sets(4);
    sets[0] = {"primary", cameraRays(s), {}};
    sets[1].name = "bounce";
    sets[2].name = "shuffled";
    sets[3].name = "shadow";
    std::vector<Hit> hits(sets[0].rays.size());
    const std::vector<float> ends(hits.size(), shared::kInfinity);
    accel::rayQuery().closest(view, sets[0].rays.data(), ends.data(), hits.data(), hits.size());
    std::mt19937 random(3);
    const vec3 light = s.target + vec3(0.7f, 1.9f, 1.1f) * shared::length(s.eye - s.target) * 0.5f;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (hits[i].t < 0.0f) continue;
        const Ray& ray = sets[0].rays[i];
        vec3 point = ray.origin + ray.direction * hits[i].t;
        vec3 normal = normalAt(s, hits[i], point);
        if (shared::dot(normal, ray.direction) > 0.0f) normal = -normal;
        const float radius = hits[i].kind == shared::kSphere ? s.spheres[hits[i].primitive].radius : 0.0f;
        point += normal * (32.0f * shared::kEpsilon * (2.0f * radius + hits[i].t + shared::length(point)));
        sets[1].rays.push_back({point, cosineDirection(normal, random), 0.0f});
        sets[3].rays.push_back({point, shared::normalize(light - point), 0.0f});
        sets[3].ends.push_back(shared::length(light - point));
    }
    sets[2].rays = sets[1].rays;
    std::shuffle(sets[2].rays.begin(), sets[2].rays.end(), random);
    for (RaySet& set : sets) {
        set.ends.resize(set.rays.size(), shared::kInfinity);
    }
    return sets;
}

void embreeClosest(RTCScene scene, const RaySet& set, std::vector<float>& t) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
        const Ray& r = set.rays[i];
        RTCRayHit query{};
        query.ray = {r.origin.x,  r.origin.y,  r.origin.z, 0.0f, r.direction.x, r.direction.y, r.direction.z, 0.0f,
                     set.ends[i], 0xffffffffu, 0,          0};
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene, &context, &query);
        t[i] = query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? -1.0f : query.ray.tfar;
    }
}

void embreeAny(RTCScene scene, const RaySet& set, std::vector<std::uint8_t>& hits) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
        const Ray& r = set.rays[i];
        RTCRay query{r.origin.x,  r.origin.y,  r.origin.z, 0.0f, r.direction.x, r.direction.y, r.direction.z, 0.0f,
                     set.ends[i], 0xffffffffu, 0,          0};
        rtcOccluded1(scene, &context, &query);
        hits[i] = query.tfar < 0.0f;
    }
}

// Of the processor, where the standard library measures it; this program has one thread.
double seconds(const std::function<void()>& work) {
    const std::clock_t start = std::clock();
    work();
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

void report(const std::string& scene, const std::string& what, std::size_t rays, const std::vector<double>& ours,
            const std::vector<double>& theirs, double differing) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < ours.size(); ++i) {
        ratios.push_back(theirs[i] / ours[i]);
    }
    const double millions = static_cast<double>(rays) * 1e-6;
    std::printf("%-12s %-17s %8.2f %8.2f %7.2f %12.1e\n", scene.c_str(), what.c_str(), millions / median(ours),
                millions / median(theirs), median(ratios), differing);
    std::fflush(stdout);
}

void compare(const BenchScene& scene, RTCDevice device, int repeats) {
    const auto accel = accel::CpuAccel::build(scene.input(), {});
    EmbreeScene embree(device, scene);
    embree.commit();
    for (const RaySet& set : makeRays(scene, accel->view())) {
        const std::size_t n = set.rays.size();
        std::vector<Hit> hits(n);
        std::vector<float> embreeT(n);
        std::vector<std::uint8_t> any(n), embreeHits(n);
        std::vector<double> ours[2], theirs[2];
        for (int i = 0; i < repeats; ++i) {
            ours[0].push_back(seconds(
                [&] { accel::rayQuery().closest(accel->view(), set.rays.data(), set.ends.data(), hits.data(), n); }));
            theirs[0].push_back(seconds([&] { embreeClosest(embree.get(), set, embreeT); }));
            ours[1].push_back(seconds(
                [&] { accel::rayQuery().any(accel->view(), set.rays.data(), set.ends.data(), any.data(), n); }));
            theirs[1].push_back(seconds([&] { embreeAny(embree.get(), set, embreeHits); }));
        }
        std::size_t different[2] = {0, 0};
        for (std::size_t i = 0; i < n; ++i) {
            different[0] += std::abs(hits[i].t - embreeT[i]) > 1e-4f * std::abs(embreeT[i]);
            different[1] += any[i] != embreeHits[i];
        }
        report(scene.name, set.name + ", closest", n, ours[0], theirs[0],
               static_cast<double>(different[0]) / static_cast<double>(n));
        report(scene.name, set.name + ", any", n, ours[1], theirs[1],
               static_cast<double>(different[1]) / static_cast<double>(n));
    }
}

} // namespace
} // namespace rt::bench

int main(int argc, char** argv) {
    using namespace rt::bench;
    const int repeats = argc > 1 ? std::max(1, std::atoi(argv[1])) : 7;
    const auto wanted = [&](const std::string& name) {
        return argc <= 2 || std::find(argv + 2, argv + argc, name) != argv + argc;
    };
    std::printf("One thread, %s, %s; Embree %s, robust. Median of %d.\n", rt::processorName(),
                rt::name(rt::bestInstructionSet()), RTC_VERSION_STRING, repeats);
    std::printf("%-12s %-17s %8s %8s %7s %12s\n", "scene", "rays", "ours M/s", "Embree", "ratio", "differing");
    RTCDevice device = rtcNewDevice("threads=1");
    if (wanted("mesh")) compare(meshScene(), device, repeats);
    if (wanted("spheres")) compare(sphereCloud(), device, repeats);
    if (wanted("one-weekend")) compare(oneWeekend(), device, repeats);
    rtcReleaseDevice(device);
}

#endif
