#include "Common/Scene/Gltf/GltfWriter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Scene/Affine.h"
#include "Common/Scene/Builtin/Placeholders.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/Daylight.h"
#include "Common/Scene/Gltf/GltfMeshWriter.h"
#include "Common/Scene/Gltf/GltfPower.h"
#include "Common/Scene/Obj/ObjLoader.h"
#include "Common/Scene/Placing.h"
#include "Common/Scene/Studio.h"
#include "Common/Scene/Tessellation.h"
#include "Common/Scene/UniqueNames.h"

namespace rt::scene {

namespace {

constexpr std::size_t kMaxObjects = 1 << 24; // each instance's counted again
constexpr std::size_t kMaxNesting = 64;      // of prototypes in prototypes

// Columns of four.
OrderedJson matrixOf(const Affine& map) {
    OrderedJson matrix = OrderedJson::array();
    for (int column = 0; column < 4; ++column) {
        const glm::dvec3& c = column < 3 ? map.linear[column] : map.offset;
        for (int row = 0; row < 3; ++row) matrix.push_back(c[row]);
        matrix.push_back(column < 3 ? 0 : 1);
    }
    return matrix;
}

// Whether translation, rotation and scale make it, as glTF wants it of a node.
bool hasAxes(const Affine& map) {
    constexpr double kSkew = 1e-6;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 &a = map.linear[i], &b = map.linear[(i + 1) % 3];
        if (std::abs(glm::dot(a, b)) > kSkew * glm::length(a) * glm::length(b)) return false;
    }
    return true;
}

// Turns -z to a direction.
Affine lookingAlong(const glm::dvec3& direction, const glm::dvec3& position) {
    return {frameAround(-glm::normalize(direction)), position};
}

class SceneToGltf {
  public:
    SceneToGltf(const SceneDesc& scene, const std::filesystem::path& file, const GltfImageTools& tools)
        : scene_(scene),
          document_(file),
          materials_(scene, tools, document_, notices_),
          meshes_(document_, materials_, notices_) {}

    std::vector<std::string> run() {
        addAll();
        addCameras();
        addSky();
        OrderedJson scene = {{"nodes", roots_}};
        if (!scene_.title.empty()) scene["name"] = scene_.title;
        document_.root()["scene"] = 0;
        document_.add("scenes", std::move(scene));
        noticeRest();
        document_.write();
        return notices_.lines();
    }

  private:
    using Nodes = std::vector<int>;

    // Where objects stand.
    struct Place {
        Affine toWorld;
        const std::string* material = nullptr; // replaces the objects' own unless null
    };

    void addAll() {
        const std::optional<std::size_t> studio = studioOf(scene_);
        if (studio) notices_.add("the studio is left out: it surrounds the model again where the file is read");
        hasStudio_ = studio.has_value();
        for (std::size_t i = 0; i < scene_.objects.size(); ++i)
            if (i != studio) addObject(scene_.objects[i], {}, roots_);
    }

    // ---- the hierarchy ----------------------------------------------------------------------------------------------

    // What is not the identity becomes one node, or two where it is askew: the outer one scales along axes, the inner
    // one turns what it scales.
    int addPlaced(OrderedJson node, const Affine& map) {
        if (isIdentity(map)) return document_.add("nodes", std::move(node));
        if (hasAxes(map)) {
            node["matrix"] = matrixOf(map);
            return document_.add("nodes", std::move(node));
        }
        const Affine outer{orthogonalColumns(map.linear), map.offset};
        if (const auto back = inverse(outer)) {
            node["matrix"] = matrixOf(Affine{back->linear * map.linear, glm::dvec3(0)});
            const int inner = document_.add("nodes", std::move(node));
            return document_.add("nodes", {{"matrix", matrixOf(outer)}, {"children", {inner}}});
        }
        node["matrix"] = matrixOf(map);
        return document_.add("nodes", std::move(node));
    }

