#include "Common/Scene/Compiler/PrimitiveSink.h"

#include <algorithm>
#include <cmath>

#include <glm/trigonometric.hpp>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/SystemMemory.h"
#include "Common/Scene/Compiler/LightTable.h"
#include "Common/Scene/Compiler/NearDivision.h"
#include "Common/Scene/Compiler/Representable.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/SpherePower.h"
#include "Common/Shared/Shape/Ellipsoids.h"

namespace rt::scene {

namespace {

constexpr double kMinRadius = 1e-9;
constexpr double kLeastVolume = 1e-4; // of what a disk's or cylinder's half axes span, over that at right angles

// Whether single precision inverts the map of an ellipsoid, as its sampling does. Long ones whose axes the map does not
// keep at right angles take too many digits.
bool isInvertible(const shared::Light& light) {
    const shared::Ellipsoid e = shared::makeEllipsoid(light.edgeU, light.edgeV, light.normal);
    const double determinant = glm::determinant(glm::dmat3(light.edgeU, light.edgeV, light.normal));
    if (!(std::abs(double(e.volume) / std::abs(determinant) - 1) < 1e-3)) return false;
    for (int axis = 0; axis < 3; ++axis) {
        shared::vec3 unit(0.0f);
        unit[axis] = 1.0f;
        if (!(glm::length(shared::toSphere(e, shared::fromSphere(e, unit)) - unit) < 1e-3f)) return false;
    }
    return true;
}

// The factor by which a map scales a sphere, when the image is a sphere again; `isOriented`: its texture shows a
// rotation.
std::optional<double> sphereScale(const Affine& map, bool isOriented) {
    const std::optional<double> scale = uniformScale(map);
    if (!scale || !isOriented) return scale;
    return map.linear == glm::dmat3(map.linear[0][0]) && map.linear[0][0] > 0 ? scale : std::nullopt;
}

} // namespace

// What all spheres of one object have in common.
struct PrimitiveSink::SphereFrame {
    Affine map;
    std::optional<double> scale; // of the map, when it leaves spheres spheres
    const MaterialDesc& material;
    bool light;
    bool isOriented;  // they show how they are turned
    bool isShareable; // unless they move
    const Placement& at;
};

template <typename Spheres>
PrimitiveSink::SphereFrame PrimitiveSink::frameOf(const Spheres& object, const Placement& at) const {
    const MaterialDesc& own = materials_.find(object.material);
    const MaterialDesc& material = at.material ? *at.material : own;
    const bool isOriented = materials_.mayShowImage(own) || materials_.mayShowImage(material);
    const Affine map = at.outer * at.local;
    const bool isShareable = !emits(own) && sphereScale(at.local, isOriented);
    return {map, sphereScale(map, isOriented), material, object.light, isOriented, isShareable, at};
}

const MaterialDesc& PrimitiveSink::materialOf(const std::string& name, const Placement& at) const {
    return at.material ? *at.material : materials_.find(name);
}

bool PrimitiveSink::isLight(std::uint32_t material, bool wanted) const {
    // Light sampling knows no vertex colours.
    const bool isColored = material < out_.principled.size() && out_.principled[material].emitsColors != 0;
    return wanted && !isColored && luminance(materials_.meanEmission(material)) > 0;
}

std::uint32_t PrimitiveSink::appendLight(shared::Light light, std::uint32_t material) {
    light.material = material;
    light.emission = shared::vec3(materials_.meanEmission(material));
    light.sides = out_.materials[material].emissionSides;
    out_.lights.push_back(light);
    return static_cast<std::uint32_t>(out_.lights.size() - 1);
}

void PrimitiveSink::expect(const PrimitiveCounts& counts) {
    reserveLarge(out_.spheres, counts.spheres);
    reserveLarge(out_.quads, counts.quads);
    reserveLarge(out_.rounds, counts.rounds);
    expected_ = counts;
}

// ---- spheres -------------------------------------------------------------------------------------------------------

void PrimitiveSink::add(const SphereDesc& object, const Placement& at) {
    const glm::dvec3 motion = object.centerEnd ? *object.centerEnd - object.center : glm::dvec3(0);
    sphere(object.center, motion, object.radius, frameOf(object, at));
}

void PrimitiveSink::add(const SphereSetDesc& object, const Placement& at) {
    const SphereFrame frame = frameOf(object, at);
    for (const glm::dvec3& center : object.centers) sphere(center, glm::dvec3(0), object.radius, frame);
}

void PrimitiveSink::sphere(const glm::dvec3& center, const glm::dvec3& motion, double radius,
                           const SphereFrame& frame) {
    const bool isMoving = motion != glm::dvec3(0);
    if (isExcluded(frame.at.part, frame.isShareable && !isMoving)) return;
    interruptionPoint();
    const glm::dvec3 c = frame.map.point(center), m = frame.map.vector(motion);
    const double r = frame.scale ? radius * *frame.scale : radius;
    if (!representable(c) || !representable(m) || !(r >= kMinRadius && r <= kMaxCoordinate)) {
        ++dropped_.spheres;
        return;
    }
    if (!frame.scale) {
        if (isMoving)
            throw InputError(out_.id + ": " + frame.at.place +
                             ": a moving sphere can be scaled uniformly only, and not be turned if it shows an image");
        ellipsoid(frame.map * translation(center) * scaling(glm::dvec3(radius)), frame);
        return;
    }
    const double largest = std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)});
    dropped_.tinySpheres += r < 8 * shared::kEpsilon * largest;

    shared::Sphere record{};
    record.center = shared::vec3(c);
    record.radius = static_cast<float>(r);
    // Of the world only: in the space of an instance the map of rays rounds by what leads from it to the world.
    record.power = !isMoving && isInWorld() ? spherePower(c, r) : shared::kInfinity;
    record.material = materials_.index(frame.material);
    record.light = shared::kNone;
    if (isLight(record.material, frame.light))
        record.light = appendLight(sphereLight(record, shared::vec3(m)), record.material);
    if (isMoving && out_.sphereMotions.empty()) out_.sphereMotions.resize(out_.spheres.size());
    if (isMoving || !out_.sphereMotions.empty()) out_.sphereMotions.emplace_back(m);
    out_.spheres.push_back(record);
    bounds_.add(c, r);
    bounds_.add(c + m, r);
}

