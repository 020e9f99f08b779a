#include "tests/image/AnalyticScenes.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace rt::test {

using namespace rt::scene;
using glm::dvec3;
using std::numbers::pi;

SceneDesc emptyScene(glm::dvec3 from, glm::dvec3 at, double fov) {
    SceneDesc desc;
    desc.id = "test";
    desc.camera.lookFrom = from;
    desc.camera.lookAt = at;
    desc.camera.verticalFov = fov;
    return desc;
}

MaterialDesc lambertian(double albedo, double emission) {
    MaterialDesc m;
    m.albedo = glm::dvec3(albedo);
    m.emission = glm::dvec3(emission);
    m.sides = Sides::Both;
    return m;
}

SceneDesc shell(bool box, double albedo, double emission) {
    SceneDesc desc = emptyScene({0.1, 0.2, 0.3}, {0.9, -0.1, -0.4}, 60);
    desc.materials["wall"] = lambertian(albedo, emission);
    if (box) {
        desc.objects.push_back({BoxDesc{glm::dvec3(-1), glm::dvec3(1), "wall"}});
    } else {
        desc.objects.push_back({SphereDesc{glm::dvec3(0), 1, {}, "wall"}});
    }
    return desc;
}

double enclosureRadiance(double albedo, double emission, int depth) {
    return emission * (1 - std::pow(albedo, depth)) / (1 - albedo);
}

SceneDesc inWhiteSky(const MaterialDesc& material) {
    SceneDesc desc = emptyScene({0, 0, 4}, {0, 0, 0}, 20);
    desc.background = ConstantBackground{glm::dvec3(1)};
    desc.materials["body"] = material;
    desc.objects.push_back({SphereDesc{glm::dvec3(0), 1, {}, "body"}});
    return desc;
}

SceneDesc floorScene() {
    SceneDesc desc = emptyScene({0.3, 0.5, 4}, {0, 0, 0}, 1e-3);
    MaterialDesc floor;
    floor.albedo = dvec3(kFloorAlbedo);
    desc.materials["floor"] = floor;
    MaterialDesc light;
    light.kind = MaterialKind::Emitter;
    light.emission = dvec3(3, 2, 1);
    light.sides = Sides::Both;
    desc.materials["light"] = light;
    desc.objects.push_back({QuadDesc{{-50, 0, 50}, {100, 0, 0}, {0, 0, -100}, "floor"}});
    return desc;
}

SceneDesc lampAlone(const Transform& transform, double distance) {
    const dvec3 from = glm::normalize(dvec3(0.3, 0.4, 0.9)) * distance;
    SceneDesc desc = emptyScene(from, {0, 0, 0}, 180 / pi * 2.4 / distance);
    desc.materials["lamp"] = lambertian(0.9, 1);
    GroupDesc group;
    group.transform = transform;
    group.objects.push_back({SphereDesc{dvec3(0), 1, {}, "lamp"}});
    desc.objects.push_back({group});
    return desc;
}

std::vector<Transform> lampTransforms() {
    const Rotate first{{1, 2, 3}, 50}, last{{3, 2, 1}, 70};
    return {{Scale{{1, 0.1, 0.01}}, first}, {first, Scale{{1, 0.1, -0.01}}, last}, {Scale{{1, 1, 0.01}}, first}};
}

double polygonIrradiance(std::span<const dvec3> vertices) {
    double sum = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const dvec3 a = glm::normalize(vertices[i]);
        const dvec3 b = glm::normalize(vertices[(i + 1) % vertices.size()]);
        const dvec3 n = glm::cross(a, b);
        sum += std::atan2(glm::length(n), glm::dot(a, b)) * n.y / glm::length(n);
    }
    return std::abs(sum) / 2;
}

} // namespace rt::test
