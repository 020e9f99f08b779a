#include "tests/bench/EmbreeCeiling.h"

#include <utility>
#include <vector>

#include "Common/Image/Summary.h"

#ifndef RT_HAS_EMBREE

namespace rt::bench {

struct EmbreeRays::Data {};

std::optional<EmbreeRays> EmbreeRays::make(const scene::CompiledScene&) {
    return std::nullopt;
}

double EmbreeRays::trace(std::size_t) {
    return 0;
}

} // namespace rt::bench

#else

#include <algorithm>
#include <chrono>
#include <cstring>
#include <random>

#include <embree3/rtcore.h>

#include "Common/Core/Parallel.h"
#include "Common/Scene/CameraRecord.h"
#include "Common/Shared/Camera.h"

namespace rt::bench {
namespace {

using shared::Ray;
using shared::vec2;
using shared::vec3;

constexpr std::uint32_t kImageSide = 384; // pixels of the image whose paths give the rays
constexpr int kBounces = 3;
constexpr std::size_t kChunk = 4096; // rays that a thread takes at a time

template <auto release>
struct Release {
    template <class T>
    void operator()(T* object) const {
        release(object);
    }
};
using EmbreeDevice = std::unique_ptr<RTCDeviceTy, Release<rtcReleaseDevice>>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, Release<rtcReleaseScene>>;

template <class T>
void attach(RTCDevice device, RTCScene scene, RTCGeometryType type, RTCFormat vertexFormat,
            const std::vector<T>& vertices, RTCFormat indexFormat, const std::vector<std::uint32_t>& indices,
            std::size_t indicesEach) {
    if (vertices.empty() || (indicesEach > 0 && indices.empty())) return;
    RTCGeometry geometry = rtcNewGeometry(device, type);
    void* to = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, vertexFormat, sizeof(T), vertices.size());
    std::memcpy(to, vertices.data(), vertices.size() * sizeof(T));
    if (indicesEach > 0) {
        to = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, indexFormat,
                                     indicesEach * sizeof(std::uint32_t), indices.size() / indicesEach);
        std::memcpy(to, indices.data(), indices.size() * sizeof(std::uint32_t));
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

EmbreeScene makeScene(RTCDevice device, const scene::CompiledScene& s) {
    EmbreeScene scene(rtcNewScene(device));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    std::vector<shared::vec4> spheres;
    for (const shared::Sphere& sphere : s.spheres) spheres.emplace_back(sphere.center, sphere.radius);
    attach(device, scene.get(), RTC_GEOMETRY_TYPE_SPHERE_POINT, RTC_FORMAT_FLOAT4, spheres, {}, {}, 0);
    std::vector<vec3> corners;
    std::vector<std::uint32_t> indices;
    for (const shared::Quad& quad : s.quads) {
        for (std::uint32_t i = 0; i < 4; ++i) indices.push_back(static_cast<std::uint32_t>(corners.size()) + i);
        corners.insert(corners.end(), {quad.corner, quad.corner + quad.edgeU, quad.corner + quad.edgeU + quad.edgeV,
                                       quad.corner + quad.edgeV});
    }
    attach(device, scene.get(), RTC_GEOMETRY_TYPE_QUAD, RTC_FORMAT_FLOAT3, corners, RTC_FORMAT_UINT4, indices, 4);
    std::vector<std::uint32_t> triangles;
    for (const shared::uvec3& t : s.triangles) triangles.insert(triangles.end(), {t.x, t.y, t.z});
    attach(device, scene.get(), RTC_GEOMETRY_TYPE_TRIANGLE, RTC_FORMAT_FLOAT3, s.positions, RTC_FORMAT_UINT3, triangles,
           3);
    rtcCommitScene(scene.get());
    return scene;
}

RTCRayHit trace(RTCScene scene, const Ray& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = {ray.origin.x,
                 ray.origin.y,
                 ray.origin.z,
                 0.0f,
                 ray.direction.x,
                 ray.direction.y,
                 ray.direction.z,
                 0.0f,
                 shared::kInfinity,
                 0xffffffffu,
                 0,
                 0};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context, &query);
    return query;
}

// A ray from the hit into the half space that it came from.
Ray bounced(const Ray& ray, const RTCRayHit& hit, vec2 u) {
    vec3 normal = shared::normalize(vec3(hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z));
    if (shared::dot(normal, ray.direction) > 0.0f) normal = -normal;
    const vec3 point = ray.origin + ray.direction * hit.ray.tfar;
    const float gap = 1e-4f * (hit.ray.tfar + shared::length(point)); // rays of a yardstick need not be exact
    return {point + normal * gap, shared::toWorld(shared::makeFrame(normal), shared::sampleCosineHemisphere(u)), 0.0f};
}

// Path after path, 8x8 pixels together.
std::vector<Ray> makeRays(RTCScene embree, const scene::CompiledScene& scene) {
    const shared::Camera camera = scene::makeCamera(scene.camera, kImageSide, kImageSide, scene.origin);
    std::mt19937 random(1);
    const auto uniform = [&random] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < kImageSide * kImageSide; ++i) {
        const std::uint32_t tile = i / 64, inTile = i % 64;
        const shared::uvec2 pixel(tile % (kImageSide / 8) * 8 + inTile % 8, tile / (kImageSide / 8) * 8 + inTile / 8);
        Ray ray = shared::generateCameraRay(scene.features, camera, pixel, shared::uvec2(kImageSide),
                                            vec2(uniform(), uniform()), vec2(uniform(), uniform()), 0.0f);
        for (int bounce = 0; bounce <= kBounces; ++bounce) {
            rays.push_back(ray);
            const RTCRayHit hit = trace(embree, ray);
            if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) break;
            ray = bounced(ray, hit, vec2(uniform(), uniform()));
        }
    }
    return rays;
}

} // namespace

struct EmbreeRays::Data {
    EmbreeDevice device{rtcNewDevice(nullptr)};
    EmbreeScene scene;
    std::vector<Ray> rays;
    std::vector<float> distances;
};

std::optional<EmbreeRays> EmbreeRays::make(const scene::CompiledScene& scene) {
    if (!scene.instances.empty() || !scene.sphereMotions.empty()) return std::nullopt;
    auto data = std::make_unique<Data>();
    data->scene = makeScene(data->device.get(), scene);
    data->rays = makeRays(data->scene.get(), scene);
    data->distances.resize(data->rays.size());
    return EmbreeRays(std::move(data));
}

double EmbreeRays::trace(std::size_t threads) {
    const std::vector<Ray>& rays = data_->rays;
    const auto start = std::chrono::steady_clock::now();
    parallelFor(threads, (rays.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
        const std::size_t end = std::min((chunk + 1) * kChunk, rays.size());
        for (std::size_t i = chunk * kChunk; i < end; ++i)
            data_->distances[i] = bench::trace(data_->scene.get(), rays[i]).ray.tfar;
    });
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    return static_cast<double>(rays.size()) / seconds.count();
}

} // namespace rt::bench

#endif

namespace rt::bench {

EmbreeRays::EmbreeRays(std::unique_ptr<Data> data) : data_(std::move(data)) {}
EmbreeRays::EmbreeRays(EmbreeRays&&) noexcept = default;
EmbreeRays::~EmbreeRays() = default;

std::optional<double> embreeRaysPerSecond(const scene::CompiledScene& scene) {
    constexpr int kPasses = 5;
    std::optional<EmbreeRays> embree = EmbreeRays::make(scene);
    if (!embree) return std::nullopt;
    std::vector<double> rates(kPasses);
    for (double& rate : rates) rate = embree->trace(0);
    return image::median(rates);
}

} // namespace rt::bench
