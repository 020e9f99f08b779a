// The geometry on which we measure ourselves against Embree, made without any file, and the same geometry in Embree's
// hands.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <embree3/rtcore.h>

#include "Common/Accel/CpuAccel.h"

namespace rt::bench {

using shared::vec3;

struct BenchScene {
    std::string name;
    std::vector<shared::Sphere> spheres;
    std::vector<vec3> positions;
    std::vector<shared::uvec3> triangles;
    std::vector<shared::Geometry> geometries;
    vec3 eye;
    vec3 target;
    float fieldOfView; // vertical, degrees

    accel::AccelInput input() const { return {spheres, {}, {}, positions, triangles, geometries, {}}; }
    std::size_t primitives() const { return spheres.size() + triangles.size(); }
};

inline void finish(BenchScene& s) {
    s.geometries = {
        {0, static_cast<std::uint32_t>(s.spheres.size()), 0, 0, 0, static_cast<std::uint32_t>(s.triangles.size())}};
}

// A sphere with bumps of several sizes, about a million triangles in the order of its six faces, in a room.
inline BenchScene meshScene(int cells = 408) {
    BenchScene s;
    s.name = "mesh";
    s.eye = {0.0f, 0.3f, 2.6f};
    s.target = {0.0f, 0.0f, 0.0f};
    s.fieldOfView = 50.0f;
    for (int face = 0; face < 6; ++face) {
        const std::uint32_t first = static_cast<std::uint32_t>(s.positions.size());
        for (int j = 0; j <= cells; ++j) {
            for (int i = 0; i <= cells; ++i) {
                const float x = std::tan((2.0f * static_cast<float>(i) / static_cast<float>(cells) - 1.0f) * 0.785398f);
                const float y = std::tan((2.0f * static_cast<float>(j) / static_cast<float>(cells) - 1.0f) * 0.785398f);
                vec3 d(x, y, 1.0f);
                for (int turn = 0; turn < face % 3; ++turn) {
                    d = vec3(d.z, d.x, d.y);
                }
                d = shared::normalize(face < 3 ? d : -d);
                const float bumps = 0.08f * std::sin(9.0f * d.x) * std::sin(11.0f * d.y) * std::sin(7.0f * d.z + 1.0f) +
                                    0.015f * std::sin(47.0f * d.x + 3.0f * d.y) * std::sin(53.0f * d.z) +
                                    0.004f * std::sin(211.0f * d.y) * std::sin(197.0f * d.x + 2.0f);
                s.positions.push_back(d * (1.0f + bumps));
            }
        }
        const std::uint32_t row = static_cast<std::uint32_t>(cells) + 1;
        for (std::uint32_t j = 0; j + 1 < row; ++j) {
            for (std::uint32_t i = 0; i + 1 < row; ++i) {
                const std::uint32_t a = first + j * row + i;
                s.triangles.push_back({a, a + 1, a + row + 1});
                s.triangles.push_back({a, a + row + 1, a + row});
            }
        }
    }
    const std::uint32_t corner = static_cast<std::uint32_t>(s.positions.size());
    for (int i = 0; i < 8; ++i) {
        s.positions.push_back(vec3(i & 1 ? 3.0f : -3.0f, i & 2 ? 3.0f : -1.3f, i & 4 ? 3.0f : -3.0f));
    }
    const std::uint32_t sides[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                       {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    for (const auto& q : sides) {
        s.triangles.push_back({corner + q[0], corner + q[1], corner + q[2]});
        s.triangles.push_back({corner + q[0], corner + q[2], corner + q[3]});
    }
    finish(s);
    return s;
}

// Spheres of mixed size in a cube, with room between them.
inline BenchScene sphereCloud(int count = 500000) {
    BenchScene s;
    s.name = "spheres";
    s.eye = {0.0f, 0.0f, 1.3f};
    s.target = {0.0f, 0.0f, 0.0f};
    s.fieldOfView = 60.0f;
    std::mt19937 random(1);
    const auto uniform = [&] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
    const float spacing = 1.0f / std::cbrt(static_cast<float>(count));
    for (int i = 0; i < count; ++i) {
        const float x = uniform(), y = uniform(), z = uniform();
        s.spheres.push_back({2.0f * vec3(x, y, z) - vec3(1.0f), spacing * (0.2f + 0.6f * uniform()), 0, shared::kNone,
                             shared::kInfinity});
    }
    finish(s);
    return s;
}

// The layout of the cover of "Ray Tracing in One Weekend": 22 by 22 small spheres, three large ones, the ground.
inline BenchScene oneWeekend() {
    BenchScene s;
    s.name = "one-weekend";
    s.eye = {13.0f, 2.0f, 3.0f};
    s.target = {0.0f, 0.0f, 0.0f};
    s.fieldOfView = 20.0f;
    std::mt19937 random(2);
    const auto uniform = [&] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
    s.spheres.push_back({{0.0f, -1000.0f, 0.0f}, 1000.0f, 0, shared::kNone, 0.0f});
    for (int a = -11; a < 11; ++a) {
        for (int b = -11; b < 11; ++b) {
            const float x = static_cast<float>(a) + 0.9f * uniform();
            const float z = static_cast<float>(b) + 0.9f * uniform();
            if (shared::length(vec3(x, 0.2f, z) - vec3(4.0f, 0.2f, 0.0f)) > 0.9f) {
                s.spheres.push_back({{x, 0.2f, z}, 0.2f, 0, shared::kNone, shared::kInfinity});
            }
        }
    }
    for (const float x : {0.0f, -4.0f, 4.0f}) {
        s.spheres.push_back({{x, 1.0f, 0.0f}, 1.0f, 0, shared::kNone, shared::kInfinity});
    }
    finish(s);
    return s;
}

// The scene in Embree, as robust as ours.
class EmbreeScene {
  public:
    EmbreeScene(RTCDevice device, const BenchScene& s) : scene_(rtcNewScene(device)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_MEDIUM);
        if (!s.triangles.empty()) {
            RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
            copy(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, s.positions);
            copy(g, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, s.triangles);
            attach(g);
        }
        if (!s.spheres.empty()) {
            RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
            std::vector<shared::vec4> points;
            for (const shared::Sphere& sphere : s.spheres) {
                points.push_back({sphere.center, sphere.radius});
            }
            copy(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, points);
            attach(g);
        }
    }
    ~EmbreeScene() { rtcReleaseScene(scene_); }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    void commit() { rtcCommitScene(scene_); }
    RTCScene get() const { return scene_; }

  private:
    template <class T>
    void copy(RTCGeometry g, RTCBufferType type, RTCFormat format, const std::vector<T>& data) {
        std::memcpy(rtcSetNewGeometryBuffer(g, type, 0, format, sizeof(T), data.size()), data.data(),
                    data.size() * sizeof(T));
    }
    void attach(RTCGeometry g) {
        rtcCommitGeometry(g);
        rtcAttachGeometry(scene_, g);
        rtcReleaseGeometry(g);
    }

    RTCScene scene_;
};

inline double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

} // namespace rt::bench
