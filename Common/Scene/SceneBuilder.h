// Shorthand for writing scenes in code.
#pragma once
#include <cstdint>
#include <string>
#include <utility>

#include "Common/Scene/SceneDesc.h"
#include "Common/Shared/Random.h"

namespace rt::scene {

// Numbers for random placements: the same sequence on every machine.
class SceneRandom {
  public:
    explicit SceneRandom(std::uint32_t seed) : seed_(seed) {}
    double next() { return shared::hash3({count_++, seed_, 0x7363656eu}).x * 0x1p-32; }  // [0,1)
    double next(double low, double high) { return low + (high - low) * next(); }
    glm::dvec3 color(double low = 0, double high = 1) {
        const double r = next(low, high), g = next(low, high);
        return {r, g, next(low, high)};
    }

  private:
    std::uint32_t seed_;
    std::uint32_t count_ = 0;
};

inline MaterialDesc lambertian(ColorOrTexture albedo) {
    MaterialDesc material;
    material.albedo = std::move(albedo);
    return material;
}
inline MaterialDesc metal(const glm::dvec3& albedo, double fuzz) {
    MaterialDesc material;
    material.kind = MaterialKind::Metal;
    material.albedo = albedo;
    material.fuzz = fuzz;
    return material;
}
inline MaterialDesc glass(double ior) {
    MaterialDesc material;
    material.kind = MaterialKind::Dielectric;
    material.ior = ior;
    return material;
}
inline MaterialDesc emitter(const glm::dvec3& radiance) {
    MaterialDesc material;
    material.kind = MaterialKind::Emitter;
    material.emission = radiance;
    return material;
}

inline void addSphere(SceneDesc& scene, const glm::dvec3& center, double radius, const std::string& material) {
    SphereDesc sphere;
    sphere.center = center;
    sphere.radius = radius;
    sphere.material = material;
    scene.objects.push_back({sphere});
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
inline void addQuad(SceneDesc& scene, const glm::dvec3& corner, const glm::dvec3& edgeU, const glm::dvec3& edgeV,
                    const std::string& material) {
    scene.objects.push_back({quad(corner, edgeU, edgeV, material)});
}
inline BoxDesc box(const glm::dvec3& min, const glm::dvec3& max, const std::string& material) {
    BoxDesc box;
    box.min = min;
    box.max = max;
    box.material = material;
    return box;
}
// An object turned about +Y, then moved.
inline ObjectDesc placed(ObjectDesc object, double degreesAboutY, const glm::dvec3& offset) {
    GroupDesc group;
    group.transform = {Rotate{{0, 1, 0}, degreesAboutY}, Translate{offset}};
    group.objects.push_back(std::move(object));
    return {std::move(group)};
}

}  // namespace rt::scene
