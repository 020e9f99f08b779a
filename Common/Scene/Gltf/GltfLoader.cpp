#include "Common/Scene/Gltf/GltfLoader.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include "Common/Core/Interruption.h"
#include "Common/Core/Printable.h"
#include "Common/Scene/Affine.h"
#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/FramingCamera.h"
#include "Common/Scene/Gltf/GltfAccessor.h"
#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/Gltf/GltfMaterials.h"
#include "Common/Scene/Gltf/GltfMesh.h"
#include "Common/Scene/Json/JsonNode.h"

namespace rt::scene {

namespace {

// What shows a model that brings no light: neutral, so that colours are right, and uneven, as white things would vanish
// before a constant.
const GradientBackground kStudio{glm::dvec3(0.3), glm::dvec3(1)};

// Primitives may share arrays, each having its own copy here: files whose corners exceed this many, and this many for
// each byte, could fill any memory.
constexpr std::uint64_t kFreeCorners = std::uint64_t{1} << 20;
constexpr std::uint64_t kCornersPerByte = 64;

bool isFinite(const Affine& map) {
    double largest = 0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) largest += std::abs(map.linear[i][k]);
    for (int k = 0; k < 3; ++k) largest += std::abs(map.offset[k]);
    return largest <= kLargest;
}

Transform toTransform(const Affine& map) {
    Matrix matrix;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            matrix.rows[static_cast<std::size_t>(4 * row + column)] = map.linear[column][row];
        matrix.rows[static_cast<std::size_t>(4 * row + 3)] = map.offset[row];
    }
    return {matrix};
}

bool isIdentity(const Affine& map) {
    return map.linear == glm::dmat3(1) && map.offset == glm::dvec3(0);
}

Affine composed(const glm::dvec3& translate, const glm::dvec4& rotation, const glm::dvec3& scale) {
    const glm::dquat turn(rotation.w, rotation.x, rotation.y, rotation.z);
    const glm::dmat3 rotate = glm::dot(turn, turn) > 0 ? glm::mat3_cast(glm::normalize(turn)) : glm::dmat3(1);
    return {rotate * glm::dmat3(scale.x, 0, 0, 0, scale.y, 0, 0, 0, scale.z), translate};
}

class Importer {
  public:
    explicit Importer(const std::filesystem::path& path) : file_(readGltf(path)), materials_(file_, scene_) {
        scene_.id = path.filename().string();
        scene_.title = printable(scene_.id);
    }

    SceneDesc run() {
        checkSize();
        flatten();
        addMeshes();
        addLights();
        addCameras();
        addBackground();
        addNotices();
        return std::move(scene_);
    }

  private:
    struct Placed { // a node of the hierarchy, flattened
        std::size_t node;
        Affine toWorld;
    };
    struct Pending {
        std::size_t node;
        Affine parent;
    };

    static std::string placeOf(std::size_t node) { return "/nodes/" + std::to_string(node); }

    void checkSize() const {
        std::uint64_t corners = 0;
        for (const tinygltf::Mesh& mesh : file_.model.meshes)
            for (const tinygltf::Primitive& primitive : mesh.primitives) corners += cornerCount(file_, primitive);
        const std::uint64_t most = kFreeCorners + kCornersPerByte * file_.bytes;
        if (corners > most)
            file_.fail("/meshes", "primitives have " + std::to_string(corners) + " corners: at most " +
                                      std::to_string(most) + " for a file of this size");
    }

    // ---- hierarchy --------------------------------------------------------------------------------------------------

    Affine localOf(std::size_t index) const {
        const tinygltf::Node& node = file_.model.nodes[index];
        const auto check = [&](const std::vector<double>& values, std::size_t count, const char* name) {
            if (!values.empty() && values.size() != count)
                file_.fail(placeOf(index) + "/" + name, "must be " + std::to_string(count) + " numbers");
            return !values.empty();
        };
        Affine local;
        if (check(node.matrix, 16, "matrix")) {
            for (int column = 0; column < 3; ++column)
                for (int row = 0; row < 3; ++row)
                    local.linear[column][row] = node.matrix[static_cast<std::size_t>(4 * column + row)];
            local.offset = {node.matrix[12], node.matrix[13], node.matrix[14]};
        } else {
            glm::dvec3 translate(0), scale(1);
            glm::dvec4 rotate(0, 0, 0, 1);
            if (check(node.translation, 3, "translation"))
                translate = {node.translation[0], node.translation[1], node.translation[2]};
            if (check(node.rotation, 4, "rotation"))
                rotate = {node.rotation[0], node.rotation[1], node.rotation[2], node.rotation[3]};
            if (check(node.scale, 3, "scale")) scale = {node.scale[0], node.scale[1], node.scale[2]};
            local = composed(translate, rotate, scale);
        }
        return local;
    }

