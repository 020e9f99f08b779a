#include "Common/App/Interactive/VisibleSurface.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <glm/common.hpp>

#include "Common/Scene/CameraRecord.h"
#include "Common/Shared/Camera.h"
#include "Common/Shared/Medium/Media.h"
#include "Common/Shared/Shape/Rounds.h"
#include "Common/Shared/Shape/Shapes.h"

namespace rt::app {

namespace {

constexpr float kTime = 0.5f;
constexpr std::uint64_t kMaxTests = 4'000'000; // of shapes: 20 ms or so

struct Box {
    shared::vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};
    void add(const shared::vec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
};

class Search {
  public:
    Search(const scene::CompiledScene& scene, const shared::Ray& ray) : scene_(scene), ray_(ray) {}

    std::optional<VisibleSurface> run() {
        if (!isWorthIt(scene_.geometries[0])) return std::nullopt;
        meet(scene_.geometries[0], ray_, nullptr);
        boxes_.resize(scene_.geometries.size());
        for (const shared::Instance& instance : scene_.instances) {
            const shared::Geometry& geometry = scene_.geometries[instance.geometry];
            std::optional<Box>& box = boxes_[instance.geometry];
            if (!box) {
                if (!isWorthIt(geometry)) return std::nullopt;
                box = boxOf(geometry);
            }
            const shared::Ray ray = inObject(instance);
            if (!mayMeet(ray, *box)) continue;
            if (!isWorthIt(geometry)) return std::nullopt;
            meet(geometry, ray, &instance);
        }
        return found_;
    }

  private:
    bool isWorthIt(const shared::Geometry& g) {
        tests_ += std::uint64_t{1} + g.sphereCount + g.quadCount + g.triangleCount + g.roundCount;
        return tests_ <= kMaxTests;
    }

    shared::vec3 centerOf(std::uint32_t sphere) const {
        const shared::vec3 center = scene_.spheres[sphere].center;
        return scene_.sphereMotions.empty() ? center
                                            : shared::sphereCenter(center, scene_.sphereMotions[sphere], kTime);
    }

    template <typename Visit>
    static void forEach(std::uint32_t first, std::uint32_t count, const Visit& visit) {
        for (std::uint32_t i = first; i < first + count; ++i) visit(i);
    }

    // `instance`: of the geometry; null: it is the world.
    void meet(const shared::Geometry& g, const shared::Ray& ray, const shared::Instance* instance) {
        const scene::Origins& origins = scene_.origins;
        const auto take = [&](float t, std::uint32_t own, const std::vector<scene::OriginRun>& runs, std::uint32_t i) {
            if (!(t > 0)) return;
            nearest_ = t;
            const bool isReplaced = instance != nullptr && instance->material != shared::kNone;
            const auto number = instance != nullptr ? instance - scene_.instances.data() : 0;
            found_ = {isReplaced ? instance->material : own, instance != nullptr
                                                                 ? origins.instances[static_cast<std::size_t>(number)]
                                                                 : scene::originOf(runs, i)};
        };
        forEach(g.firstSphere, g.sphereCount, [&](std::uint32_t i) {
            const shared::Sphere& sphere = scene_.spheres[i];
            const float inverseSquaredLength = 1.0f / shared::dot(ray.direction, ray.direction);
            take(shared::intersectSphere(ray, inverseSquaredLength, centerOf(i), sphere.radius, sphere.power, nearest_),
                 sphere.material, origins.spheres, i);
        });
        forEach(g.firstQuad, g.quadCount, [&](std::uint32_t i) {
            const shared::Quad& quad = scene_.quads[i];
            const shared::QuadFrame frame = shared::quadFrame(quad.edgeU, quad.edgeV);
            take(shared::intersectQuad(ray, quad.corner, frame, nearest_).t, quad.material, origins.quads, i);
        });
        forEach(g.firstRound, g.roundCount, [&](std::uint32_t i) {
            const shared::Round& r = scene_.rounds[i];
            const shared::RoundFrame frame = shared::roundFrame(r.edgeU, r.edgeV, r.axis);
            take(shared::intersectRound(ray, r.origin, frame, r.hole, nearest_), r.material, origins.rounds, i);
        });
        const shared::TriangleRay sheared = shared::makeTriangleRay(ray.direction);
        forEach(g.firstTriangle, g.triangleCount, [&](std::uint32_t i) {
            const shared::uvec3 t = scene_.triangles[i];
            const auto& p = scene_.positions;
            take(shared::intersectTriangle(ray.origin, sheared, p[t.x], p[t.y], p[t.z], nearest_).t,
                 scene_.meshes[scene_.triangleMesh[i]].material, origins.triangles, i);
        });
    }