    // Meshes alone are one mesh of the file.
    void addGroup(const std::vector<ObjectDesc>& objects, const Affine& map, const Place& place,
                  const std::string& name, Nodes& nodes) {
        OrderedJson node = OrderedJson::object();
        if (!name.empty()) node["name"] = name;
        const bool areMeshes = std::all_of(objects.begin(), objects.end(), [](const ObjectDesc& object) {
            return object.hidden || std::holds_alternative<MeshDesc>(object.shape);
        });
        if (areMeshes) {
            std::vector<GltfMeshWriter::Surface> surfaces;
            for (const ObjectDesc& object : objects)
                if (!isLeftOut(object)) addSurfaces(std::get<MeshDesc>(object.shape), place, surfaces);
            const auto mesh = meshes_.mesh(surfaces, name.empty() ? "mesh" : name);
            if (!mesh) return;
            node["mesh"] = *mesh;
        } else {
            Nodes children;
            for (const ObjectDesc& object : objects) addObject(object, place, children);
            if (children.empty()) return;
            node["children"] = std::move(children);
        }
        nodes.push_back(addPlaced(std::move(node), map));
    }

    bool isLeftOut(const ObjectDesc& object) {
        interruptionPoint();
        if (++visited_ > kMaxObjects)
            throw InputError(scene_.id + ": the scene comes to more than 2^24 objects, instances counted one by one");
        hidden_ += object.hidden;
        return object.hidden;
    }

    void addObject(const ObjectDesc& object, const Place& place, Nodes& nodes) {
        if (isLeftOut(object)) return;
        std::visit([&](const auto& shape) { addShape(shape, place, nodes); }, object.shape);
    }

    void addShape(const GroupDesc& group, const Place& place, Nodes& nodes) {
        const Affine map = toAffine(group.transform);
        addGroup(group.objects, map, {place.toWorld * map, place.material}, {}, nodes);
    }

    void addShape(const InstanceDesc& instance, const Place& place, Nodes& nodes) {
        const auto prototype = scene_.prototypes.find(instance.prototype);
        if (prototype == scene_.prototypes.end())
            throw InputError(scene_.id + ": prototype \"" + instance.prototype + "\" is not defined");
        if (++depth_ > kMaxNesting)
            throw InputError(scene_.id + ": prototype \"" + instance.prototype + "\" is nested deeper than " +
                             std::to_string(kMaxNesting) + " or contains itself");
        const Affine map = toAffine(instance.transform);
        const bool replaces = place.material == nullptr && !instance.material.empty();
        addGroup(prototype->second, map, {place.toWorld * map, replaces ? &instance.material : place.material},
                 instance.prototype, nodes);
        --depth_;
    }

    // ---- surfaces ---------------------------------------------------------------------------------------------------

    template <typename Surface>
    static const std::string& materialOf(const Surface& surface, const Place& place) {
        return place.material != nullptr ? *place.material : surface.material;
    }

    template <typename Shape>
    void addTriangles(const char* name, const Shape& shape, const Place& place, Nodes& nodes) {
        if (const auto mesh = meshes_.ownMesh(meshOf(shape), materialOf(shape, place), name))
            nodes.push_back(document_.add("nodes", {{"mesh", *mesh}}));
    }
    void addShape(const QuadDesc& quad, const Place& place, Nodes& nodes) { addTriangles("quad", quad, place, nodes); }
    void addShape(const BoxDesc& box, const Place& place, Nodes& nodes) { addTriangles("box", box, place, nodes); }
    void addShape(const DiskDesc& disk, const Place& place, Nodes& nodes) { addTriangles("disk", disk, place, nodes); }
    void addShape(const CylinderDesc& cylinder, const Place& place, Nodes& nodes) {
        addTriangles("cylinder", cylinder, place, nodes);
    }

    void addShape(const SphereDesc& sphere, const Place& place, Nodes& nodes) {
        if (sphere.centerEnd) notices_.leaveOut("the motion of a sphere", "motions of spheres");
        addSphere(sphere.center, sphere.radius, materialOf(sphere, place), place, nodes);
    }
    void addShape(const SphereSetDesc& set, const Place& place, Nodes& nodes) {
        for (const glm::dvec3& center : set.centers)
            addSphere(center, set.radius, materialOf(set, place), place, nodes);
    }

