// Reading of scene files: objects, transforms and importance targets.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <glm/geometric.hpp>

#include "Common/Core/Interruption.h"
#include "Common/Core/Parallel.h"
#include "Common/Core/SystemMemory.h"
#include "Common/Scene/Affine.h"
#include "Common/Scene/Builtin/Placeholders.h"
#include "Common/Scene/Edit/ObjectPath.h"
#include "Common/Scene/Json/SceneReader.h"

namespace rt::scene {

namespace {

constexpr double kMinSpotAngle = 1e-3; // degrees: narrower ones single precision cannot aim

// ---- transforms ----------------------------------------------------------------------------------------------------

Rotate readRotate(const JsonNode& node) {
    node.expectKeys({"axis", "degrees"});
    const Rotate rotate{node.at("axis").vector(), node.at("degrees").number()};
    if (!(glm::length(rotate.axis) > 0)) node.at("axis").failValue("a vector that is not 0");
    return rotate;
}

Scale readScale(const JsonNode& node) {
    const glm::dvec3 factors = node.value().is_number() ? glm::dvec3(node.number()) : node.vector();
    if (factors.x == 0 || factors.y == 0 || factors.z == 0) node.failValue("numbers that are not 0");
    return {factors};
}

Matrix readMatrix(const JsonNode& node) {
    const std::vector<double> values = node.numbers(12);
    Matrix matrix;
    if (values.size() != matrix.rows.size()) node.failValue("12 numbers: three rows of four");
    std::copy(values.begin(), values.end(), matrix.rows.begin());
    if (!inverse(toAffine({matrix}))) node.failValue("an invertible map");
    return matrix;
}

Transform readTransform(const JsonNode& node) {
    Transform transform;
    node.forEachElement([&](const JsonNode& step) {
        step.expectKeys({"translate", "rotate", "scale", "matrix"});
        if (step.value().size() != 1) step.fail("a step must be one of translate, rotate, scale, matrix");
        if (const auto offset = step.find("translate")) transform.emplace_back(Translate{offset->vector()});
        if (const auto rotate = step.find("rotate")) transform.emplace_back(readRotate(*rotate));
        if (const auto scale = step.find("scale")) transform.emplace_back(readScale(*scale));
        if (const auto matrix = step.find("matrix")) transform.emplace_back(readMatrix(*matrix));
    });
    return transform;
}

// What any object may have, besides the keys of its kind.
void expectObject(const JsonNode& node, std::initializer_list<const char*> keys) {
    std::vector<const char*> allowed(keys);
    allowed.push_back("hidden");
    node.expectKeys(allowed);
}

// ---- surfaces ------------------------------------------------------------------------------------------------------

template <typename Surface>
Surface readSurface(Surface surface, const JsonNode& node, const SceneReferences& references) {
    surface.material = references.name(node.at("material"), "materials");
    if (const auto light = node.find("light")) surface.light = light->boolean();
    return surface;
}

glm::dvec3 readDirection(const JsonNode& node) {
    const glm::dvec3 direction = node.vector();
    if (!(glm::length(direction) > 0)) node.failValue("a vector that is not 0");
    return direction;
}

std::vector<glm::dvec3> readVectors(const JsonNode& node) {
    const std::vector<double> values = node.numbers(3);
    std::vector<glm::dvec3> vectors(values.size() / 3);
    for (std::size_t i = 0; i < vectors.size(); ++i) vectors[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    return vectors;
}

SphereDesc readSphere(const JsonNode& node) {
    expectObject(node, {"type", "center", "center_end", "radius", "material", "light"});
    SphereDesc sphere;
    sphere.center = node.at("center").vector();
    sphere.radius = node.at("radius").positive();
    if (const auto end = node.find("center_end")) sphere.centerEnd = end->vector();
    return sphere;
}

SphereSetDesc readSphereSet(const JsonNode& node) {
    expectObject(node, {"type", "centers", "radius", "material", "light"});
    SphereSetDesc spheres;
    spheres.centers = readVectors(node.at("centers"));
    spheres.radius = node.at("radius").positive();
    return spheres;
}

SphereBoundary readSphereShape(const JsonNode& node) {
    return {node.at("center").vector(), node.at("radius").positive()};
}

QuadDesc readQuadShape(const JsonNode& node) {
    QuadDesc quad;
    quad.corner = node.at("corner").vector();
    quad.edgeU = node.at("edge_u").vector();
    quad.edgeV = node.at("edge_v").vector();
    const double area = glm::length(glm::cross(quad.edgeU, quad.edgeV));
    if (!(area > 0) || !std::isfinite(area)) node.fail("edge_u and edge_v must span an area");
    return quad;
}

BoxBoundary readBoxShape(const JsonNode& node) {
    const BoxBoundary box{node.at("min").vector(), node.at("max").vector()};
    if (!(box.min.x < box.max.x && box.min.y < box.max.y && box.min.z < box.max.z))
        node.fail("each component of min must be below that of max");
    return box;
}

BoxDesc readBox(const JsonNode& node) {
    expectObject(node, {"type", "min", "max", "material", "light"});
    const BoxBoundary shape = readBoxShape(node);
    BoxDesc box;
    box.min = shape.min;
    box.max = shape.max;
    return box;
}

// From 0 to below `limit`, the value of the key `name` beside it.
double readBelow(const JsonNode& node, double limit, const char* name) {
    const double value = node.number();
    if (!(value >= 0 && value < limit)) node.failValue(std::string("a number from 0 to below ") + name);
    return value;
}

DiskDesc readDisk(const JsonNode& node) {
    expectObject(node, {"type", "center", "normal", "radius", "inner_radius", "material", "light"});
    DiskDesc disk;
    disk.center = node.at("center").vector();
    disk.normal = readDirection(node.at("normal"));
    disk.radius = node.at("radius").positive();
    if (const auto inner = node.find("inner_radius")) disk.innerRadius = readBelow(*inner, disk.radius, "radius");
    return disk;
}

CylinderDesc readCylinder(const JsonNode& node) {
    expectObject(node, {"type", "base", "top", "radius", "material", "light"});
    CylinderDesc cylinder;
    cylinder.base = node.at("base").vector();
    cylinder.top = node.at("top").vector();
    cylinder.radius = node.at("radius").positive();
    if (!(glm::length(cylinder.top - cylinder.base) > 0)) node.fail("base and top must be apart");
    return cylinder;
}

// ---- meshes --------------------------------------------------------------------------------------------------------

std::vector<glm::uvec3> readTriangles(const JsonNode& node, std::size_t vertexCount) {
    const std::size_t count = node.arraySize();
    if (count == 0 || count % 3 != 0) node.failValue("an array whose length is a multiple of 3 and not 0");
    std::vector<glm::uvec3> triangles(count / 3);
    for (std::size_t i = 0; i < count; ++i) {
        interruptionPoint();
        const JsonNode index = node.element(i);
        const bool isIndex = index.value().is_number_unsigned() && index.value().get<std::uint64_t>() < vertexCount;
        if (!isIndex) index.failValue("the index of a position, 0 to " + std::to_string(vertexCount - 1));
        triangles[i / 3][static_cast<int>(i % 3)] = index.value().get<std::uint32_t>();
    }
    return triangles;
}

MeshData readMeshData(const JsonNode& node) {
    MeshData data;
    data.positions = readVectors(node.at("positions"));
    const auto expectOneEach = [&](const JsonNode& attribute, std::size_t count) {
        if (count != data.positions.size())
            attribute.failValue("one for each of the " + std::to_string(data.positions.size()) + " positions");
    };
    if (const auto normals = node.find("normals")) {
        data.normals = readVectors(*normals);
        expectOneEach(*normals, data.normals.size());
    }
    const auto readEach = [&](const char* name, auto& vectors) {
        const auto attribute = node.find(name);
        if (!attribute) return;
        using Vector = typename std::decay_t<decltype(vectors)>::value_type;
        constexpr auto kWidth = static_cast<std::size_t>(Vector::length());
        const std::vector<double> values = attribute->numbers(kWidth);
        expectOneEach(*attribute, values.size() / kWidth);
        vectors.resize(values.size() / kWidth);
        for (std::size_t i = 0; i < values.size(); ++i) vectors[i / kWidth][static_cast<int>(i % kWidth)] = values[i];
    };
    readEach("uvs", data.uvs);
    readEach("uvs2", data.uvs2);
    readEach("colors", data.colors);
    readEach("tangents", data.tangents);
    data.triangles = readTriangles(node.at("triangles"), data.positions.size());
    return data;
}

MeshDesc readMesh(const JsonNode& node, const SceneReferences& references) {
    MeshDesc mesh;
    if (node.has("file")) {
        expectObject(node, {"type", "file", "stand_in", "material", "light"});
        MeshFile source;
        if (const auto standIn = node.find("stand_in")) source.standIn = readChoice(*standIn, meshStandInNames());
        source.file = references.file(node.at("file"), !source.standIn.empty());
        mesh.source = source;
    } else {
        expectObject(node, {"type", "positions", "normals", "uvs", "uvs2", "colors", "tangents", "triangles",
                            "material", "light"});
        mesh.source = readMeshData(node);
    }
    // Only a file can bring materials of its own.
    if (node.has("material") || !node.has("file")) mesh.material = references.name(node.at("material"), "materials");
    if (const auto light = node.find("light")) mesh.light = light->boolean();
    return mesh;
}

// ---- other objects -------------------------------------------------------------------------------------------------

MediumDesc readMedium(const JsonNode& node, const SceneReferences& references) {
    expectObject(node, {"type", "boundary", "density", "albedo"});
    MediumDesc medium;
    const JsonNode boundary = node.at("boundary");
    if (boundary.at("type").oneOf({"sphere", "box"}) == "sphere") {
        boundary.expectKeys({"type", "center", "radius"});
        medium.boundary = readSphereShape(boundary);
    } else {
        boundary.expectKeys({"type", "min", "max"});
        medium.boundary = readBoxShape(boundary);
    }
    medium.density = node.at("density").positive();
    if (const auto albedo = node.find("albedo")) medium.albedo = references.colorOrTexture(*albedo);
    return medium;
}

PointLightDesc readPointLight(const JsonNode& node) {
    expectObject(node, {"type", "position", "intensity"});
    return {node.at("position").vector(), node.at("intensity").vectorWithin(0, kLargest)};
}

SpotLightDesc readSpotLight(const JsonNode& node) {
    expectObject(node, {"type", "position", "direction", "intensity", "inner_angle", "outer_angle"});
    SpotLightDesc light;
    light.position = node.at("position").vector();
    light.direction = readDirection(node.at("direction"));
    light.intensity = node.at("intensity").vectorWithin(0, kLargest);
    if (const auto outer = node.find("outer_angle")) light.outerAngle = outer->within(kMinSpotAngle, 90);
    if (const auto inner = node.find("inner_angle"))
        light.innerAngle = readBelow(*inner, light.outerAngle, "outer_angle");
    return light;
}

DirectionalLightDesc readDirectionalLight(const JsonNode& node) {
    expectObject(node, {"type", "direction", "irradiance"});
    return {readDirection(node.at("direction")), node.at("irradiance").vectorWithin(0, kLargest)};
}

GroupDesc readGroup(const JsonNode& node, const SceneReferences& references) {
    expectObject(node, {"type", "transform", "objects"});
    GroupDesc group;
    if (const auto transform = node.find("transform")) group.transform = readTransform(*transform);
    group.objects = readObjects(node.at("objects"), references);
    return group;
}

InstanceDesc readInstance(const JsonNode& node, const SceneReferences& references) {
    expectObject(node, {"type", "prototype", "transform", "material"});
    InstanceDesc instance;
    instance.prototype = references.name(node.at("prototype"), "prototypes");
    if (const auto transform = node.find("transform")) instance.transform = readTransform(*transform);
    if (const auto material = node.find("material")) instance.material = references.name(*material, "materials");
    return instance;
}

// What a model's object becomes, by what it was.
ObjectDesc readImported(const JsonNode& node, const SceneReferences& references) {
    expectObject(node, {"type", "transform", "material"});
    ObjectDesc object = *references.original();
    if (const auto transform = node.find("transform")) {
        Transform* const own = transformOf(object);
        if (own == nullptr) transform->fail("that object of the model has no transform: put it into a group");
        *own = readTransform(*transform);
    }
    if (const auto material = node.find("material")) {
        std::string* const own = materialNameOf(object);
        if (own == nullptr) material->fail("that object of the model has no material");
        const bool isKept = material->value() == "" && std::holds_alternative<InstanceDesc>(object.shape);
        *own = isKept ? "" : references.name(*material, "materials"); // that of each surface
    }
    return object;
}

ObjectDesc readShape(const JsonNode& node, const SceneReferences& references) {
    if (references.original() != nullptr && node.at("type").value() == "imported")
        return readImported(node, references);
    const std::string type =
        node.at("type").oneOf({"sphere", "spheres", "quad", "box", "disk", "cylinder", "mesh", "medium", "point_light",
                               "spot_light", "directional_light", "group", "instance"});
    if (type == "sphere") return {readSurface(readSphere(node), node, references)};
    if (type == "spheres") return {readSurface(readSphereSet(node), node, references)};
    if (type == "box") return {readSurface(readBox(node), node, references)};
    if (type == "disk") return {readSurface(readDisk(node), node, references)};
    if (type == "cylinder") return {readSurface(readCylinder(node), node, references)};
    if (type == "mesh") return {readMesh(node, references)};
    if (type == "medium") return {readMedium(node, references)};
    if (type == "point_light") return {readPointLight(node)};
    if (type == "spot_light") return {readSpotLight(node)};
    if (type == "directional_light") return {readDirectionalLight(node)};
    if (type == "group") return {readGroup(node, references)};
    if (type == "instance") return {readInstance(node, references)};
    expectObject(node, {"type", "corner", "edge_u", "edge_v", "material", "light"});
    return {readSurface(readQuadShape(node), node, references)};
}

ObjectDesc readObject(const JsonNode& node, const SceneReferences& references) {
    ObjectDesc object = readShape(node, references);
    if (const auto hidden = node.find("hidden")) object.hidden = hidden->boolean();
    return object;
}

} // namespace

std::vector<ObjectDesc> readObjects(const JsonNode& node, const SceneReferences& references) {
    std::vector<ObjectDesc> objects;
    objects.reserve(node.arraySize());
    node.forEachElement([&](const JsonNode& element) { objects.push_back(readObject(element, references)); });
    return objects;
}

std::vector<ObjectDesc> readObjects(const JsonNode& node, const SceneReferences& references, const LongJson& text) {
    if (text.elementCount() == 0) return readObjects(node, references);
    constexpr std::size_t kElementsPerChunk = 256;
    std::vector<ObjectDesc> objects;
    resizeLarge(objects, text.elementCount());
    parallelChunks(0, objects.size(), kElementsPerChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            interruptionPoint();
            const LargeJson element = text.element(i);
            objects[i] = readObject(JsonNode(*element, node, i), references);
        }
    });
    return objects;
}

TargetDesc readTarget(const JsonNode& node) {
    if (node.at("type").oneOf({"sphere", "quad"}) == "sphere") {
        node.expectKeys({"type", "center", "radius"});
        return {readSphereShape(node)};
    }
    node.expectKeys({"type", "corner", "edge_u", "edge_v"});
    return {readQuadShape(node)};
}

} // namespace rt::scene
