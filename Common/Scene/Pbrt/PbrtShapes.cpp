#include "Common/Scene/Pbrt/PbrtShapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>

#include <glm/geometric.hpp>

#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Pbrt/PbrtPatches.h"
#include "Common/Scene/Pbrt/PbrtPly.h"
#include "Common/Scene/Pbrt/PbrtSubdivision.h"

namespace rt::scene {

namespace {

constexpr const char* kShapes = "sphere, disk, cylinder, trianglemesh, plymesh, bilinearmesh, loopsubdiv, curve";
constexpr double kSmallestLength = 1 / kLargest;

// The front of a triangle is where its normals point, where it has some.
template <class Real>
void faceNormals(MeshOf<Real>& mesh) {
    if (mesh.normals.empty()) return;
    for (glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const glm::dvec3 flat = glm::cross(b - a, c - a);
        const glm::dvec3 sum =
            glm::dvec3(mesh.normals[t.x]) + glm::dvec3(mesh.normals[t.y]) + glm::dvec3(mesh.normals[t.z]);
        if (glm::dot(flat, sum) < 0) std::swap(t.y, t.z);
    }
}

double maxAngle(const PbrtParameters& parameters) {
    return parameters.number("phimax", 360, 0, 360);
}

bool isLongMesh(const PbrtParameters& parameters) {
    const auto isLong = [&](const char* name) { return parameters.isLong(name); };
    return isLong("P") || isLong("N") || isLong("uv") || isLong("st");
}

struct AreaOf {
    const Affine& map;

    double operator()(const SphereDesc& sphere) const {
        return 4 * std::numbers::pi * sphere.radius * sphere.radius * scale();
    }
    double operator()(const DiskDesc& disk) const {
        // Of the parallelogram that two unit vectors in its plane become.
        const glm::dvec3 n = glm::normalize(disk.normal);
        const glm::dvec3 u =
            glm::normalize(glm::cross(std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0), n));
        const double factor = glm::length(glm::cross(map.vector(u), map.vector(glm::cross(n, u))));
        return std::numbers::pi * (disk.radius * disk.radius - disk.innerRadius * disk.innerRadius) * factor;
    }
    double operator()(const CylinderDesc& cylinder) const {
        return 2 * std::numbers::pi * cylinder.radius * glm::length(cylinder.top - cylinder.base) * scale();
    }
    double operator()(const QuadDesc& quad) const {
        return glm::length(glm::cross(map.vector(quad.edgeU), map.vector(quad.edgeV)));
    }
    double operator()(const MeshDesc& mesh) const {
        if (const auto* data = std::get_if<Boxed<MeshData>>(&mesh.source)) return areaOf(**data);
        const auto* data = std::get_if<Boxed<FloatMeshData>>(&mesh.source);
        return data ? areaOf(**data) : 0;
    }
    template <class Real>
    double areaOf(const MeshOf<Real>& mesh) const {
        double area = 0;
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
            area += 0.5 * glm::length(glm::cross(map.vector(b - a), map.vector(c - a)));
        }
        return area;
    }
    template <class Other>
    double operator()(const Other&) const {
        return 0;
    }

    // Of areas, where all lengths grow alike.
    double scale() const { return std::pow(std::abs(glm::determinant(map.linear)), 2.0 / 3); }
};

} // namespace

PbrtShape PbrtShapes::make(const std::string& kind, const PbrtParameters& parameters, bool isReversed) {
    if (kind == "sphere" || kind == "cylinder") {
        PbrtShape shape = kind == "sphere" ? sphere(parameters) : cylinder(parameters);
        shape.isInsideOut = isReversed;
        return shape;
    }
    if (kind == "disk") return disk(parameters, isReversed);
    if (kind == "trianglemesh" && isLongMesh(parameters)) return meshShape(triangles<float>(parameters), isReversed);
    if (kind == "trianglemesh") return meshShape(triangles<double>(parameters), isReversed);
    if (kind == "plymesh") return ofFile(parameters, isReversed);
    if (kind == "loopsubdiv") return meshShape(subdivided(parameters), isReversed);
    if (kind == "bilinearmesh") return patches(parameters, isReversed);
    if (kind != "curve") parameters.fail("the shape is unknown; known are " + std::string(kShapes));
    for (const PbrtParameter& parameter : parameters.list) parameter.isUsed = true;
    notices_.add("curves are left out", parameters.place);
    return {};
}

// ---- round ones ----------------------------------------------------------------------------------------------------

PbrtShape PbrtShapes::sphere(const PbrtParameters& parameters) {
    SphereDesc sphere;
    sphere.radius = parameters.number("radius", 1, kSmallestLength, kLargest);
    const double lower = parameters.number("zmin", -sphere.radius), upper = parameters.number("zmax", sphere.radius);
    if (lower > -sphere.radius || upper < sphere.radius || maxAngle(parameters) < 360)
        notices_.add("parts of spheres are whole spheres", parameters.place);
    return {{{sphere}}};
}

