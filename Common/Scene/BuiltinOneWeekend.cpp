// Scenes of "Ray Tracing in One Weekend", fourth edition.
#include "Common/Scene/BuiltinFamilies.h"
#include "Common/Scene/SceneBuilder.h"

namespace rt::scene {

namespace {

void addCoverCamera(SceneDesc& scene) {
    scene.camera.lookFrom = {13, 2, 3};
    scene.camera.lookAt = {0, 0, 0};
    scene.camera.verticalFov = 20;
    scene.camera.defocusAngle = 0.6;
    scene.camera.focusDistance = 10;
}

}  // namespace

SceneDesc oneWeekendFinal() {
    SceneDesc scene;
    addCoverCamera(scene);
    scene.background = GradientBackground{};
    scene.materials = {{"ground", lambertian(glm::dvec3(0.5))},
                       {"glass", glass(1.5)},
                       {"brown", lambertian(glm::dvec3(0.4, 0.2, 0.1))},
                       {"mirror", metal({0.7, 0.6, 0.5}, 0)}};
    addSphere(scene, {0, -1000, 0}, 1000, "ground");
    SceneRandom random(1);
    for (int a = -11; a < 11; ++a)
        for (int b = -11; b < 11; ++b) {
            const double choice = random.next();
            const double x = a + 0.9 * random.next(), z = b + 0.9 * random.next();
            const glm::dvec3 center(x, 0.2, z);
            if (glm::length(center - glm::dvec3(4, 0.2, 0)) <= 0.9) continue;
            std::string material = "glass";
            if (choice < 0.95) {
                material = "small " + std::to_string(scene.materials.size() - 4);
                const glm::dvec3 color = choice < 0.8 ? random.color() * random.color() : random.color(0.5, 1);
                scene.materials[material] = choice < 0.8 ? lambertian(color) : metal(color, random.next(0, 0.5));
            }
            addSphere(scene, center, 0.2, material);
        }
    addSphere(scene, {0, 1, 0}, 1, "glass");
    addSphere(scene, {-4, 1, 0}, 1, "brown");
    addSphere(scene, {4, 1, 0}, 1, "mirror");
    return scene;
}

}  // namespace rt::scene
