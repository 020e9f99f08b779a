#include "Common/Scene/ModelPlace.h"

#include <algorithm>
#include <variant>

#include <glm/geometric.hpp>

#include "Common/Scene/Affine.h"

namespace rt::scene {

namespace {

// Of the distance from the camera to what it looks at.
constexpr double kSpeck = 0.01;                          // a radius that is less is not seen
constexpr double kLeastRadius = 0.05, kMostRadius = 0.3; // of what is put there

class PrototypeBounds {
  public:
    explicit PrototypeBounds(const std::map<std::string, std::vector<ObjectDesc>>& prototypes)
        : prototypes_(prototypes) {}

    const Bounds& of(const std::string& name) {
        const auto [bounds, isNew] = known_.try_emplace(name);
        const auto prototype = prototypes_.find(name);
        if (isNew && prototype != prototypes_.end()) bounds->second = of(prototype->second);
        return bounds->second;
    }

    Bounds operator()(const SphereDesc& sphere) const {
        Bounds bounds;
        bounds.add(sphere.center, sphere.radius);
        if (sphere.centerEnd) bounds.add(*sphere.centerEnd, sphere.radius);
        return bounds;
    }
    Bounds operator()(const SphereSetDesc& spheres) const {
        Bounds bounds;
        for (const glm::dvec3& center : spheres.centers) bounds.add(center, spheres.radius);
        return bounds;
    }
    Bounds operator()(const QuadDesc& quad) const {
        Bounds bounds;
        for (const glm::dvec3& corner : {quad.corner, quad.corner + quad.edgeU, quad.corner + quad.edgeV})
            bounds.add(corner);
        bounds.add(quad.corner + quad.edgeU + quad.edgeV);
        return bounds;
    }
    Bounds operator()(const BoxDesc& box) const { return {box.min, box.max}; }
    Bounds operator()(const DiskDesc& disk) const { return (*this)(SphereDesc{disk.center, disk.radius, {}, {}}); }
    Bounds operator()(const CylinderDesc& cylinder) const {
        return (*this)(SphereDesc{cylinder.base, cylinder.radius, cylinder.top, {}});
    }
    Bounds operator()(const MeshDesc& mesh) const {
        Bounds bounds;
        if (const auto* data = std::get_if<Boxed<MeshData>>(&mesh.source))
            for (const glm::dvec3& position : (*data)->positions) bounds.add(position);
        return bounds;
    }
    Bounds operator()(const MediumDesc& medium) const {
        if (const auto* box = std::get_if<BoxBoundary>(&medium.boundary)) return {box->min, box->max};
        const auto& sphere = std::get<SphereBoundary>(medium.boundary);
        return (*this)(SphereDesc{sphere.center, sphere.radius, {}, {}});
    }
    Bounds operator()(const GroupDesc& group) {
        Bounds bounds;
        bounds.add(of(group.objects), toAffine(group.transform));
        return bounds;
    }
    Bounds operator()(const InstanceDesc& instance) {
        Bounds bounds;
        bounds.add(of(instance.prototype), toAffine(instance.transform));
        return bounds;
    }
    template <typename Light>
    Bounds operator()(const Light&) const { // without extent
        return {};
    }

  private:
    Bounds of(const std::vector<ObjectDesc>& objects) {
        Bounds bounds;
        for (const ObjectDesc& object : objects) bounds.add(std::visit(*this, object.shape), {});
        return bounds;
    }

    const std::map<std::string, std::vector<ObjectDesc>>& prototypes_;
    std::map<std::string, Bounds> known_;
};

bool lieWithin(const Bounds& inner, const Bounds& outer) {
    const double slack = 1e-6 * outer.radius(); // of the scene's single precision
    for (int axis = 0; axis < 3; ++axis)
        if (inner.lower[axis] < outer.lower[axis] - slack || inner.upper[axis] > outer.upper[axis] + slack)
            return false;
    return true;
}

} // namespace

Bounds boundsOfPrototype(const std::map<std::string, std::vector<ObjectDesc>>& prototypes, const std::string& name) {
    return PrototypeBounds(prototypes).of(name);
}

Transform placeOfModel(const Bounds& model, const Bounds& scene, const CameraDesc& camera) {
    if (model.empty()) return {};
    const double distance = glm::length(camera.lookAt - camera.lookFrom), radius = model.radius();
    if (!scene.empty() && lieWithin(model, scene) && radius >= kSpeck * distance) return {};
    const double wanted = std::clamp(radius, kLeastRadius * distance, kMostRadius * distance);
    const double scale = radius > 0 ? wanted / radius : 1;
    Transform place;
    if (scale != 1) place.push_back(Scale{glm::dvec3(scale)});
    place.push_back(Translate{camera.lookAt - scale * model.center()});
    return place;
}

} // namespace rt::scene
