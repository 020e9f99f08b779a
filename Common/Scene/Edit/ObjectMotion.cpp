#include "Common/Scene/Edit/ObjectMotion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

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

glm::dmat3 axesAbout(const glm::dvec3& z) {
    const glm::dvec3 across = std::abs(z.x) < 0.9 * glm::length(z) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    return {across, glm::cross(z, across), z};
}

// In the space that the object is described in, not yet at right angles.
struct OwnAxes {
    glm::dmat3 operator()(const QuadDesc& quad) const {
        return {quad.edgeU, quad.edgeV, glm::cross(quad.edgeU, quad.edgeV)};
    }
    glm::dmat3 operator()(const DiskDesc& disk) const { return axesAbout(disk.normal); }
    glm::dmat3 operator()(const CylinderDesc& cylinder) const { return axesAbout(cylinder.top - cylinder.base); }
    glm::dmat3 operator()(const SpotLightDesc& light) const { return axesAbout(light.direction); }
    glm::dmat3 operator()(const DirectionalLightDesc& light) const { return axesAbout(light.direction); }
    template <typename Other>
    glm::dmat3 operator()(const Other&) const {
        return glm::dmat3(1.0);
    }
};

} // namespace

std::optional<ObjectDesc> mapped(const ObjectDesc& object, const Affine& map) {
    return std::visit(Mapping{map}, object.shape);
}

SceneEdit moved(const SceneDesc& scene, const ObjectPath& path, const Transform& steps) {
    const ObjectDesc& object = *findObject(scene, path);
    const Affine groups = groupTransform(scene, path);
    Transform inside = steps;
    if (!isIdentity(groups)) inside = {toMatrix(inverse(groups).value() * toAffine(steps) * groups)};
    if (auto changed = mapped(object, toAffine(inside))) {
        changed->hidden = object.hidden;
        return SetObject{path, std::move(*changed)};
    }
    const Transform* own = transformOf(object);
    if (own == nullptr) return WrapObject{path, inside};
    Transform transform = *own;
    append(transform, inside);
    return SetTransform{path, std::move(transform)};
}

Transform turned(const glm::dvec3& pivot, const glm::dvec3& axis, double degrees) {
    return {Translate{-pivot}, Rotate{axis, degrees}, Translate{pivot}};
}

Transform scaled(const glm::dvec3& pivot, const glm::dvec3& factors, const glm::dmat3& axes) {
    const bool isEven = factors.x == factors.y && factors.y == factors.z;
    if (isEven || axes == glm::dmat3(1.0)) return {Translate{-pivot}, Scale{factors}, Translate{pivot}};
    const Affine turned{axes * scaling(factors).linear * glm::transpose(axes), glm::dvec3(0)};
    return {Translate{-pivot}, toMatrix(turned), Translate{pivot}};
}

glm::dmat3 localAxes(const SceneDesc& scene, const ObjectPath& path) {
    const ObjectDesc* object = findObject(scene, path);
    if (object == nullptr) return glm::dmat3(1.0);
    Affine map = groupTransform(scene, path);
    if (const Transform* own = transformOf(*object)) map = map * toAffine(*own);
    const glm::dmat3 axes = map.linear * std::visit(OwnAxes{}, object->shape);
    const glm::dvec3 z = glm::normalize(axes[2]), x = glm::normalize(axes[0] - glm::dot(axes[0], z) * z);
    return {x, glm::cross(z, x), z};
}

std::optional<glm::dvec3> lightPosition(const SceneDesc& scene, const ObjectPath& path) {
    const ObjectDesc* object = findObject(scene, path);
    if (object == nullptr) return std::nullopt;
    const Affine groups = groupTransform(scene, path);
    if (const auto* point = std::get_if<PointLightDesc>(&object->shape)) return groups.point(point->position);
    if (const auto* spot = std::get_if<SpotLightDesc>(&object->shape)) return groups.point(spot->position);
    return std::nullopt;
}

Bounds mediumBounds(const SceneDesc& scene, const ObjectPath& path) {
    const ObjectDesc* object = findObject(scene, path);
    const auto* medium = object != nullptr ? std::get_if<MediumDesc>(&object->shape) : nullptr;
    Bounds own, bounds;
    if (medium == nullptr) return own;
    if (const auto* box = std::get_if<BoxBoundary>(&medium->boundary)) {
        own.add(box->min);
        own.add(box->max);
    } else {
        const auto& sphere = std::get<SphereBoundary>(medium->boundary);
        own.add(sphere.center, sphere.radius);
    }
    bounds.add(own, groupTransform(scene, path));
    return bounds;
}

// The last ones first, so that the paths of those before stay.
std::vector<SceneEdit> duplicated(const SceneDesc& scene, const std::vector<ObjectPath>& paths,
                                  std::vector<ObjectPath>& copies) {
    std::vector<SceneEdit> edits;
    copies.clear();
    for (auto path = paths.rbegin(); path != paths.rend(); ++path) {
        PlaceObject edit{*path, *findObject(scene, *path)};
        ++edit.path.indices.back();
        for (ObjectPath& copy : copies) copy = *placeAfter(edit, copy); // an insertion removes none
        copies.push_back(edit.path);
        edits.emplace_back(std::move(edit));
    }
    std::reverse(copies.begin(), copies.end());
    return edits;
}

std::vector<SceneEdit> removed(const std::vector<ObjectPath>& paths) {
    std::vector<SceneEdit> edits;
    for (auto path = paths.rbegin(); path != paths.rend(); ++path) edits.emplace_back(PlaceObject{*path, {}});
    return edits;
}

} // namespace rt::scene