    Box boxOf(const shared::Geometry& g) const {
        Box box;
        forEach(g.firstSphere, g.sphereCount, [&](std::uint32_t i) {
            box.add(centerOf(i) - scene_.spheres[i].radius);
            box.add(centerOf(i) + scene_.spheres[i].radius);
        });
        forEach(g.firstQuad, g.quadCount, [&](std::uint32_t i) {
            const shared::Quad& quad = scene_.quads[i];
            for (const shared::vec3& p : {quad.corner, quad.corner + quad.edgeU, quad.corner + quad.edgeV,
                                          quad.corner + quad.edgeU + quad.edgeV})
                box.add(p);
        });
        forEach(g.firstRound, g.roundCount, [&](std::uint32_t i) {
            const shared::Round& r = scene_.rounds[i];
            const shared::vec3 reach = shared::abs(r.edgeU) + shared::abs(r.edgeV);
            for (const shared::vec3& center : {r.origin, r.hole < 0 ? r.origin + r.axis : r.origin}) {
                box.add(center - reach);
                box.add(center + reach);
            }
        });
        forEach(g.firstTriangle, g.triangleCount, [&](std::uint32_t i) {
            for (int corner = 0; corner < 3; ++corner) box.add(scene_.positions[scene_.triangles[i][corner]]);
        });
        return box;
    }

    // The parameter t stays what it is.
    shared::Ray inObject(const shared::Instance& instance) const {
        shared::Ray ray = ray_;
        const auto& rows = instance.toObject;
        ray.origin = shared::transformPoint(rows[0], rows[1], rows[2], ray_.origin);
        ray.direction = shared::transformVector(rows[0], rows[1], rows[2], ray_.direction);
        return ray;
    }

    bool mayMeet(const shared::Ray& ray, const Box& box) const {
        constexpr float kRounding = 1e-5f;
        float enter = 0, leave = nearest_;
        for (int axis = 0; axis < 3; ++axis) {
            const float inverse = 1 / ray.direction[axis];
            const float a = (box.low[axis] - ray.origin[axis]) * inverse;
            const float b = (box.high[axis] - ray.origin[axis]) * inverse;
            if (!(a == a && b == b)) continue; // within a face of the box, which it runs along
            enter = std::max(enter, std::min(a, b) * (1 - kRounding));
            leave = std::min(leave, std::max(a, b) * (1 + kRounding));
        }
        return enter <= leave;
    }

    const scene::CompiledScene& scene_;
    const shared::Ray ray_;
    float nearest_ = std::numeric_limits<float>::max();
    std::optional<VisibleSurface> found_;
    std::vector<std::optional<Box>> boxes_; // by geometry
    std::uint64_t tests_ = 0;
};

} // namespace

std::optional<VisibleSurface> visibleSurface(const scene::CompiledScene& scene, const scene::CameraDesc& camera,
                                             const glm::uvec2& size, const glm::uvec2& pixel) {
    const shared::Camera record = scene::makeCamera(camera, size.x, size.y, scene.origin);
    const shared::Ray ray = shared::generateCameraRay(shared::kFeatureNone, record, pixel, size, shared::vec2(0.5f),
                                                      shared::vec2(0.5f), kTime);
    return Search(scene, ray).run();
}

} // namespace rt::app