    // The same mesh for all but those so large that the camera looks at what stands on them.
    void addSphere(const glm::dvec3& center, double radius, const std::string& material, const Place& place,
                   Nodes& nodes) {
        if (unitSphere_.triangles.empty()) unitSphere_ = sphereMesh();
        const std::optional<glm::dvec3> towards = directionOfInterest(center, radius, place);
        const auto mesh = towards && !materials_.showsImage(material)
                              ? meshes_.ownMesh(sphereMesh(*towards), material, "sphere")
                              : meshes_.mesh({{&unitSphere_, material}}, "sphere");
        OrderedJson node = {{"mesh", *mesh}};
        if (center != glm::dvec3(0)) node["translation"] = arrayOf(center);
        if (radius != 1) node["scale"] = arrayOf(glm::dvec3(radius));
        nodes.push_back(document_.add("nodes", std::move(node)));
    }

    // From the middle of a sphere to what the camera looks at, where that is close to its surface.
    std::optional<glm::dvec3> directionOfInterest(const glm::dvec3& center, double radius, const Place& place) const {
        constexpr double kClose = 0.125; // radii
        const std::optional<double> scale = uniformScale(place.toWorld);
        const auto fromWorld = inverse(place.toWorld);
        if (!scale || !fromWorld) return std::nullopt;
        const glm::dvec3 offset = scene_.camera.lookAt - place.toWorld.point(center);
        const double distance = glm::length(offset), size = radius * *scale;
        if (!(std::abs(distance - size) < kClose * size)) return std::nullopt;
        return glm::normalize(fromWorld->vector(offset));
    }

    void addShape(const MeshDesc& mesh, const Place& place, Nodes& nodes) {
        std::vector<GltfMeshWriter::Surface> surfaces;
        addSurfaces(mesh, place, surfaces);
        const std::string name = surfaces.empty() ? std::string() : surfaces.front().material;
        if (const auto index = meshes_.mesh(surfaces, name))
            nodes.push_back(document_.add("nodes", {{"mesh", *index}}));
    }

    void addSurfaces(const MeshDesc& mesh, const Place& place, std::vector<GltfMeshWriter::Surface>& surfaces) {
        const std::string& material = materialOf(mesh, place);
        if (const auto* data = std::get_if<Boxed<MeshData>>(&mesh.source)) {
            surfaces.push_back({&**data, material});
            return;
        }
        for (const ObjPart& part : model(std::get<MeshFile>(mesh.source), material.empty()).parts)
            surfaces.push_back({&part.mesh, !material.empty()       ? material
                                            : part.material.empty() ? plain_
                                                                    : part.material});
    }

    const ObjModel& model(const MeshFile& source, bool withMaterials) {
        const auto [entry, isNew] = models_.try_emplace({source.file + '\n' + source.standIn, withMaterials});
        if (!isNew) return *entry->second;
        std::vector<std::string> notices;
        if (const auto path = locateAsset(source.file, source.standIn, {}, scene_.id, notices)) {
            entry->second = std::make_unique<ObjModel>(loadObj(*path, withMaterials, source.file + "/"));
        } else {
            entry->second = std::make_unique<ObjModel>();
            entry->second->parts.push_back({{}, makeMeshStandIn(source.standIn)});
            notices_.add(source.file + ": a generated mesh stands in");
        }
        materials_.add(entry->second->materials, entry->second->textures);
        while (plain_.empty() || scene_.materials.count(plain_) > 0) plain_ += "plain";
        materials_.add({{plain_, plainMaterial()}}, {});
        return *entry->second;
    }

    // ---- lights -----------------------------------------------------------------------------------------------------