void PrimitiveSink::ellipsoid(Affine toWorld, const SphereFrame& frame) {
    if (!inverse(toWorld)) {
        ++dropped_.spheres;
        return;
    }
    const std::uint32_t material = materials_.index(frame.material);
    std::uint32_t light = shared::kNone;
    if (isLight(material, frame.light)) {
        const glm::dmat3 axes = orthogonalColumns(toWorld.linear);
        for (int i = 0; i < 3; ++i) {
            const double length = glm::length(axes[i]);
            if (length >= kMinRadius && length <= kMaxCoordinate) continue;
            ++dropped_.spheres;
            return;
        }
        // The surface of toWorld, but for how it is turned.
        if (!frame.isOriented) toWorld.linear = axes;
        const shared::Light record = ellipsoidLight(toWorld);
        if (isInvertible(record))
            light = appendLight(record, material);
        else
            ++unsampledEllipsoids_;
    }
    ellipsoids_.push_back({toWorld, material, light});
}

// ---- quads ---------------------------------------------------------------------------------------------------------

void PrimitiveSink::add(const QuadDesc& desc, const Placement& at) {
    if (isExcluded(at.part, !emits(materials_.find(desc.material)))) return;
    quad(desc.corner, desc.edgeU, desc.edgeV, materialOf(desc.material, at), desc.light, at.outer * at.local);
}

void PrimitiveSink::add(const BoxDesc& box, const Placement& at) {
    if (isExcluded(at.part, !emits(materials_.find(box.material)))) return;
    const glm::dvec3 a = box.min, b = box.max, size = b - a;
    const glm::dvec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    const MaterialDesc& material = materialOf(box.material, at);
    const Affine map = at.outer * at.local;
    const auto face = [&](const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v) {
        quad(corner, u, v, material, box.light, map);
    };
    face({a.x, a.y, b.z}, x, y);
    face({b.x, a.y, b.z}, -z, y);
    face({b.x, a.y, a.z}, -x, y);
    face({a.x, a.y, a.z}, z, y);
    face({a.x, b.y, b.z}, x, -z);
    face({a.x, a.y, a.z}, x, z);
}

