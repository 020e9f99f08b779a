// Scenes made for this project: hard or telling cases of light sampling, and two whose radiance is known.
#include <array>

#include <glm/geometric.hpp>

#include "Common/Scene/Builtin/BuiltinFamilies.h"
#include "Common/Scene/Builtin/SceneBuilder.h"

namespace rt::scene {

// After Veach 1997, figure 9.2: each plate mirrors the lights to the camera, more and more blurred towards the front;
// each light has the same power. Where plate and light are both small in angle light sampling fails, where both are
// large scattering does.
SceneDesc veachMis() {
    SceneDesc scene;
    const glm::dvec3 eye(0, 2.5, 15), middleOfLights(0, 4, -2);
    scene.camera = camera(eye, {0, 0.35, 0}, 33);
    scene.render.aspect = 4.0 / 3.0;
    scene.materials["wall"] = lambertian(0.4, 0.4, 0.4);
    addQuad(scene, {-20, -3, 20}, {40, 0, 0}, {0, 0, -28}, "wall");
    addQuad(scene, {-20, -3, -8}, {40, 0, 0}, {0, 28, 0}, "wall");

    const std::array<double, 4> radii = {0.05, 0.15, 0.45, 1.0}, fuzzes = {0.008, 0.03, 0.09, 0.25};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::string light = "light " + std::to_string(i + 1);
        scene.materials[light] = emitter(glm::dvec3(2.5 / (radii[i] * radii[i])));
        addSphere(scene, middleOfLights + glm::dvec3(-5 + 3.3 * static_cast<double>(i), 0, 0), radii[i], light);
    }
    for (std::size_t i = 0; i < 4; ++i) {
        const std::string plate = "plate " + std::to_string(i + 1);
        scene.materials[plate] = metal({0.85, 0.85, 0.85}, fuzzes[i]);
        const double step = static_cast<double>(i);
        const glm::dvec3 center(0, 0.6 - 0.75 * step, -2.6 + 2.1 * step);
        const glm::dvec3 normal =
            glm::normalize(glm::normalize(middleOfLights - center) + glm::normalize(eye - center));
        const glm::dvec3 along(1, 0, 0), deep = 1.35 * glm::cross(normal, along);
        addQuad(scene, center - 5.2 * along - 0.5 * deep, deep, 10.4 * along, plate);
    }
    scene.materials["lamp"] = emitter({0.35, 0.35, 0.35});
    addQuad(scene, {-6, 20, 14}, {12, 0, 0}, {0, 0, -12}, "lamp");
    return scene;
}

