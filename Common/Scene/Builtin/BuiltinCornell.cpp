// Cornell boxes of "Ray Tracing: The Rest of Your Life" and of the predecessor: 555 units wide, seen from the front
// along +Z, so that +X points to the left of the image.
#include "Common/Scene/Builtin/BuiltinFamilies.h"
#include "Common/Scene/Builtin/SceneBuilder.h"

namespace rt::scene {

namespace {

SceneDesc boxScene() {
    SceneDesc scene;
    scene.camera = camera({278, 278, -800}, {278, 278, 0}, 40);
    scene.materials = {{"red", lambertian(0.65, 0.05, 0.05)},
                       {"white", lambertian(0.73, 0.73, 0.73)},
                       {"green", lambertian(0.12, 0.45, 0.15)}};
    return scene;
}

// The five walls; what lights them is up to the scene.
SceneDesc emptyBox() {
    SceneDesc scene = boxScene();
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
    add(scene, placed(box({0, 0, 0}, {165, 330, 165}, material), 15, {265, 0, 295}));
}

void addShortBox(SceneDesc& scene) {
    add(scene, placed(box({0, 0, 0}, {165, 165, 165}, "white"), -18, {130, 0, 65}));
}

} // namespace

SceneDesc restOfLifeCornellBox() {
    SceneDesc scene = litBox();
    addTallBox(scene, "white");
    addShortBox(scene);
    return scene;
}

SceneDesc restOfLifeCornellBoxMirror() {
    SceneDesc scene = litBox();
    scene.materials["aluminium"] = metal({0.8, 0.85, 0.88}, 0);
    addTallBox(scene, "aluminium");
    addShortBox(scene);
    return scene;
}

SceneDesc restOfLifeCornellBoxGlass() {
    SceneDesc scene = litBox();
    scene.materials["glass"] = glass(1.5);
    addTallBox(scene, "white");
    addSphere(scene, {190, 90, 190}, 90, "glass");
    scene.importanceTargets.push_back({SphereBoundary{{190, 90, 190}, 90}});
    return scene;
}

SceneDesc whiteSpheres(std::uint32_t count) {
    SceneDesc scene;
    scene.camera = camera({278, 278, -800}, {278, 278, 0}, 40);
    scene.materials = {{"white", lambertian(0.73, 0.73, 0.73)}, {"light", emitter(glm::dvec3(7))}};
    addQuad(scene, {400, 554, 100}, {-300, 0, 0}, {0, 0, -100}, "light");
    SphereSetDesc spheres;
    spheres.radius = 10;
    spheres.material = "white";
    spheres.centers.reserve(count);
    SceneRandom random(5);
    for (std::uint32_t i = 0; i < count; ++i) spheres.centers.push_back(random.vector(0, 500));
    add(scene, placed(std::move(spheres), 15, {0, 0, 300}));
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

// The ancestor's box looks along -Z and is open towards +Z.
SceneDesc cornellBoxLucy() {
    SceneDesc scene = boxScene();
    scene.camera = camera({278, 278, 800}, {278, 278, 0}, 40);
    scene.materials["light"] = emitter(glm::dvec3(15));
    scene.materials["glass"] = glass(1.5);
    scene.materials["grey"] = lambertian(0.7, 0.7, 0.7);
    addQuad(scene, {0, 0, -555}, {0, 555, 0}, {0, 0, 555}, "green");
    addQuad(scene, {555, 0, -555}, {0, 0, 555}, {0, 555, 0}, "red");
    addQuad(scene, {0, 0, -555}, {555, 0, 0}, {0, 555, 0}, "white");
    addQuad(scene, {0, 0, -555}, {0, 0, 555}, {555, 0, 0}, "white");
    addQuad(scene, {0, 555, -555}, {555, 0, 0}, {0, 0, 555}, "white");
    addQuad(scene, {213, 553.89, -328}, {130, 0, 0}, {0, 0, 105}, "light");
    addSphere(scene, {425, 165, -147.5}, 80, "glass");
    GroupDesc lucy;
    lucy.transform = {Rotate{{0, 1, 0}, 75}, Scale{glm::dvec3(0.6)}, Translate{{173, -9, -377}}};
    MeshDesc mesh = lucyMesh();
    mesh.material = "grey";
    lucy.objects.push_back({mesh});
    add(scene, lucy);
    return scene;
}

} // namespace rt::scene