void PrimitiveSink::quad(const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v,
                         const MaterialDesc& material, bool light, const Affine& map) {
    interruptionPoint();
    shared::Quad record{};
    record.corner = shared::vec3(map.point(corner));
    record.edgeU = shared::vec3(map.vector(u));
    record.edgeV = shared::vec3(map.vector(v));
    const glm::dvec3 normal = doubleArea(shared::vec3(0), record.edgeU, record.edgeV);
    if (!representable(record.corner) || normal == glm::dvec3(0)) {
        ++dropped_.quads;
        return;
    }
    record.material = materials_.index(material);
    const glm::dvec3 first = map.point(corner), opposite = map.point(corner + u + v);
    const bool mustBeDivided = isInWorld() && (isHuge(first, map.point(corner + u), opposite) ||
                                               isHuge(first, opposite, map.point(corner + v)));
    if (mustBeDivided || (map.mirrors() && materials_.mayShowImage(material))) {
        // Triangles: huge ones are divided further, and of a mirrored one the front faces the mirrored way while its
        // texture keeps its directions, which no parallelogram says.
        MeshData halves;
        halves.positions = {corner, corner + u, corner + v, corner + u + v};
        halves.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
        halves.tangents.assign(4, glm::dvec4(u, 1));
        halves.triangles = {{0, 1, 3}, {0, 3, 2}};
        Placement placement;
        placement.outer = map;
        add(halves, material, light, placement);
        return;
    }
    if (map.mirrors()) std::swap(record.edgeU, record.edgeV);
    record.normal = shared::vec3(glm::normalize(map.mirrors() ? -normal : normal));
    record.light = isLight(record.material, light) ? appendLight(quadLight(record), record.material) : shared::kNone;
    out_.quads.push_back(record);
    const glm::dvec3 c = record.corner, e = record.edgeU, f = record.edgeV;
    for (const glm::dvec3& vertex : {c, c + e, c + f, c + e + f}) bounds_.add(vertex);
}

// ---- disks and cylinders -------------------------------------------------------------------------------------------

void PrimitiveSink::add(const DiskDesc& disk, const Placement& at) {
    if (isExcluded(at.part, !emits(materials_.find(disk.material)))) return;
    const Affine map = at.outer * at.local;
    const glm::dmat3 frame = frameAround(glm::normalize(disk.normal));
    const glm::dvec3 u = map.vector(disk.radius * frame[0]), v = map.vector(disk.radius * frame[1]);
    const glm::dvec3 normal = glm::cross(u, v);
    shared::Round record{};
    record.origin = shared::vec3(map.point(disk.center));
    record.edgeU = shared::vec3(u);
    record.edgeV = shared::vec3(v);
    record.axis = shared::vec3(glm::normalize(map.mirrors() ? -normal : normal));
    record.hole = static_cast<float>(disk.innerRadius / disk.radius);
    round(record, materialOf(disk.material, at), disk.light);
}

void PrimitiveSink::add(const CylinderDesc& cylinder, const Placement& at) {
    if (isExcluded(at.part, !emits(materials_.find(cylinder.material)))) return;
    const Affine map = at.outer * at.local;
    const glm::dvec3 axis = cylinder.top - cylinder.base;
    const glm::dmat3 frame = frameAround(glm::normalize(axis));
    shared::Round record{};
    record.origin = shared::vec3(map.point(cylinder.base));
    record.edgeU = shared::vec3(map.vector(cylinder.radius * frame[0]));
    record.edgeV = shared::vec3(map.vector(cylinder.radius * frame[1]));
    record.axis = shared::vec3(map.vector(axis));
    record.hole = -1;
    round(record, materialOf(cylinder.material, at), cylinder.light);
}

