#include "Common/Scene/Edit/ObjectMotion.h"

#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>

#include "Common/Scene/Placing.h"

namespace rt::scene {

namespace {

// Positive factors along the axes; nothing where the map does more than scale and move.
std::optional<glm::dvec3> axisScale(const Affine& map) {
    const glm::dvec3 factors(map.linear[0][0], map.linear[1][1], map.linear[2][2]);
    const bool isDiagonal = map.linear == scaling(factors).linear;
    if (!isDiagonal || !(factors.x > 0 && factors.y > 0 && factors.z > 0)) return std::nullopt;
    return factors;
}

// Of a shape that any rotation and uniform scale leaves one of its kind.
template <typename Shape, typename Change>
std::optional<ObjectDesc> mappedEvenly(Shape shape, const Affine& map, const Change& change) {
    const std::optional<double> scale = uniformScale(map);
    if (!scale) return std::nullopt;
    change(shape, *scale);
    return ObjectDesc{std::move(shape)};
}

struct Mapping {
    const Affine& map;

    glm::dvec3 direction(const glm::dvec3& v) const {
        return glm::length(v) / glm::length(map.vector(v)) * map.vector(v);
    }

    std::optional<ObjectDesc> operator()(const SphereDesc& sphere) const {
        return mappedEvenly(sphere, map, [this](SphereDesc& s, double scale) {
            s.center = map.point(s.center);
            if (s.centerEnd) s.centerEnd = map.point(*s.centerEnd);
            s.radius *= scale;
        });
    }
    std::optional<ObjectDesc> operator()(QuadDesc quad) const {
        quad.corner = map.point(quad.corner);
        quad.edgeU = map.vector(quad.edgeU);
        quad.edgeV = map.vector(quad.edgeV);
        if (map.mirrors()) return std::nullopt; // its front would be its back
        return ObjectDesc{quad};
    }
    std::optional<ObjectDesc> operator()(BoxDesc box) const {
        if (!axisScale(map)) return std::nullopt;
        box.min = map.point(box.min);
        box.max = map.point(box.max);
        return ObjectDesc{box};
    }
    std::optional<ObjectDesc> operator()(const DiskDesc& disk) const {
        return mappedEvenly(disk, map, [this](DiskDesc& d, double scale) {
            d.center = map.point(d.center);
            d.normal = direction(d.normal);
            d.radius *= scale;
            d.innerRadius *= scale;
        });
    }
    std::optional<ObjectDesc> operator()(const CylinderDesc& cylinder) const {
        return mappedEvenly(cylinder, map, [this](CylinderDesc& c, double scale) {
            c.base = map.point(c.base);
            c.top = map.point(c.top);
            c.radius *= scale;
        });
    }
    std::optional<ObjectDesc> operator()(MediumDesc medium) const {
        if (auto* box = std::get_if<BoxBoundary>(&medium.boundary)) {
            if (!axisScale(map)) return std::nullopt;
            *box = {map.point(box->min), map.point(box->max)};
            return ObjectDesc{medium};
        }
        return mappedEvenly(medium, map, [this](MediumDesc& m, double scale) {
            auto& sphere = std::get<SphereBoundary>(m.boundary);
            sphere.center = map.point(sphere.center);
            sphere.radius *= scale;
        });
    }
    std::optional<ObjectDesc> operator()(PointLightDesc light) const {
        light.position = map.point(light.position);
        return ObjectDesc{light};
    }
    std::optional<ObjectDesc> operator()(SpotLightDesc light) const {
        light.position = map.point(light.position);
        light.direction = direction(light.direction);
        return ObjectDesc{light};
    }
    std::optional<ObjectDesc> operator()(DirectionalLightDesc light) const {
        light.direction = direction(light.direction);
        return ObjectDesc{light};
    }
    std::optional<ObjectDesc> operator()(const SphereSetDesc&) const { return std::nullopt; }
    std::optional<ObjectDesc> operator()(const MeshDesc&) const { return std::nullopt; }
    std::optional<ObjectDesc> operator()(const GroupDesc&) const { return std::nullopt; }
    std::optional<ObjectDesc> operator()(const InstanceDesc&) const { return std::nullopt; }
};

// Two moves after each other are one, and so are two matrices.
void append(Transform& transform, const Transform& steps) {
    for (const auto& step : steps) {
        auto* offset = transform.empty() ? nullptr : std::get_if<Translate>(&transform.back());
        auto* matrix = transform.empty() ? nullptr : std::get_if<Matrix>(&transform.back());
        if (const auto* more = std::get_if<Translate>(&step); more != nullptr && offset != nullptr)
            offset->offset += more->offset;
        else if (const auto* outer = std::get_if<Matrix>(&step); outer != nullptr && matrix != nullptr)
            *matrix = toMatrix(toAffine({*outer}) * toAffine({*matrix}));
        else
            transform.push_back(step);
    }
}

} // namespace

std::optional<ObjectDesc> mapped(const ObjectDesc& object, const Affine& map) {
    return std::visit(Mapping{map}, object.shape);
}

SceneEdit moved(const SceneDesc& scene, const ObjectPath& path, const Transform& steps) {
    const ObjectDesc& object = *findObject(scene, path);
    const Affine groups = groupTransform(scene, path);
    Transform inside = steps;
    if (!isIdentity(groups)) inside = {toMatrix(inverse(groups).value() * toAffine(steps) * groups)};
    if (auto changed = mapped(object, toAffine(inside))) return SetObject{path, std::move(*changed)};
    const Transform* own = transformOf(object);
    if (own == nullptr) return WrapObject{path, inside};
    Transform transform = *own;
    append(transform, inside);
    return SetTransform{path, std::move(transform)};
}

Transform turned(const glm::dvec3& pivot, const glm::dvec3& axis, double degrees) {
    return {Translate{-pivot}, Rotate{axis, degrees}, Translate{pivot}};
}

Transform scaled(const glm::dvec3& pivot, const glm::dvec3& factors) {
    return {Translate{-pivot}, Scale{factors}, Translate{pivot}};
}

std::optional<glm::dvec3> lightPosition(const SceneDesc& scene, const ObjectPath& path) {
    const ObjectDesc* object = findObject(scene, path);
    if (object == nullptr) return std::nullopt;
    const Affine groups = groupTransform(scene, path);
    if (const auto* point = std::get_if<PointLightDesc>(&object->shape)) return groups.point(point->position);
    if (const auto* spot = std::get_if<SpotLightDesc>(&object->shape)) return groups.point(spot->position);
    return std::nullopt;
}

} // namespace rt::scene
