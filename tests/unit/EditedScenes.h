// A scene with meshes of every kind, and random edits of it that compile.
#pragma once
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "Common/Scene/Edit/SceneEdit.h"
#include "tests/unit/CompilerScenes.h"

namespace rt::scene {

// A grid of `side` times `side` squares, bent, with what attributes a mesh can have.
inline MeshData bentGrid(std::uint32_t side, bool hasAttributes) {
    MeshData mesh;
    for (std::uint32_t y = 0; y <= side; ++y)
        for (std::uint32_t x = 0; x <= side; ++x) {
            const double u = double(x) / side, v = double(y) / side;
            mesh.positions.emplace_back(u - 0.5, 0.2 * std::sin(6 * u) * std::cos(5 * v), v - 0.5);
            if (!hasAttributes) continue;
            mesh.normals.emplace_back(-std::cos(6 * u), 1, std::sin(5 * v));
            mesh.uvs.emplace_back(u, v);
            mesh.uvs2.emplace_back(v, u);
            mesh.colors.emplace_back(u, v, 1, 1);
            mesh.tangents.emplace_back(1, 0, 0, 1);
        }
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            const std::uint32_t a = y * (side + 1) + x, b = a + side + 1;
            mesh.triangles.emplace_back(a, a + 1, b);
            mesh.triangles.emplace_back(a + 1, b + 1, b);
        }
    mesh.triangles.emplace_back(0, 0, 1); // without area
    return mesh;
}

inline ObjectDesc meshObject(MeshData data, const std::string& material) {
    MeshDesc mesh;
    mesh.source = std::move(data);
    mesh.material = material;
    return {mesh};
}

inline SceneDesc sceneOfMeshes(std::uint32_t side = 8) {
    SceneDesc scene = withMaterials();
    scene.camera.lookFrom = {0.5, 1, 6};
    scene.camera.lookAt = {0, 0, 0};
    scene.background = ConstantBackground{glm::dvec3(0.5)};
    scene.prototypes["hill"] = {meshObject(bentGrid(side, true), "matte"), meshObject(bentGrid(side, false), "glass")};
    SphereDesc ball;
    ball.center = {0, 2, 0};
    ball.radius = 0.5;
    ball.material = "glass";
    SphereDesc flat;
    flat.material = "matte";
    scene.objects = {{ball},
                     meshObject(bentGrid(side, true), "matte"),
                     {group({Translate{{2, 0, 0}}}, meshObject(bentGrid(2, false), "lamp").shape)},
                     {InstanceDesc{"hill", {Translate{{-2, 0, 0}}}, ""}},
                     {InstanceDesc{"hill", {Scale{{1, -1, 1}}, Translate{{0, 0, -2}}}, "matte"}},
                     {InstanceDesc{"hill", {Rotate{{0, 1, 0}, 40}, Translate{{0, -1, 0}}}, ""}},
                     {group({Scale{{1, 2, 1}}}, flat)}};
    return scene;
}

class EditsOfMeshes {
  public:
    explicit EditsOfMeshes(std::uint64_t seed) : random_(seed) {}

    SceneEdit next(const SceneDesc& scene) {
        const ObjectPath path{"", {static_cast<std::uint32_t>(pick(scene.objects.size()))}};
        const bool isInstance = std::holds_alternative<InstanceDesc>(findObject(scene, path)->shape);
        const bool isGroup = std::holds_alternative<GroupDesc>(findObject(scene, path)->shape);
        switch (pick(8)) {
            case 0:
                return SetMaterial{"matte", lambertian(share(), share(), share())};
            case 1:
                return SetMaterial{"lamp", pick(2) == 0 ? emitter({share(), 1, 2}) : lambertian(share(), 0, 0)};
            case 2:
                return PlaceObject{path, meshObject(bentGrid(3, pick(2) == 0), pick(2) == 0 ? "matte" : "lamp")};
            case 3:
                if (scene.objects.size() > 4) return PlaceObject{path, std::nullopt};
                return PlaceObject{path, ObjectDesc{InstanceDesc{"hill", placed(), ""}}};
            case 4:
                return SetBackground{ConstantBackground{glm::dvec3(share())}};
            default:
                if (isInstance || isGroup) return SetTransform{path, placed()};
                return WrapObject{path, placed()};
        }
    }
    std::size_t pick(std::size_t count) { return random_() % count; }
    double share() { return std::uniform_real_distribution<double>(0.1, 0.9)(random_); }
    Transform placed() {
        return {Rotate{{0, 1, 0}, 90 * share()}, Translate{{4 * share() - 2, 4 * share() - 2, -2 * share()}}};
    }

  private:
    std::mt19937_64 random_;
};

} // namespace rt::scene
