// The Cornell boxes: 555 units wide, seen from the front along +Z, so that +X points to the left of the image.
#include "Common/Scene/BuiltinFamilies.h"
#include "Common/Scene/SceneBuilder.h"

namespace rt::scene {

namespace {

// Camera and the five walls; what lights it is up to the scene.
SceneDesc emptyBox() {
    SceneDesc scene;
    scene.camera.lookFrom = {278, 278, -800};
    scene.camera.lookAt = {278, 278, 0};
    scene.camera.verticalFov = 40;
    scene.materials = {{"red", lambertian(glm::dvec3(0.65, 0.05, 0.05))},
                       {"white", lambertian(glm::dvec3(0.73))},
                       {"green", lambertian(glm::dvec3(0.12, 0.45, 0.15))}};
    addQuad(scene, {555, 0, 0}, {0, 0, 555}, {0, 555, 0}, "green");
    addQuad(scene, {0, 0, 555}, {0, 0, -555}, {0, 555, 0}, "red");
    addQuad(scene, {0, 555, 0}, {555, 0, 0}, {0, 0, 555}, "white");
    addQuad(scene, {0, 0, 555}, {555, 0, 0}, {0, 0, -555}, "white");
    addQuad(scene, {555, 0, 555}, {-555, 0, 0}, {0, 555, 0}, "white");
    return scene;
}

SceneDesc litBox() {
    SceneDesc scene = emptyBox();
    scene.materials["light"] = emitter(glm::dvec3(15));
    addQuad(scene, {213, 554, 227}, {130, 0, 0}, {0, 0, 105}, "light");
    return scene;
}

void addTallBox(SceneDesc& scene, const std::string& material) {
    scene.objects.push_back(placed({box({0, 0, 0}, {165, 330, 165}, material)}, 15, {265, 0, 295}));
}

}  // namespace

SceneDesc cornellBoxGlass() {
    SceneDesc scene = litBox();
    scene.materials["glass"] = glass(1.5);
    addTallBox(scene, "white");
    addSphere(scene, {190, 90, 190}, 90, "glass");
    scene.importanceTargets.push_back({SphereBoundary{{190, 90, 190}, 90}});
    return scene;
}

// Nine strips in front of the back wall and three balls that poke through the ceiling, all of them lights.
SceneDesc cornellBoxLights() {
    SceneDesc scene = emptyBox();
    scene.materials["strip"] = emitter(glm::dvec3(15));
    scene.materials["red light"] = emitter({20, 0.7, 0.7});
    scene.materials["blue light"] = emitter({0.7, 0.7, 20});
    scene.materials["green light"] = emitter({0.7, 20, 0.7});
    scene.materials["glass"] = glass(1.5);
    for (int height = 100; height <= 500; height += 50)
        addQuad(scene, {455, height, 554}, {-355, 0, 0}, {0, 10, 0}, "strip");
    addSphere(scene, {530, 530, 277}, 50, "red light");
    addSphere(scene, {277, 530, 277}, 50, "blue light");
    addSphere(scene, {30, 530, 277}, 50, "green light");
    addSphere(scene, {405, 100, 277.5}, 100, "glass");
    addSphere(scene, {150, 100, 277.5}, 100, "white");
    return scene;
}

}  // namespace rt::scene
