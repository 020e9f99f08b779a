// Shorthand for writing scenes in code.
#pragma once
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "Common/Scene/SceneDesc.h"
#include "Common/Shared/Base/Random.h"

namespace rt::scene {

// Numbers for random placements: the same sequence on every machine.
class SceneRandom {
  public:
    explicit SceneRandom(std::uint32_t seed) : seed_(seed) {}
    double next() { return shared::hash3({count_++, seed_, 0x7363656eu}).x * 0x1p-32; } // [0,1)
    double next(double low, double high) { return low + (high - low) * next(); }
    // Components in order.
    glm::dvec3 vector(double low = 0, double high = 1) {
        const double x = next(low, high), y = next(low, high);
        return {x, y, next(low, high)};
    }

  private:
    std::uint32_t seed_;
    std::uint32_t count_ = 0;
};

// ---- camera --------------------------------------------------------------------------------------------------------

inline CameraDesc camera(const glm::dvec3& from, const glm::dvec3& at, double verticalFov) {
    CameraDesc camera;
    camera.lookFrom = from;
    camera.lookAt = at;
    camera.verticalFov = verticalFov;
    return camera;
}

// The defocus angle of a lens `aperture` wide.
inline double defocusAngle(double aperture, double focusDistance) {
    return 2 * std::atan(aperture / (2 * focusDistance)) * (180 / 3.14159265358979323846);
}

// ---- materials -----------------------------------------------------------------------------------------------------

inline MaterialDesc lambertian(ColorOrTexture albedo) {
    MaterialDesc material;
    material.albedo = std::move(albedo);
    return material;
}
inline MaterialDesc lambertian(double r, double g, double b) {
    return lambertian(glm::dvec3(r, g, b));
}
inline MaterialDesc metal(const glm::dvec3& albedo, double fuzz) {
    MaterialDesc material;
    material.kind = MaterialKind::Metal;
    material.albedo = albedo;
    material.parameters[shared::kMetalFuzz] = fuzz;
    return material;
}
inline MaterialDesc glass(double ior) {
    MaterialDesc material;
    material.kind = MaterialKind::Dielectric;
    material.parameters[shared::kDielectricIor] = ior;
    return material;
}
inline MaterialDesc emitter(const glm::dvec3& radiance, std::optional<Sides> sides = std::nullopt) {
    MaterialDesc material;
    material.kind = MaterialKind::Emitter;
    material.emission = radiance;
    material.sides = sides;
    return material;
}

// ---- objects -------------------------------------------------------------------------------------------------------

inline SphereDesc sphere(const glm::dvec3& center, double radius, const std::string& material) {
    SphereDesc sphere;
    sphere.center = center;
    sphere.radius = radius;
    sphere.material = material;
    return sphere;
}
inline QuadDesc quad(const glm::dvec3& corner, const glm::dvec3& edgeU, const glm::dvec3& edgeV,
                     const std::string& material) {
    QuadDesc quad;
    quad.corner = corner;
    quad.edgeU = edgeU;
    quad.edgeV = edgeV;
    quad.material = material;
    return quad;
}
inline BoxDesc box(const glm::dvec3& min, const glm::dvec3& max, const std::string& material) {
    BoxDesc box;
    box.min = min;
    box.max = max;
    box.material = material;
    return box;
}
inline MeshDesc mesh(MeshData data, const std::string& material) {
    MeshDesc mesh;
    mesh.source = std::move(data);
    mesh.material = material;
    return mesh;
}
// An object turned about +Y, then moved.
GroupDesc placed(ObjectDesc::Shape object, double degreesAboutY, const glm::dvec3& offset);

void add(SceneDesc& scene, ObjectDesc::Shape object);
void addSphere(SceneDesc& scene, const glm::dvec3& center, double radius, const std::string& material);
void addQuad(SceneDesc& scene, const glm::dvec3& corner, const glm::dvec3& edgeU, const glm::dvec3& edgeV,
             const std::string& material);
// The six walls of a room, their fronts to the inside.
void addRoom(SceneDesc& scene, const glm::dvec3& min, const glm::dvec3& max, const std::string& material);

// A sphere of 20 * 4^levels triangles with vertices on the unit sphere, facing outwards.
MeshData icosphere(int levels);

} // namespace rt::scene
