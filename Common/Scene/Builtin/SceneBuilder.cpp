#include "Common/Scene/Builtin/SceneBuilder.h"

#include <algorithm>
#include <map>

#include <glm/geometric.hpp>

namespace rt::scene {

GroupDesc placed(ObjectDesc::Shape object, double degreesAboutY, const glm::dvec3& offset) {
    GroupDesc group;
    group.transform = {Rotate{{0, 1, 0}, degreesAboutY}, Translate{offset}};
    group.objects.push_back({std::move(object)});
    return group;
}

void add(SceneDesc& scene, ObjectDesc::Shape object) {
    scene.objects.push_back({std::move(object)});
}

void addSphere(SceneDesc& scene, const glm::dvec3& center, double radius, const std::string& material) {
    add(scene, sphere(center, radius, material));
}

void addQuad(SceneDesc& scene, const glm::dvec3& corner, const glm::dvec3& edgeU, const glm::dvec3& edgeV,
             const std::string& material) {
    add(scene, quad(corner, edgeU, edgeV, material));
}

void addRoom(SceneDesc& scene, const glm::dvec3& min, const glm::dvec3& max, const std::string& material) {
    const glm::dvec3 size = max - min, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    addQuad(scene, min, y, z, material);
    addQuad(scene, min, z, x, material);
    addQuad(scene, min, x, y, material);
    addQuad(scene, max, -z, -y, material);
    addQuad(scene, max, -x, -z, material);
    addQuad(scene, max, -y, -x, material);
}

MeshData icosphere(int levels) {
    const double g = 0.5 * (1 + std::sqrt(5.0)); // the golden ratio
    MeshData mesh;
    mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (glm::dvec3& p : mesh.positions) p = glm::normalize(p);
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [entry, isNew] =
                middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.positions.size()));
            if (isNew) mesh.positions.push_back(glm::normalize(mesh.positions[a] + mesh.positions[b]));
            return entry->second;
        };
        std::vector<glm::uvec3> finer;
        for (const glm::uvec3& t : mesh.triangles) {
            const std::uint32_t a = middle(t.x, t.y), b = middle(t.y, t.z), c = middle(t.z, t.x);
            finer.insert(finer.end(), {{t.x, a, c}, {t.y, b, a}, {t.z, c, b}, {a, b, c}});
        }
        mesh.triangles.swap(finer);
    }
    return mesh;
}

} // namespace rt::scene
