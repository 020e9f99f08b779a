// Scenes of "Ray Tracing in One Weekend", fourth edition.
#include "Common/Scene/Builtin/BuiltinFamilies.h"
#include "Common/Scene/Builtin/SceneBuilder.h"

namespace rt::scene {

namespace {

constexpr double kBookAspect = 16.0 / 9.0;

SceneDesc underSky() {
    SceneDesc scene;
    scene.background = GradientBackground{};
    scene.render.aspect = kBookAspect;
    return scene;
}

} // namespace

SceneDesc oneWeekendDefault() {
    SceneDesc scene = underSky();
    scene.materials = {{"ground", lambertian(0.8, 0.8, 0.0)}, {"blue", lambertian(0.1, 0.2, 0.5)}};
    addSphere(scene, {0, -100.5, -1}, 100, "ground");
    addSphere(scene, {0, 0, -1}, 0.5, "blue");
    return scene;
}

SceneDesc oneWeekendTest() {
    SceneDesc scene = underSky();
    scene.materials = {{"blue", lambertian(0, 0, 1)}, {"red", lambertian(1, 0, 0)}};
    const double r = std::sqrt(0.5);
    addSphere(scene, {-r, 0, -1}, r, "blue");
    addSphere(scene, {r, 0, -1}, r, "red");
    return scene;
}

SceneDesc oneWeekendField() {
    SceneDesc scene = underSky();
    scene.camera = camera({13, 2, 3}, {0, 0, 0}, 20);
    scene.camera.defocusAngle = 0.6;
    scene.camera.focusDistance = 10;
    scene.materials = {{"ground", lambertian(0.5, 0.5, 0.5)}, {"glass", glass(1.5)}};
    addSphere(scene, {0, -1000, 0}, 1000, "ground");
    SceneRandom random(1);
    for (int a = -11; a < 11; ++a)
        for (int b = -11; b < 11; ++b) {
            const double choice = random.next(), x = a + 0.9 * random.next(), z = b + 0.9 * random.next();
            const glm::dvec3 center(x, 0.2, z);
            if (glm::length(center - glm::dvec3(4, 0.2, 0)) <= 0.9) continue;
            std::string material = "glass";
            if (choice < 0.95) {
                material = "small " + std::to_string(scene.materials.size() - 2);
                const glm::dvec3 first = choice < 0.8 ? random.vector() : random.vector(0.5, 1);
                scene.materials[material] =
                    choice < 0.8 ? lambertian(first * random.vector()) : metal(first, random.next(0, 0.5));
            }
            addSphere(scene, center, 0.2, material);
        }
    return scene;
}

SceneDesc oneWeekendFinal() {
    SceneDesc scene = oneWeekendField();
    scene.materials["brown"] = lambertian(0.4, 0.2, 0.1);
    scene.materials["mirror"] = metal({0.7, 0.6, 0.5}, 0);
    addSphere(scene, {0, 1, 0}, 1, "glass");
    addSphere(scene, {-4, 1, 0}, 1, "brown");
    addSphere(scene, {4, 1, 0}, 1, "mirror");
    return scene;
}

} // namespace rt::scene
