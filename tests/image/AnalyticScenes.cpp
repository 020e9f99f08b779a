#include "tests/image/AnalyticScenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

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

SceneDesc floorInWhiteSky(const MaterialDesc& material, double cosine) {
    SceneDesc desc = emptyScene({4 * std::sqrt(1 - cosine * cosine), 4 * cosine, 0}, {0, 0, 0}, 1e-3);
    desc.background = ConstantBackground{glm::dvec3(1)};
    desc.materials["floor"] = material;
    desc.objects.push_back({QuadDesc{{-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, "floor"}});
    return desc;
}

SceneDesc ballOnFloor(HugeFloor floor, double halfSize, double x) {
    const dvec3 up = glm::normalize(dvec3(1, 7, -2)), contact(3, -2, 5);
    const dvec3 along = glm::normalize(glm::cross(up, dvec3(0.2, 0.3, 0.7))), across = glm::cross(along, up);
    const dvec3 seen = contact + along * x;
    SceneDesc desc = emptyScene(seen + along * 3.0 + up * (2.4 * x), seen, 1e-3);
    desc.background = ConstantBackground{dvec3(1)};
    desc.materials["floor"] = lambertian(1);
    desc.materials["ball"] = lambertian(0);
    desc.objects.push_back({SphereDesc{contact + up, 1, {}, "ball"}});
    const dvec3 u = across * (2 * halfSize), v = along * (2 * halfSize);
    const dvec3 corner = contact - 0.47 * u - 0.52 * v;
    if (floor == HugeFloor::Triangles) {
        MeshData mesh;
        mesh.positions = {corner, corner + u, corner + u + v, corner + v};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        desc.objects.push_back({MeshDesc{mesh, "floor"}});
    } else if (floor == HugeFloor::Quad) {
        desc.objects.push_back({QuadDesc{corner, u, v, "floor"}});
    } else {
        GroupDesc group;
        const double angle = std::acos(up.y) * 180 / pi;
        group.transform = {Translate{{0.1 * halfSize, 0, 0.2 * halfSize}},
                           Rotate{glm::cross(dvec3(0, 1, 0), up), angle}, Translate{contact}};
        group.objects.push_back({BoxDesc{{-halfSize, -halfSize, -halfSize}, {halfSize, 0, halfSize}, "floor"}});
        desc.objects.push_back({group});
    }
    return desc;
}

// All of the ball is above the horizon: its form factor is 1 / (1 + x^2)^(3/2).
double skyBesideBall(double x) {
    return 1 - std::pow(1 + x * x, -1.5);
}

MaterialDesc whiteSheen(double roughness) {
    MaterialDesc m;
    m.kind = MaterialKind::Principled;
    m.principled.roughness.factor = 0.8;
    m.principled.sheenColor = glm::dvec3(1);
    m.principled.sheenRoughness.factor = roughness;
    return m;
}

MaterialDesc roughGlass(double ior, double roughness) {
    MaterialDesc m;
    m.kind = MaterialKind::Principled;
    m.principled.transmission.factor = 1;
    m.principled.ior = ior;
    m.principled.roughness.factor = roughness;
    return m;
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

std::vector<ObjectDesc> punctualLights() {
    const dvec3 intensity(3, 2, 1), position(1, 2, -0.5);
    const dvec3 aside = glm::normalize(-position) + dvec3(0.1, 0, 0.2); // within the edge of these spots
    return {{PointLightDesc{position, intensity}},
            {SpotLightDesc{position, -2.0 * position, intensity, 5, 6}},
            {SpotLightDesc{position, aside, intensity, 0, 30}},
            {SpotLightDesc{position, aside, intensity, 8, 40}},
            {SpotLightDesc{position, aside, intensity, 89, 90}},
            {DirectionalLightDesc{{-1, -3, 0.5}, intensity}},
            {DirectionalLightDesc{{1, -0.01, 0}, intensity}}};
}

std::vector<ObjectDesc> manyPunctualLights(std::uint32_t count) {
    std::vector<ObjectDesc> objects;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double turn = 2.4 * i; // radians, never the same
        const dvec3 around(std::cos(turn), 0, std::sin(turn));
        const dvec3 color = 0.1 * dvec3(1 + i % 2, 1 + i % 3, 1 + i % 5);
        const dvec3 position = (0.5 + 0.1 * i) * around + dvec3(0, i % 7 == 0 ? -1.0 : 1 + i % 4, 0);
        if (i % 11 == 5)
            objects.push_back({DirectionalLightDesc{around - dvec3(0, i % 2, 0), color}});
        else if (i % 3 == 1)
            objects.push_back({SpotLightDesc{position, around * (i % 2 ? 0.3 : -0.3) - position, 9.0 * color, 10, 30}});
        else
            objects.push_back({PointLightDesc{position, color}});
    }
    return objects;
}

SceneDesc floorUnder(const std::vector<ObjectDesc>& lights) {
    SceneDesc desc = floorScene();
    desc.camera.lookFrom = {0.3, 4, 0.5};
    desc.objects = {{QuadDesc{{-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, "floor"}}};
    desc.objects.insert(desc.objects.end(), lights.begin(), lights.end());
    return desc;
}

dvec3 punctualIrradiance(const std::vector<ObjectDesc>& objects) {
    dvec3 sum(0);
    const auto add = [&sum](const dvec3& position, const dvec3& intensity) {
        const double d = glm::length(position);
        sum += intensity * std::max(position.y, 0.0) / (d * d * d);
    };
    for (const ObjectDesc& object : objects) {
        if (const auto* point = std::get_if<PointLightDesc>(&object.shape)) add(point->position, point->intensity);
        if (const auto* sun = std::get_if<DirectionalLightDesc>(&object.shape))
            sum += sun->irradiance * std::max(-glm::normalize(sun->direction).y, 0.0);
        if (const auto* spot = std::get_if<SpotLightDesc>(&object.shape)) {
            // As in the text of KHR_lights_punctual.
            const double inner = std::cos(spot->innerAngle * pi / 180), outer = std::cos(spot->outerAngle * pi / 180);
            const double cosine = glm::dot(glm::normalize(spot->direction), glm::normalize(-spot->position));
            const double ramp = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
            add(spot->position, spot->intensity * ramp * ramp);
        }
    }
    return sum;
}

// Black, but for what it emits to both sides.
MaterialDesc clearLamp(double opacity) {
    MaterialDesc m;
    m.kind = MaterialKind::Principled;
    m.albedo = dvec3(0);
    m.emission = dvec3(3, 2, 1);
    m.sides = Sides::Both;
    m.principled.specular.factor = 0;
    m.principled.roughness.factor = 1;
    m.principled.opacity.factor = opacity;
    return m;
}

std::vector<ClearLamp> clearLamps() {
    std::vector<ClearLamp> lamps;
    const auto add = [&lamps](const char* what, MaterialDesc material, ObjectDesc object,
                              double formFactor) -> SceneDesc& {
        SceneDesc desc = floorScene();
        desc.materials["light"] = std::move(material);
        desc.objects.push_back(std::move(object));
        lamps.push_back({what, std::move(desc), formFactor});
        return lamps.back().desc;
    };
    const ObjectDesc quad{QuadDesc{{-1, 1.5, 0}, {2, 0, 0}, {0, 0, 0.9}, "light"}};
    const std::array<dvec3, 4> outline{dvec3(-1, 1.5, 0), dvec3(1, 1.5, 0), dvec3(1, 1.5, 0.9), dvec3(-1, 1.5, 0.9)};
    const double whole = polygonIrradiance(outline);
    add("quad", clearLamp(0.3), quad, 0.3 * whole);

    MaterialDesc cut = clearLamp(0.3);
    cut.principled.alphaCutoff = 0.25;
    add("quad above its cutoff", cut, quad, whole);
    cut.principled.alphaCutoff = 0.35;
    add("quad below its cutoff", cut, quad, 0);

    // The quad is in two cubes of the checker, an even one at the left and an odd one.
    MaterialDesc half = clearLamp(1);
    half.principled.opacity.texture = "half";
    const std::array<dvec3, 4> right{dvec3(0, 1.5, 0), outline[1], outline[2], dvec3(0, 1.5, 0.9)};
    const CheckerTexture checker{1, dvec3(0), dvec3(1)};
    add("quad of textured opacity", half, quad, polygonIrradiance(right)).textures["half"] = checker;
    half.principled.opacity.factor = 0.6;
    half.principled.alphaCutoff = 0.5;
    add("the same with a cutoff", half, quad, polygonIrradiance(right)).textures["half"] = checker;

    MeshData triangle;
    triangle.positions = {{-1, 0.8, 0.3}, {1.2, 1.1, 0.1}, {0.2, 0.9, -1.4}};
    triangle.triangles = {{0, 1, 2}};
    triangle.colors.assign(3, glm::dvec4(1, 1, 1, 0.4));
    add("triangle of clear vertex colours", clearLamp(0.5), {MeshDesc{triangle, "light"}},
        0.2 * polygonIrradiance(triangle.positions));

    // Light of the far side comes through the near one.
    const dvec3 center(0.5, 2, 0);
    const double distance = glm::length(center);
    const double disk = pi * (0.64 / (distance * distance)) * center.y / distance;
    add("sphere", clearLamp(0.5), {SphereDesc{center, 0.8, {}, "light"}}, 0.75 * disk);
    add("triangle that is clear by its vertex colours alone", clearLamp(1), {MeshDesc{triangle, "light"}},
        0.4 * polygonIrradiance(triangle.positions));
    return lamps;
}

} // namespace rt::test