    void addLight(OrderedJson light, const glm::dvec3& power, const Affine& map, Nodes& nodes) {
        const GltfPower split = toPower(power, 0);
        light["color"] = arrayOf(split.color);
        light["intensity"] = split.strength;
        const int index = document_.addOf("KHR_lights_punctual", "lights", std::move(light));
        OrderedJson node;
        node["extensions"]["KHR_lights_punctual"]["light"] = index;
        nodes.push_back(addPlaced(std::move(node), map));
    }
    void addShape(const PointLightDesc& light, const Place&, Nodes& nodes) {
        addLight({{"type", "point"}}, light.intensity, translation(light.position), nodes);
    }
    void addShape(const SpotLightDesc& light, const Place&, Nodes& nodes) {
        OrderedJson spot = {{"innerConeAngle", glm::radians(light.innerAngle)},
                            {"outerConeAngle", glm::radians(light.outerAngle)}};
        addLight({{"type", "spot"}, {"spot", std::move(spot)}}, light.intensity,
                 lookingAlong(light.direction, light.position), nodes);
    }
    void addShape(const DirectionalLightDesc& light, const Place&, Nodes& nodes) {
        addLight({{"type", "directional"}}, light.irradiance, lookingAlong(light.direction, glm::dvec3(0)), nodes);
    }
    void addShape(const MediumDesc&, const Place&, Nodes&) { notices_.leaveOut("one medium", "media"); }

    // ---- cameras ----------------------------------------------------------------------------------------------------

    void addCamera(const CameraDesc& camera, const std::string& name) {
        constexpr double kNearest = 1e-3; // of the distance to what is in focus
        const glm::dvec3 back = glm::normalize(camera.lookFrom - camera.lookAt);
        const glm::dvec3 right = glm::normalize(glm::cross(camera.up, back));
        const Affine map{{right, glm::cross(back, right), back}, camera.lookFrom};
        const OrderedJson perspective = {{"aspectRatio", scene_.render.aspect},
                                         {"yfov", glm::radians(camera.verticalFov)},
                                         {"znear", kNearest * camera.focusDistance}};
        const int index =
            document_.add("cameras", {{"type", "perspective"}, {"name", name}, {"perspective", perspective}});
        roots_.push_back(addPlaced({{"name", name}, {"camera", index}}, map));
        if (camera.defocusAngle > 0) notices_.leaveOut("the lens of a camera", "lenses of cameras");
    }

    // The one that the scene is seen with comes first.
    void addCameras() {
        const auto same = std::find_if(scene_.cameras.begin(), scene_.cameras.end(),
                                       [this](const auto& named) { return named.second == scene_.camera; });
        UniqueNames names;
        for (const auto& [name, camera] : scene_.cameras) (void)names.unique(name, "camera", 0);
        addCamera(scene_.camera, same != scene_.cameras.end() ? same->first : names.unique("camera", "camera", 0));
        for (auto camera = scene_.cameras.begin(); camera != scene_.cameras.end(); ++camera)
            if (camera != same) addCamera(camera->second, camera->first);
    }

    // Of a sun and sky the sun is a light that glTF has.
    void addSky() {
        const auto* sky = std::get_if<SunSkyBackground>(&scene_.background);
        if (sky != nullptr) {
            const glm::dvec3 irradiance = sky->factor * Daylight(*sky).sun();
            addShape(DirectionalLightDesc{-sunDirection(*sky), irradiance}, Place{}, roots_);
            notices_.leaveOut("the sky but for its sun", "skies");
        } else if (!hasStudio_ && scene_.background != Background(ConstantBackground{})) {
            notices_.leaveOut("the sky", "skies");
        }
    }

    void noticeRest() {
        if (hidden_ > 0) notices_.add(counted(hidden_, "hidden object is", "hidden objects are") + " left out");
        if (const std::size_t count = scene_.importanceTargets.size(); count > 0)
            notices_.leaveOut("one importance target", "importance targets", count);
    }

    const SceneDesc& scene_;
    GltfNotices notices_;
    GltfDocument document_;
    GltfMaterialWriter materials_;
    GltfMeshWriter meshes_;
    Nodes roots_;
    MeshData unitSphere_;
    std::map<std::pair<std::string, bool>, std::unique_ptr<ObjModel>> models_;
    std::string plain_; // material of surfaces of models that name none
    std::size_t visited_ = 0, depth_ = 0, hidden_ = 0;
    bool hasStudio_ = false;
};

} // namespace

std::vector<std::string> writeGltf(const SceneDesc& scene, const std::filesystem::path& file,
                                   const GltfImageTools& tools) {
    return SceneToGltf(scene, file, tools).run();
}

} // namespace rt::scene
