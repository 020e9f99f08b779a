// The ancestor's scenes of meshes and textures.
#include <array>

#include "Common/Scene/Builtin/BuiltinFamilies.h"
#include "Common/Scene/Builtin/SceneBuilder.h"

namespace rt::scene {

namespace {

// A face of the cube [-0.5, 0.5]^3 with its corners in counter-clockwise order, the lower left of the texture first.
MeshData cubeFace(const glm::dvec3& corner, const glm::dvec3& right, const glm::dvec3& up) {
    MeshData face;
    face.positions = {corner, corner + right, corner + right + up, corner + up};
    face.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    face.triangles = {{0, 1, 2}, {0, 2, 3}};
    return face;
}

void addCube(SceneDesc& scene) {
    struct Face {
        const char* material;
        glm::dvec3 color, corner, right, up;
    };
    const double h = 0.5, bright = 0.982062, dark = 0.1;
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), yellow(bright, 0.857638, 0.400811);
    const std::array<Face, 6> faces = {{{"cube left", yellow, {-h, -h, -h}, z, y},
                                        {"cube front", yellow, {-h, -h, h}, x, y},
                                        {"cube right", {dark, dark, bright}, {h, -h, h}, -z, y},
                                        {"cube back", {bright, dark, dark}, {h, -h, -h}, -x, y},
                                        {"cube bottom", {dark, 0.9, dark}, {-h, -h, -h}, x, z},
                                        {"cube top", {bright, dark, bright}, {-h, h, h}, x, -z}}};
    for (const Face& face : faces) {
        scene.materials[face.material] = lambertian(face.color);
        add(scene, mesh(cubeFace(face.corner, face.right, face.up), face.material));
    }
}

void setLens(CameraDesc& camera, double aperture, double focusDistance) {
    camera.defocusAngle = defocusAngle(aperture, focusDistance);
    camera.focusDistance = focusDistance;
}

void addTexture(SceneDesc& scene, const std::string& name, const std::string& file, const std::string& standIn) {
    scene.textures[name] = ImageTexture{"textures/" + file, standIn, glm::dvec3(1)};
    scene.materials[name] = lambertian(name);
}

// The field of small spheres as a square picture through a lens `aperture` wide.
SceneDesc field(double aperture) {
    SceneDesc scene = oneWeekendField();
    scene.render.aspect = 1;
    setLens(scene.camera, aperture, 10);
    return scene;
}

} // namespace

SceneDesc cubeAndSpheres() {
    SceneDesc scene;
    scene.camera = camera({0, 0, 2}, {0, 0, 0}, 90);
    setLens(scene.camera, 0.05, 2);
    scene.background = GradientBackground{};
    addCube(scene);
    scene.materials["metal"] = metal({0.7, 0.5, 0.8}, 0.2);
    scene.materials["glass"] = glass(1.5);
    addTexture(scene, "earth", "earth_daymap.jpg", "earth");
    addSphere(scene, {1, 0, 0}, 0.5, "metal");
    addSphere(scene, {-1, 0, 0}, 0.5, "glass");
    addSphere(scene, {0, 1, 0}, 0.5, "earth");
    return scene;
}

SceneDesc planetsInOneWeekend() {
    SceneDesc scene = field(0.1);
    addTexture(scene, "venus", "venus_atmosphere.jpg", "venus");
    addTexture(scene, "earth at night", "earth_nightmap.jpg", "earth-night");
    addTexture(scene, "mars", "mars.jpg", "mars");
    addSphere(scene, {4, 1, 0}, 1, "venus");
    addSphere(scene, {0, 1, 0}, 1, "earth at night");
    addSphere(scene, {-4, 1, 0}, 1, "mars");
    return scene;
}

MeshDesc lucyMesh() {
    MeshDesc mesh;
    mesh.source = MeshFile{"models/lucy.obj", "statue"};
    return mesh;
}

// One mesh, three instances of different materials.
SceneDesc lucyInOneWeekend() {
    SceneDesc scene = field(0.05);
    scene.camera.lookAt = {0, 1, 0};
    scene.materials["brown"] = lambertian(0.4, 0.2, 0.1);
    scene.materials["metal"] = metal({0.7, 0.6, 0.5}, 0.05);
    MeshDesc mesh = lucyMesh();
    mesh.material = "glass";
    scene.prototypes["lucy"].push_back({mesh});
    const auto addLucy = [&](double x, const std::string& material) {
        InstanceDesc lucy;
        lucy.prototype = "lucy";
        lucy.transform = {Rotate{{0, 1, 0}, 90}, Scale{glm::dvec3(0.0035)}, Translate{{x, -0.08, 0}}};
        lucy.material = material;
        add(scene, lucy);
    };
    addLucy(0, "");
    addLucy(-4, "brown");
    addLucy(4, "metal");
    return scene;
}

} // namespace rt::scene