    // Without recursion, and each node once: a hierarchy that is no tree is refused.
    void flatten() {
        const tinygltf::Model& model = file_.model;
        std::vector<Pending> pending;
        const auto push = [&](const std::vector<int>& nodes, const Affine& parent) {
            for (auto node = nodes.rbegin(); node != nodes.rend(); ++node)
                pending.push_back({static_cast<std::size_t>(*node), parent});
        };
        if (model.scenes.empty()) { // all nodes that are nobody's children
            std::vector<bool> isChild(model.nodes.size(), false);
            for (const tinygltf::Node& node : model.nodes)
                for (const int child : node.children) isChild[static_cast<std::size_t>(child)] = true;
            for (std::size_t i = model.nodes.size(); i-- > 0;)
                if (!isChild[i]) pending.push_back({i, {}});
        } else {
            push(model.scenes[static_cast<std::size_t>(std::max(model.defaultScene, 0))].nodes, {});
        }
        std::vector<bool> isSeen(model.nodes.size(), false);
        while (!pending.empty()) {
            interruptionPoint();
            const Pending next = pending.back();
            pending.pop_back();
            if (isSeen[next.node]) file_.fail(placeOf(next.node), "is reached twice: nodes must form a tree");
            isSeen[next.node] = true;
            const Affine toWorld = next.parent * localOf(next.node);
            if (!isFinite(toWorld)) file_.fail(placeOf(next.node), "its transform exceeds 1e9");
            placed_.push_back({next.node, toWorld});
            push(model.nodes[next.node].children, toWorld);
        }
    }

    // ---- meshes -----------------------------------------------------------------------------------------------------

    // Transforms of EXT_mesh_gpu_instancing in the node's space; the identity alone for others.
    std::vector<Affine> instancesOf(std::size_t index) const {
        const tinygltf::Node& node = file_.model.nodes[index];
        const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
        if (extension == node.extensions.end()) return {Affine{}};
        const tinygltf::Value& attributes = extension->second.Get("attributes");
        std::size_t count = 0;
        const auto accessor = [&](const char* name) -> std::optional<int> {
            if (!attributes.Has(name)) return std::nullopt;
            const int found = attributes.Get(name).GetNumberAsInt();
            const std::size_t elements = accessorCount(file_, found);
            if (count != 0 && elements != count)
                file_.fail(placeOf(index) + "/extensions/EXT_mesh_gpu_instancing/attributes/" + name,
                           "must have as many elements as the others, " + std::to_string(count));
            count = elements;
            return found;
        };
        const auto translations = accessor("TRANSLATION"), rotations = accessor("ROTATION"), scales = accessor("SCALE");
        const std::vector<glm::dvec3> translate(translations ? readVectors<3>(file_, *translations)
                                                             : std::vector<glm::dvec3>(count, glm::dvec3(0)));
        const std::vector<glm::dvec4> rotate(rotations ? readVectors<4>(file_, *rotations)
                                                       : std::vector<glm::dvec4>(count, glm::dvec4(0, 0, 0, 1)));
        const std::vector<glm::dvec3> scale(scales ? readVectors<3>(file_, *scales)
                                                   : std::vector<glm::dvec3>(count, glm::dvec3(1)));
        std::vector<Affine> instances;
        for (std::size_t i = 0; i < count; ++i) instances.push_back(composed(translate[i], rotate[i], scale[i]));
        return instances;
    }