void PrimitiveSink::round(shared::Round record, const MaterialDesc& material, bool light) {
    interruptionPoint();
    const glm::dvec3 o(record.origin), u(record.edgeU), v(record.edgeV), w(record.axis);
    const double volume = std::abs(glm::dot(glm::cross(u, v), w));
    const double shortest = std::min({glm::length(u), glm::length(v), glm::length(w)});
    const bool isUsable = representable(o) && representable(u) && representable(v) && representable(w);
    if (!isUsable || !(shortest >= kMinRadius) ||
        !(volume >= kLeastVolume * glm::length(u) * glm::length(v) * glm::length(w))) {
        ++dropped_.rounds;
        return;
    }
    const bool isDisk = record.hole >= 0;
    record.material = materials_.index(material);
    record.light = shared::kNone;
    if (isLight(record.material, light))
        record.light = appendLight(isDisk ? diskLight(record) : cylinderLight(record), record.material);
    out_.rounds.push_back(record);
    // Of the ellipse's image along each axis.
    const glm::dvec3 reach = glm::sqrt(u * u + v * v);
    for (const glm::dvec3& center : {o, isDisk ? o : o + w}) {
        bounds_.add(center - reach);
        bounds_.add(center + reach);
    }
}

// ---- punctual lights -----------------------------------------------------------------------------------------------

void PrimitiveSink::add(const PointLightDesc& light, const Placement& at) {
    if (at.part == Part::Shared) return;
    const glm::dvec3 position = (at.outer * at.local).point(light.position);
    appendPunctual(pointLight(position, light.intensity));
}

void PrimitiveSink::add(const SpotLightDesc& light, const Placement& at) {
    if (at.part == Part::Shared) return;
    const Affine map = at.outer * at.local;
    appendPunctual(spotLight(map.point(light.position), glm::normalize(map.vector(light.direction)), light.intensity,
                             glm::radians(light.innerAngle), glm::radians(light.outerAngle)));
}

void PrimitiveSink::add(const DirectionalLightDesc& light, const Placement& at) {
    if (at.part == Part::Shared) return;
    const Affine map = at.outer * at.local;
    appendPunctual(directionalLight(glm::normalize(map.vector(light.direction)), light.irradiance));
}

void PrimitiveSink::appendPunctual(const shared::Light& light) {
    if (!(luminance(light.emission) > 0)) return;
    if (representable(light.position) && representable(light.normal))
        out_.lights.push_back(light);
    else
        ++dropped_.lights;
}

// ---- totals --------------------------------------------------------------------------------------------------------

Bounds PrimitiveSink::finishGeometry() {
    shared::Geometry geometry{};
    if (!out_.geometries.empty()) {
        const shared::Geometry& last = out_.geometries.back();
        geometry.firstSphere = last.firstSphere + last.sphereCount;
        geometry.firstQuad = last.firstQuad + last.quadCount;
        geometry.firstTriangle = last.firstTriangle + last.triangleCount;
        geometry.firstRound = last.firstRound + last.roundCount;
    }
    geometry.sphereCount = static_cast<std::uint32_t>(out_.spheres.size()) - geometry.firstSphere;
    geometry.quadCount = static_cast<std::uint32_t>(out_.quads.size()) - geometry.firstQuad;
    geometry.triangleCount = static_cast<std::uint32_t>(out_.triangles.size()) - geometry.firstTriangle;
    geometry.roundCount = static_cast<std::uint32_t>(out_.rounds.size()) - geometry.firstRound;
    out_.geometries.push_back(geometry);
    const Bounds bounds = bounds_;
    bounds_ = {};
    return bounds;
}

void PrimitiveSink::appendNotices(std::vector<std::string>& notices) const {
    const auto note = [&](std::uint64_t count, const char* one, const char* many) {
        if (count > 0) notices.push_back(counted(count, one, many));
    };
    note(dropped_.spheres, "sphere without a usable centre or radius was dropped",
         "spheres without a usable centre or radius were dropped");
    note(dropped_.quads, "quad without area was dropped", "quads without area were dropped");
    note(dropped_.triangles, "triangle without area was dropped", "triangles without area were dropped");
    note(dropped_.rounds, "disk or cylinder without a usable place or extent was dropped",
         "disks or cylinders without a usable place or extent were dropped");
    note(dropped_.lights, "light without a usable position or direction was dropped",
         "lights without a usable position or direction were dropped");
    note(unsampledEllipsoids_, "emissive sphere is scaled so unequally that light sampling leaves it out",
         "emissive spheres are scaled so unequally that light sampling leaves them out");
    note(dropped_.tinySpheres, "sphere is smaller than the spacing of single-precision numbers at its place",
         "spheres are smaller than the spacing of single-precision numbers at their place");
}

} // namespace rt::scene