namespace {

constexpr int kPowerClasses = 8; // of many-lights, each twice as bright as the one before

// Lights of one class: a colour from warm to cool.
MaterialDesc classMaterial(int power, double scale) {
    const double t = power / double(kPowerClasses - 1);
    return emitter(scale * std::exp2(power) * glm::mix(glm::dvec3(1.0, 0.62, 0.3), glm::dvec3(0.55, 0.75, 1.0), t));
}

glm::dvec3 randomDirection(SceneRandom& random) {
    const double z = random.next(-1, 1), phi = random.next(0, 2 * 3.14159265358979323846);
    const double r = std::sqrt((1 - z) * (1 + z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

void addOccluders(SceneDesc& scene) {
    for (int i = -1; i <= 1; ++i)
        for (int j = 0; j <= 2; ++j) {
            if (i == 0 && j == 0) continue;
            const glm::dvec3 foot(24 * i, 0, 26 * j - 16);
            add(scene, box(foot - glm::dvec3(3, 0, 3), foot + glm::dvec3(3, 26 - 4 * j, 3), "white"));
        }
    addSphere(scene, {-10, 6, -18}, 6, "glass");
    addSphere(scene, {9, 5, -22}, 5, "metal");
    addSphere(scene, {0, 7, 6}, 7, "white");
}

} // namespace

// A room of 100 x 40 x 100 with columns. As many spheres as quads as triangles, which shrink as they become more and
// keep their total power; brightness spans 128 to 1.
SceneDesc manyLights(std::uint32_t count) {
    SceneDesc scene;
    scene.camera = camera({6, 13, -47}, {0, 9, 0}, 62);
    scene.render.aspect = 16.0 / 9.0;
    scene.materials = {
        {"white", lambertian(0.73, 0.73, 0.73)}, {"glass", glass(1.5)}, {"metal", metal({0.8, 0.7, 0.5}, 0.15)}};
    scene.materials["wall"] = lambertian(0.5, 0.42, 0.36);
    addRoom(scene, {-50, 0, -50}, {50, 40, 50}, "wall");
    addOccluders(scene);

    const double size = 4 / std::cbrt(double(count)); // edge or diameter
    std::array<SphereSetDesc, kPowerClasses> spheres;
    std::array<MeshData, kPowerClasses> triangles;
    SceneRandom random(6);
    for (int power = 0; power < kPowerClasses; ++power) {
        const std::string material = "light " + std::to_string(power);
        scene.materials[material] = classMaterial(power, 250 / (size * size * count));
        spheres[static_cast<std::size_t>(power)].radius = 0.5 * size;
        spheres[static_cast<std::size_t>(power)].material = material;
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto power = static_cast<std::size_t>(random.next() * kPowerClasses);
        const double x = random.next(-46, 46), y = random.next(12, 38);
        const glm::dvec3 center(x, y, random.next(-26, 46)); // none close to the camera
        const glm::dvec3 normal = randomDirection(random);
        const glm::dvec3 u =
            glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
        const glm::dvec3 v = glm::cross(normal, u);
        if (i % 3 == 0) {
            spheres[power].centers.push_back(center);
        } else if (i % 3 == 1) {
            addQuad(scene, center - 0.5 * size * (u + v), size * u, size * v, "light " + std::to_string(power));
        } else {
            MeshData& mesh = triangles[power];
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            mesh.positions.insert(mesh.positions.end(),
                                  {center + size * u, center + size * v, center - size * (u + v)});
            mesh.triangles.emplace_back(first, first + 1, first + 2);
        }
    }
    for (std::size_t power = 0; power < kPowerClasses; ++power) {
        if (!spheres[power].centers.empty()) add(scene, spheres[power]);
        if (!triangles[power].triangles.empty()) add(scene, mesh(triangles[power], "light " + std::to_string(power)));
    }
    return scene;
}

namespace {

// Letters of 5 x 7 cells as a mesh in the plane z = 0 that faces +Z, cells of edge 1, the lower left corner at the
// origin.
MeshData letters(const std::vector<std::array<const char*, 7>>& glyphs) {
    MeshData mesh;
    for (std::size_t glyph = 0; glyph < glyphs.size(); ++glyph)
        for (std::size_t row = 0; row < 7; ++row)
            for (std::size_t column = 0; column < 5; ++column) {
                if (glyphs[glyph][row][column] != '#') continue;
                const double x = static_cast<double>(6 * glyph + column), y = static_cast<double>(6 - row);
                const auto first = static_cast<std::uint32_t>(mesh.positions.size());
                mesh.positions.insert(mesh.positions.end(),
                                      {{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}});
                mesh.triangles.emplace_back(first, first + 1, first + 2);
                mesh.triangles.emplace_back(first, first + 2, first + 3);
            }
    return mesh;
}

const std::array<const char*, 7> kLetterR = {"####.", "#...#", "#...#", "####.", "#.#..", "#..#.", "#...#"};
const std::array<const char*, 7> kLetterT = {"#####", "..#..", "..#..", "..#..", "..#..", "..#..", "..#.."};

} // namespace

SceneDesc triangleLights() {
    SceneDesc scene;
    scene.camera = camera({0, 4.5, 16}, {0, 3, 0}, 38);
    scene.render.aspect = 16.0 / 9.0;
    scene.materials = {{"wall", lambertian(0.6, 0.6, 0.62)},
                       {"brick", lambertian(0.55, 0.2, 0.12)},
                       {"metal", metal({0.8, 0.8, 0.85}, 0.2)},
                       {"letters", emitter({9, 6.2, 3.2})},
                       {"lamp", emitter({4, 6, 9})},
                       {"glass", glass(1.5)}};
    addQuad(scene, {-12, 0, 12}, {24, 0, 0}, {0, 0, -18}, "wall");
    addQuad(scene, {-12, 0, -6}, {24, 0, 0}, {0, 14, 0}, "wall");
    GroupDesc sign;
    sign.transform = {Scale{glm::dvec3(0.42)}, Translate{{-6.2, 4.4, -5.2}}};
    sign.objects.push_back({mesh(letters({kLetterR, kLetterT, kLetterT}), "letters")});
    add(scene, sign);
    GroupDesc lamp;
    lamp.transform = {Scale{glm::dvec3(1.1)}, Translate{{4.2, 4.6, -1.5}}};
    lamp.objects.push_back({mesh(icosphere(2), "lamp")});
    add(scene, lamp);
    add(scene, placed(box({-1, 0, -1}, {1, 2.6, 1}, "brick"), 25, {-4.2, 0, 0.5}));
    addSphere(scene, {-0.4, 1.3, 0.8}, 1.3, "metal");
    addSphere(scene, {3.2, 1, 2.6}, 1, "glass");
    return scene;
}

// Everything emits 0.5 and reflects a half of what arrives: after D vertices radiance is 1 - 0.5^D everywhere.
SceneDesc furnace() {
    SceneDesc scene;
    scene.camera = camera({0.6, 0.2, 0.85}, {-0.2, -0.1, -0.3}, 70);
    MaterialDesc wall = lambertian(0.5, 0.5, 0.5);
    wall.emission = glm::dvec3(0.5);
    scene.materials["wall"] = wall;
    addRoom(scene, {-1, -1, -1}, {1, 1, 1}, "wall");
    addSphere(scene, {-0.4, -0.5, -0.3}, 0.35, "wall");
    add(scene, placed(box({-0.2, 0, -0.2}, {0.2, 0.7, 0.2}, "wall"), 30, {0.4, -1, -0.4}));
    GroupDesc ball;
    ball.transform = {Scale{glm::dvec3(0.25)}, Translate{{0.1, 0.45, -0.5}}};
    ball.objects.push_back({mesh(icosphere(1), "wall")});
    add(scene, ball);
    return scene;
}

// Radiance is 1 everywhere: each lambertian emits what it does not reflect, and everything else loses nothing.
SceneDesc furnaceMixed() {
    SceneDesc scene;
    scene.camera = camera({0.6, 0.2, 0.85}, {-0.2, -0.1, -0.3}, 70);
    const auto balanced = [](const glm::dvec3& albedo) {
        MaterialDesc material = lambertian(albedo);
        material.emission = 1.0 - albedo;
        return material;
    };
    scene.materials = {{"wall", balanced({0.5, 0.25, 0.125})},
                       {"ball", balanced({0.125, 0.5, 0.375})},
                       {"glass", glass(1.5)},
                       {"mirror", metal(glm::dvec3(1), 0)}};
    addRoom(scene, {-1, -1, -1}, {1, 1, 1}, "wall");
    addSphere(scene, {-0.45, -0.55, -0.3}, 0.35, "glass");
    addSphere(scene, {0.45, -0.6, -0.5}, 0.3, "mirror");
    addSphere(scene, {0.5, -0.7, 0.2}, 0.2, "ball");
    GroupDesc ball;
    ball.transform = {Scale{glm::dvec3(0.25)}, Translate{{0.1, 0.45, -0.5}}};
    ball.objects.push_back({mesh(icosphere(1), "ball")});
    add(scene, ball);
    MediumDesc cloud;
    cloud.boundary = SphereBoundary{{-0.35, 0.3, -0.2}, 0.3};
    cloud.density = 2;
    add(scene, cloud);
    return scene;
}

} // namespace rt::scene