    // The surfaces of a mesh, and its bounds.
    std::pair<std::vector<ObjectDesc>, Bounds> surfacesOf(std::size_t index) {
        std::vector<ObjectDesc> surfaces;
        Bounds bounds;
        const tinygltf::Mesh& mesh = file_.model.meshes[index];
        for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
            const tinygltf::Primitive& primitive = mesh.primitives[i];
            const std::string place = "/meshes/" + std::to_string(index) + "/primitives/" + std::to_string(i);
            if (primitive.extensions.count("KHR_draco_mesh_compression") > 0 && cornerCount(file_, primitive) == 0)
                file_.fail(place, "is compressed by KHR_draco_mesh_compression, which is not supported");
            isMorphed_ = isMorphed_ || !primitive.targets.empty();
            const GltfMaterials::Use& use = materials_.use(primitive.material);
            MeshData data = readPrimitive(file_, primitive, use.isOpaque, use.tangentSet, place);
            if (data.triangles.empty()) {
                ++withoutTriangles_;
                continue;
            }
            for (const glm::dvec3& position : data.positions) bounds.add(position);
            surfaces.push_back({MeshDesc{std::move(data), use.name, !use.isUnlit}});
        }
        return {std::move(surfaces), bounds};
    }

    void addMeshes() {
        std::map<int, std::vector<Affine>> places; // by mesh
        for (const Placed& placed : placed_) {
            const tinygltf::Node& node = file_.model.nodes[placed.node];
            isSkinned_ = isSkinned_ || (node.mesh >= 0 && node.skin >= 0);
            if (node.mesh < 0) continue;
            for (const Affine& instance : instancesOf(placed.node)) {
                const Affine toWorld = placed.toWorld * instance;
                if (!isFinite(toWorld)) file_.fail(placeOf(placed.node), "the transform of an instance exceeds 1e9");
                if (!inverse(toWorld)) { // a scale of 0, as hides nodes; no scene file could say it
                    ++flattened_;
                    continue;
                }
                places[node.mesh].push_back(toWorld);
            }
        }
        UniqueNames names;
        for (const auto& [index, where] : places) {
            const auto number = static_cast<std::size_t>(index);
            auto [surfaces, bounds] = surfacesOf(number);
            if (surfaces.empty()) continue;
            for (const Affine& toWorld : where) bounds_.add(bounds, toWorld);
            if (where.size() == 1) {
                if (!isIdentity(where.front()))
                    surfaces = {{GroupDesc{toTransform(where.front()), std::move(surfaces)}}};
                std::move(surfaces.begin(), surfaces.end(), std::back_inserter(scene_.objects));
                continue;
            }
            const std::string name = names.unique(file_.model.meshes[number].name, "mesh", number);
            scene_.prototypes[name] = std::move(surfaces);
            for (const Affine& toWorld : where)
                scene_.objects.push_back({InstanceDesc{name, toTransform(toWorld), {}}});
        }
        if (scene_.objects.empty()) file_.fail("/scenes", "there is no triangle in the scene");
    }

    // ---- cameras and light ------------------------------------------------------------------------------------------

    void addCameras() {
        UniqueNames names;
        bool isFirst = true;
        scene_.camera = framingCamera(bounds_);
        for (const Placed& placed : placed_) {
            const tinygltf::Node& node = file_.model.nodes[placed.node];
            if (node.camera < 0) continue;
            const auto number = static_cast<std::size_t>(node.camera);
            const tinygltf::Camera& source = file_.model.cameras[number];
            if (source.type != "perspective") {
                scene_.notices.push_back("camera " + std::to_string(number) + " is orthographic and left out");
                continue;
            }
            const double fov = glm::degrees(source.perspective.yfov);
            if (!(fov > 0 && fov < 180))
                file_.fail("/cameras/" + std::to_string(number) + "/perspective/yfov", "must be between 0 and pi");
            CameraDesc camera;
            camera.verticalFov = fov;
            camera.lookFrom = placed.toWorld.offset;
            const glm::dvec3 view = placed.toWorld.vector({0, 0, -1}), up = placed.toWorld.vector({0, 1, 0});
            if (!(glm::length(glm::cross(view, up)) > 1e-9 * glm::length(view) * glm::length(up)))
                file_.fail(placeOf(placed.node), "its transform leaves the camera no direction");
            const glm::dvec3 direction = glm::normalize(view);
            camera.up = glm::normalize(up);
            // What it looks at is turned around in a window: as far away as the middle of the scene.
            const double distance = glm::dot(bounds_.center() - camera.lookFrom, direction);
            camera.focusDistance = distance > 1e-6 * bounds_.radius() && distance > 1e-6 ? distance : 1;
            camera.lookAt = camera.lookFrom + camera.focusDistance * direction;
            if (isFirst) {
                scene_.camera = camera;
                const double aspect = source.perspective.aspectRatio;
                if (aspect > 1 / kLargest && aspect < kLargest) scene_.render.aspect = aspect;
            }
            isFirst = false;
            scene_.cameras[names.unique(source.name.empty() ? node.name : source.name, "camera", number)] = camera;
        }
    }

    void addLights() {
        for (const Placed& placed : placed_) {
            const tinygltf::Node& node = file_.model.nodes[placed.node];
            const auto extension = node.extensions.find("KHR_lights_punctual");
            if (extension == node.extensions.end()) continue;
            const int index = extension->second.Get("light").GetNumberAsInt();
            const std::string place = "/extensions/KHR_lights_punctual/lights/" + std::to_string(index);
            const tinygltf::Light& source = file_.model.lights[static_cast<std::size_t>(index)];
            glm::dvec3 power(source.intensity);
            if (source.color.size() == 3) power *= glm::dvec3(source.color[0], source.color[1], source.color[2]);
            for (int c = 0; c < 3; ++c)
                if (!(power[c] >= 0 && power[c] <= kLargest)) file_.fail(place, "its intensity must be from 0 to 1e9");
            const glm::dvec3 position = placed.toWorld.offset, forward = placed.toWorld.vector({0, 0, -1});
            if (source.type != "point" && !(glm::length(forward) > 0))
                file_.fail(placeOf(placed.node), "its transform leaves the light no direction");
            hasLights_ = true;
            if (source.type == "point") {
                scene_.objects.push_back({PointLightDesc{position, power}});
            } else if (source.type == "directional") {
                scene_.objects.push_back({DirectionalLightDesc{glm::normalize(forward), power}});
            } else if (source.type == "spot") {
                const double inner = glm::degrees(source.spot.innerConeAngle);
                const double outer = glm::degrees(source.spot.outerConeAngle);
                if (!(inner >= 0 && inner < outer && outer <= 90 + 1e-6)) // a rounded quarter turn
                    file_.fail(place, "spot: its angles must be 0 <= innerConeAngle < outerConeAngle <= pi / 2");
                scene_.objects.push_back(
                    {SpotLightDesc{position, glm::normalize(forward), power, inner, std::min(outer, 90.0)}});
            } else {
                file_.fail(place, "type: must be point, spot or directional");
            }
        }
    }

    // Assets come without any light, or with small parts that glow: a bright surrounding shows them.
    void addBackground() {
        if (hasLights_ || materials_.emitsAsLight()) return;
        scene_.background = kStudio;
        scene_.notices.push_back("there is no light in the file: the background is a gradient of grey");
    }

    void addNotices() {
        std::vector<std::string>& notices = scene_.notices;
        notices.insert(notices.end(), file_.notices.begin(), file_.notices.end());
        if (withoutTriangles_ > 0)
            notices.push_back(std::to_string(withoutTriangles_) +
                              " primitives of points, lines or no triangle are left out");
        if (flattened_ > 0)
            notices.push_back(std::to_string(flattened_) + (flattened_ == 1 ? " mesh is" : " meshes are") +
                              " left out: the transform of the node cannot be inverted");
        if (isSkinned_) notices.push_back("skins are left out: meshes are where their nodes are");
        if (isMorphed_) notices.push_back("morph targets are left out");
        if (!file_.model.animations.empty()) notices.push_back("animations are left out: nodes are at rest");
        if (file_.model.scenes.size() > 1) notices.push_back("scenes other than the default one are left out");
    }

    const GltfFile file_;
    SceneDesc scene_;
    GltfMaterials materials_;
    std::vector<Placed> placed_;
    Bounds bounds_; // of everything, in world space
    std::size_t withoutTriangles_ = 0;
    std::size_t flattened_ = 0; // places of meshes
    bool hasLights_ = false;
    bool isSkinned_ = false;
    bool isMorphed_ = false;
};

} // namespace

SceneDesc loadGltfScene(const std::filesystem::path& path) {
    return Importer(path).run();
}

} // namespace rt::scene