PbrtShape PbrtShapes::disk(const PbrtParameters& parameters, bool isReversed) {
    DiskDesc disk;
    disk.center.z = parameters.number("height", 0);
    disk.normal.z = isReversed ? -1 : 1;
    disk.radius = parameters.number("radius", 1, kSmallestLength, kLargest);
    disk.innerRadius = parameters.number("innerradius", 0, 0, kLargest);
    if (!(disk.innerRadius < disk.radius)) parameters.fail("\"innerradius\" must be below \"radius\"");
    if (maxAngle(parameters) < 360) notices_.add("parts of disks are whole disks", parameters.place);
    return {{{disk}}};
}

PbrtShape PbrtShapes::cylinder(const PbrtParameters& parameters) {
    CylinderDesc cylinder;
    cylinder.radius = parameters.number("radius", 1, kSmallestLength, kLargest);
    const double a = parameters.number("zmin", -1), b = parameters.number("zmax", 1);
    cylinder.base.z = std::min(a, b);
    cylinder.top.z = std::max(a, b);
    if (!(cylinder.top.z - cylinder.base.z >= kSmallestLength)) parameters.fail("\"zmin\" and \"zmax\" must differ");
    if (maxAngle(parameters) < 360) notices_.add("parts of cylinders are whole cylinders", parameters.place);
    return {{{cylinder}}};
}

// ---- meshes --------------------------------------------------------------------------------------------------------

template <class Real>
PbrtShape PbrtShapes::meshShape(MeshOf<Real> mesh, bool isReversed) {
    faceNormals(mesh);
    if (isReversed) {
        for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
        for (auto& normal : mesh.normals) normal = -normal;
    }
    PbrtShape shape;
    shape.lights = mesh.triangles.size();
    MeshDesc desc;
    desc.source = std::move(mesh);
    shape.objects.push_back({std::move(desc)});
    return shape;
}

template <class Real>
MeshOf<Real> PbrtShapes::triangles(const PbrtParameters& parameters) {
    parameters.find("faceIndices");
    parameters.find("S"); // tangents of curves of hair and brushed metal
    MeshOf<Real> mesh = pbrtVertices<Real>(parameters);
    const std::vector<std::uint32_t> indices = pbrtIndices(parameters, mesh.positions.size(), 3);
    mesh.triangles.resize(indices.size() / 3);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        mesh.triangles[i] = {indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]};
    return mesh;
}

PbrtShape PbrtShapes::patches(const PbrtParameters& parameters, bool isReversed) {
    parameters.find("faceIndices");
    if (parameters.has("emissionfilename"))
        notices_.add("images that scale what bilinear patches emit are left out", parameters.place);
    const MeshData vertices = pbrtVertices<double>(parameters);
    const std::vector<std::uint32_t> indices = pbrtIndices(parameters, vertices.positions.size(), 4);
    if (indices.size() == 4)
        if (const std::optional<QuadDesc> quad = pbrtQuad(vertices, indices)) {
            PbrtShape shape{{{*quad}}};
            auto& made = std::get<QuadDesc>(shape.objects.front().shape);
            if (isReversed) std::swap(made.edgeU, made.edgeV);
            return shape;
        }
    bool isBent = false;
    budget_.spend(pbrtPatchTriangles(vertices, indices, isBent), parameters.place);
    if (isBent) notices_.add("bilinear patches that are not flat are cut into triangles", parameters.place);
    PbrtShape shape = meshShape(pbrtPatches(vertices, indices), isReversed);
    shape.lights = indices.size() / 4;
    return shape;
}

MeshData PbrtShapes::subdivided(const PbrtParameters& parameters) {
    constexpr int kMaxLevels = 10;
    parameters.find("scheme");
    const int levels = parameters.integer("levels", 3);
    if (levels < 0 || levels > kMaxLevels) parameters.fail("\"levels\" must be from 0 to 10");
    MeshData mesh = triangles<double>(parameters);
    budget_.spend(mesh.triangles.size() << (2 * levels), parameters.place);
    mesh.normals.clear();
    mesh.uvs.clear();
    mesh = subdividedByLoop(std::move(mesh), levels);
    if (mesh.triangles.empty()) parameters.fail("an edge has more than two triangles, or a triangle meets itself");
    return mesh;
}

PbrtShape PbrtShapes::ofFile(const PbrtParameters& parameters, bool isReversed) {
    const std::string name = parameters.string("filename", "");
    if (name.empty()) parameters.fail("\"string filename\" is missing");
    if (parameters.has("displacement")) {
        parameters.find("edgelength");
        notices_.add("displacement of meshes is left out", parameters.place);
    }
    auto mesh = loadPbrtPly(files_.existing(name, parameters.find("filename")->place), budget_);
    const auto made = [&](auto& data) { return meshShape(std::move(data), isReversed); };
    return std::visit(made, mesh);
}

double pbrtArea(const PbrtShape& shape, const Affine& toWorld) {
    double area = 0;
    for (const ObjectDesc& object : shape.objects) area += std::visit(AreaOf{toWorld}, object.shape);
    return area;
}

} // namespace rt::scene
