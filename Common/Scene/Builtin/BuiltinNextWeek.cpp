// Scenes of "Ray Tracing: The Next Week", fourth edition. Its lights emit to both sides.
#include "Common/Scene/Builtin/BuiltinFamilies.h"
#include "Common/Scene/Builtin/SceneBuilder.h"

namespace rt::scene {

namespace {

constexpr double kWide = 16.0 / 9.0;

SceneDesc underFlatSky(const CameraDesc& camera, double aspect) {
    SceneDesc scene;
    scene.camera = camera;
    scene.background = ConstantBackground{{0.70, 0.80, 1.00}};
    scene.render.aspect = aspect;
    return scene;
}

CheckerTexture greenChecker() {
    return {0.32, glm::dvec3(0.2, 0.3, 0.1), glm::dvec3(0.9, 0.9, 0.9)};
}

// 0.5 (1 + sin(frequency z + 10 turbulence(p)))
NoiseTexture marble(double frequency) {
    NoiseTexture texture;
    texture.frequency = frequency;
    return texture;
}

SceneDesc cornellWalls() {
    SceneDesc scene;
    scene.camera = camera({278, 278, -800}, {278, 278, 0}, 40);
    scene.materials = {{"red", lambertian(0.65, 0.05, 0.05)},
                       {"white", lambertian(0.73, 0.73, 0.73)},
                       {"green", lambertian(0.12, 0.45, 0.15)}};
    addQuad(scene, {555, 0, 0}, {0, 555, 0}, {0, 0, 555}, "green");
    addQuad(scene, {0, 0, 0}, {0, 555, 0}, {0, 0, 555}, "red");
    addQuad(scene, {0, 0, 0}, {555, 0, 0}, {0, 0, 555}, "white");
    addQuad(scene, {0, 0, 555}, {555, 0, 0}, {0, 555, 0}, "white");
    return scene;
}

MediumDesc smoke(const glm::dvec3& size, const glm::dvec3& albedo) {
    MediumDesc medium;
    medium.boundary = BoxBoundary{{0, 0, 0}, size};
    medium.density = 0.01;
    medium.albedo = albedo;
    return medium;
}

MediumDesc ballOf(const SphereBoundary& boundary, double density, const glm::dvec3& albedo) {
    MediumDesc medium;
    medium.boundary = boundary;
    medium.density = density;
    medium.albedo = albedo;
    return medium;
}

} // namespace

// The predecessor's own: a sphere that moves sideways.
SceneDesc nextWeekDefault() {
    SceneDesc scene = underFlatSky({}, 1);
    scene.camera.defocusAngle = 1;
    scene.camera.focusDistance = 1;
    scene.materials = {{"ground", lambertian(0.8, 0.8, 0.0)}, {"blue", lambertian(0.1, 0.2, 0.5)}};
    addSphere(scene, {0, -100.5, -1}, 100, "ground");
    SphereDesc moving = sphere({0, 0, -1}, 0.5, "blue");
    moving.centerEnd = moving.center + glm::dvec3(SceneRandom(2).next(0, 0.5), 0, 0);
    add(scene, moving);
    return scene;
}

SceneDesc nextWeekRandomSpheres() {
    SceneDesc scene = oneWeekendFinal();
    scene.background = ConstantBackground{{0.70, 0.80, 1.00}};
    scene.textures["checker"] = greenChecker();
    scene.materials["ground"] = lambertian(std::string("checker"));
    SceneRandom random(3);
    for (ObjectDesc& object : scene.objects) {
        auto& sphere = std::get<SphereDesc>(object.shape);
        if (sphere.radius == 0.2 && scene.materials[sphere.material].kind == MaterialKind::Lambertian)
            sphere.centerEnd = sphere.center + glm::dvec3(0, random.next(0, 0.5), 0);
    }
    return scene;
}

SceneDesc nextWeekTwoSpheres() {
    SceneDesc scene = underFlatSky(camera({13, 2, 3}, {0, 0, 0}, 20), kWide);
    scene.textures["checker"] = greenChecker();
    scene.materials["checker"] = lambertian(std::string("checker"));
    addSphere(scene, {0, -10, 0}, 10, "checker");
    addSphere(scene, {0, 10, 0}, 10, "checker");
    return scene;
}

SceneDesc nextWeekEarth() {
    SceneDesc scene = underFlatSky(camera({0, 0, 12}, {0, 0, 0}, 20), kWide);
    scene.textures["earth"] = ImageTexture{"textures/earthmap.jpg", "earth", glm::dvec3(1)};
    scene.materials["earth"] = lambertian(std::string("earth"));
    addSphere(scene, {0, 0, 0}, 2, "earth");
    return scene;
}

SceneDesc nextWeekTwoPerlinSpheres() {
    SceneDesc scene = underFlatSky(camera({13, 2, 3}, {0, 0, 0}, 20), kWide);
    scene.textures["marble"] = marble(4);
    scene.materials["marble"] = lambertian(std::string("marble"));
    addSphere(scene, {0, -1000, 0}, 1000, "marble");
    addSphere(scene, {0, 2, 0}, 2, "marble");
    return scene;
}

SceneDesc nextWeekQuads() {
    SceneDesc scene = underFlatSky(camera({0, 0, 9}, {0, 0, 0}, 80), 1);
    scene.materials = {{"left", lambertian(1.0, 0.2, 0.2)},
                       {"back", lambertian(0.2, 1.0, 0.2)},
                       {"right", lambertian(0.2, 0.2, 1.0)},
                       {"upper", lambertian(1.0, 0.5, 0.0)},
                       {"lower", lambertian(0.2, 0.8, 0.8)}};
    addQuad(scene, {-3, -2, 5}, {0, 0, -4}, {0, 4, 0}, "left");
    addQuad(scene, {-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, "back");
    addQuad(scene, {3, -2, 1}, {0, 0, 4}, {0, 4, 0}, "right");
    addQuad(scene, {-2, 3, 1}, {4, 0, 0}, {0, 0, 4}, "upper");
    addQuad(scene, {-2, -3, 5}, {4, 0, 0}, {0, 0, -4}, "lower");
    return scene;
}

SceneDesc nextWeekSimpleLight() {
    SceneDesc scene;
    scene.camera = camera({26, 3, 6}, {0, 2, 0}, 20);
    scene.render.aspect = kWide;
    scene.textures["marble"] = marble(4);
    scene.materials["marble"] = lambertian(std::string("marble"));
    scene.materials["light"] = emitter(glm::dvec3(4), Sides::Both);
    addSphere(scene, {0, -1000, 0}, 1000, "marble");
    addSphere(scene, {0, 2, 0}, 2, "marble");
    addSphere(scene, {0, 7, 0}, 2, "light");
    addQuad(scene, {3, 1, -2}, {2, 0, 0}, {0, 2, 0}, "light");
    return scene;
}

SceneDesc nextWeekCornellBox() {
    SceneDesc scene = cornellWalls();
    scene.materials["light"] = emitter(glm::dvec3(15), Sides::Both);
    addQuad(scene, {555, 555, 555}, {-555, 0, 0}, {0, 0, -555}, "white");
    addQuad(scene, {343, 554, 332}, {-130, 0, 0}, {0, 0, -105}, "light");
    add(scene, placed(box({0, 0, 0}, {165, 330, 165}, "white"), 15, {265, 0, 295}));
    add(scene, placed(box({0, 0, 0}, {165, 165, 165}, "white"), -18, {130, 0, 65}));
    return scene;
}

SceneDesc nextWeekCornellSmoke() {
    SceneDesc scene = cornellWalls();
    scene.materials["light"] = emitter(glm::dvec3(7), Sides::Both);
    addQuad(scene, {0, 555, 0}, {555, 0, 0}, {0, 0, 555}, "white");
    addQuad(scene, {113, 554, 127}, {330, 0, 0}, {0, 0, 305}, "light");
    add(scene, placed(smoke({165, 330, 165}, glm::dvec3(0)), 15, {265, 0, 295}));
    add(scene, placed(smoke({165, 165, 165}, glm::dvec3(1)), -18, {130, 0, 65}));
    return scene;
}

SceneDesc nextWeekFinal() {
    SceneDesc scene;
    scene.camera = camera({478, 278, -600}, {278, 278, 0}, 40);
    scene.textures["earth"] = ImageTexture{"textures/earthmap.jpg", "earth", glm::dvec3(1)};
    scene.textures["marble"] = marble(0.2);
    scene.materials = {{"ground", lambertian(0.48, 0.83, 0.53)},      {"light", emitter(glm::dvec3(7), Sides::Both)},
                       {"orange", lambertian(0.7, 0.3, 0.1)},         {"glass", glass(1.5)},
                       {"metal", metal({0.8, 0.8, 0.9}, 1)},          {"earth", lambertian(std::string("earth"))},
                       {"marble", lambertian(std::string("marble"))}, {"white", lambertian(0.73, 0.73, 0.73)}};
    SceneRandom random(4);
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 20; ++j) {
            const glm::dvec3 low(-1000 + 100 * i, 0, -1000 + 100 * j);
            add(scene, box(low, low + glm::dvec3(100, random.next(1, 101), 100), "ground"));
        }
    addQuad(scene, {123, 554, 147}, {300, 0, 0}, {0, 0, 265}, "light");
    SphereDesc moving = sphere({400, 400, 200}, 50, "orange");
    moving.centerEnd = glm::dvec3(430, 400, 200);
    add(scene, moving);
    addSphere(scene, {260, 150, 45}, 50, "glass");
    addSphere(scene, {0, 150, 145}, 50, "metal");
    addSphere(scene, {360, 150, 145}, 70, "glass"); // filled with a dense medium: subsurface scattering
    add(scene, ballOf({{360, 150, 145}, 70}, 0.2, {0.2, 0.4, 0.9}));
    add(scene, ballOf({{0, 0, 0}, 5000}, 0.0001, glm::dvec3(1))); // mist over everything
    addSphere(scene, {400, 200, 400}, 100, "earth");
    addSphere(scene, {220, 280, 300}, 80, "marble");
    SphereSetDesc cube;
    cube.radius = 10;
    cube.material = "white";
    for (int i = 0; i < 1000; ++i) cube.centers.push_back(random.vector(0, 165));
    add(scene, placed(std::move(cube), 15, {-100, 270, 395}));
    return scene;
}

} // namespace rt::scene
