#include "Common/Scene/Gltf/GltfLoader.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "Common/Core/Parallel.h"
#include "Common/Core/Printable.h"
#include "Common/Scene/Affine.h"
#include "Common/Scene/Compiler/Bounds.h"
#include "Common/Scene/Counted.h"
#include "Common/Scene/Gltf/GltfAccessor.h"
#include "Common/Scene/Gltf/GltfAnimation.h"
#include "Common/Scene/Gltf/GltfBudget.h"
#include "Common/Scene/Gltf/GltfCameras.h"
#include "Common/Scene/Gltf/GltfDraco.h"
#include "Common/Scene/Gltf/GltfFile.h"
#include "Common/Scene/Gltf/GltfMaterials.h"
#include "Common/Scene/Gltf/GltfMesh.h"
#include "Common/Scene/Gltf/GltfMeshopt.h"
#include "Common/Scene/Gltf/GltfNodes.h"
#include "Common/Scene/Gltf/GltfSkin.h"
#include "Common/Scene/Gltf/GltfValues.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Placing.h"

namespace rt::scene {

namespace {

// With all that is compressed in it.
GltfFile readWhole(const std::filesystem::path& path) {
    GltfFile file = readGltf(path);
    GltfBudget budget(file);
    decodeMeshopt(file, budget);
    decodeDraco(file, budget);
    return file;
}

} // namespace

// What poses of a file have in common.
struct GltfPoses {
    // A primitive that no joint moves, in a state of its morph targets.
    struct KeptMesh {
        Boxed<MeshData> data;
        std::size_t rescaled; // vertices, see readPrimitive()
    };
    using Key = std::pair<const tinygltf::Primitive*, std::vector<double>>;
    std::map<Key, KeptMesh> meshes; // of the latest pose
    std::optional<std::string> animation;
    GltfStart start; // of that animation
};

namespace {

class Importer {
  public:
    // `start`: null where this is it.
    Importer(const GltfFile& file, Moment moment, const GltfStart* start, GltfPoses& poses)
        : file_(file),
          moment_(std::move(moment)),
          start_(start),
          poses_(poses),
          budget_(file_),
          materials_(file_, scene_),
          nodes_(file_, moment_, budget_) {
        scene_.id = file.path.filename().string();
        scene_.title = printable(scene_.id);
    }

    SceneDesc run() {
        addMeshes();
        addLights();
        addCameras(file_, nodes_, start_ != nullptr ? *start_ : GltfStart{bounds_, {}}, scene_);
        addMotion();
        addNotices();
        return std::move(scene_);
    }
    const Bounds& bounds() const { return bounds_; }

  private:
    // A mesh in one of its poses.
    struct PosedMesh {
        int mesh = -1;
        int skin = -1;               // -1: it stands where its node is
        std::vector<double> weights; // of morph targets
        bool operator<(const PosedMesh& other) const {
            return std::tie(mesh, skin, weights) < std::tie(other.mesh, other.skin, other.weights);
        }
    };

    // ---- meshes -----------------------------------------------------------------------------------------------------

    // Transforms of EXT_mesh_gpu_instancing in the node's space; the identity alone for others.
    std::vector<Affine> instancesOf(std::size_t index) {
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
                file_.fail(placeOfNode(index) + "/extensions/EXT_mesh_gpu_instancing/attributes/" + name,
                           "must have as many elements as the others, " + std::to_string(count));
            count = elements;
            budget_.spend(count, placeOfNode(index));
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

    // A primitive that is to be read, and then was.
    struct Surface {
        const tinygltf::Primitive* primitive;
        GltfMaterials::Use material;
        const PosedMesh& posed;
        std::shared_ptr<const std::vector<Affine>> joints;
        std::string place;
        std::optional<GltfPoses::KeptMesh> kept = {}; // of the pose before; none: it is to be read
        MeshData data = {};
        std::size_t rescaled = 0; // vertices, see readPrimitive()
    };

    // The primitives of a mesh, none of them read yet.
    void addSurfaces(const PosedMesh& posed, std::vector<Surface>& surfaces) {
        const tinygltf::Mesh& mesh = file_.model.meshes[static_cast<std::size_t>(posed.mesh)];
        const auto joints = std::make_shared<const std::vector<Affine>>(
            posed.skin < 0 ? std::vector<Affine>() : jointMaps(file_, posed.skin, nodes_));
        budget_.spend(joints->size(), "/skins/" + std::to_string(posed.skin));
        for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
            const tinygltf::Primitive& primitive = mesh.primitives[i];
            const std::string place = "/meshes/" + std::to_string(posed.mesh) + "/primitives/" + std::to_string(i);
            if (primitive.extensions.count("KHR_draco_mesh_compression") > 0 && !isTriangles(primitive))
                file_.fail(place, "is compressed by Draco, which this build lacks");
            surfaces.push_back({&primitive, materials_.use(primitive.material), posed, joints, place});
            const auto kept = poses_.meshes.find({&primitive, posed.weights});
            if (posed.skin < 0 && kept != poses_.meshes.end()) surfaces.back().kept = kept->second;
            budget_.spend(elementCount(file_, primitive, useOf(surfaces.back())), place);
        }
    }

    static PrimitiveUse useOf(const Surface& surface) {
        return {surface.material.isOpaque, surface.material.tangentSet, surface.material.isStretched,
                surface.posed.weights, *surface.joints};
    }

    // Whether joints move all of a mesh.
    bool hasJoints(const tinygltf::Mesh& mesh) const {
        return std::all_of(mesh.primitives.begin(), mesh.primitives.end(), [](const tinygltf::Primitive& primitive) {
            return !isTriangles(primitive) || jointSetCount(primitive) > 0;
        });
    }

    struct Stand {
        Affine toWorld;
        bool isMoved; // by the animation
    };

    // Where each posed mesh stands.
    std::map<PosedMesh, std::vector<Stand>> placeMeshes() {
        std::map<PosedMesh, std::vector<Stand>> places;
        for (const GltfNodes::Placed& placed : nodes_.placed()) {
            const tinygltf::Node& node = file_.model.nodes[placed.node];
            if (node.mesh < 0) continue;
            PosedMesh posed{node.mesh, node.skin, nodes_.weights(placed.node)};
            budget_.spend(posed.weights.size(), placeOfNode(placed.node));
            if (node.skin >= 0 && !hasJoints(file_.model.meshes[static_cast<std::size_t>(node.mesh)])) {
                posed.skin = -1;
                ++withoutJoints_;
            }
            for (const Affine& instance : instancesOf(placed.node)) {
                // The joints of a skin say where it is, whatever its node does.
                const Affine toWorld = posed.skin < 0 ? placed.toWorld * instance : instance;
                if (!isWithinLimits(toWorld))
                    file_.fail(placeOfNode(placed.node), "the transform of an instance exceeds 1e9");
                if (!inverse(toWorld)) { // a scale of 0, as hides nodes; no scene file could say it
                    ++flattened_;
                    continue;
                }
                places[posed].push_back({toWorld, posed.skin < 0 && placed.isMoved});
            }
        }
        return places;
    }

    void addMeshes() {
        const std::map<PosedMesh, std::vector<Stand>> places = placeMeshes();
        std::vector<Surface> surfaces;
        for (const auto& [posed, where] : places) addSurfaces(posed, surfaces);
        parallelFor(0, surfaces.size(), [&](std::size_t i) {
            Surface& surface = surfaces[i];
            if (!surface.kept)
                surface.data =
                    readPrimitive(file_, *surface.primitive, useOf(surface), surface.place, surface.rescaled);
        });
        auto next = surfaces.begin();
        UniqueNames names;
        poses_.meshes.clear();
        for (const auto& [posed, where] : places) {
            std::vector<ObjectDesc> objects;
            Bounds bounds;
            for (; next != surfaces.end() && &next->posed == &posed; ++next) {
                const GltfPoses::KeptMesh mesh = meshOf(*next);
                rescaled_ += mesh.rescaled;
                if (mesh.data->triangles.empty()) {
                    ++withoutTriangles_;
                    continue;
                }
                for (const glm::dvec3& position : mesh.data->positions) bounds.add(position);
                objects.push_back({MeshDesc{mesh.data, next->material.name, !next->material.isUnlit}});
            }
            if (!objects.empty()) place(static_cast<std::size_t>(posed.mesh), std::move(objects), bounds, where, names);
        }
        if (scene_.objects.empty()) file_.fail("/scenes", "there is no triangle in the scene");
    }

    // As it is now, or was in the pose before; one that another pose may have like this is kept.
    GltfPoses::KeptMesh meshOf(Surface& surface) {
        if (!surface.kept) surface.kept = GltfPoses::KeptMesh{std::move(surface.data), surface.rescaled};
        if (surface.posed.skin < 0) poses_.meshes.insert({{surface.primitive, surface.posed.weights}, *surface.kept});
        return *surface.kept;
    }

    // What the animation moves is in a group in all poses, so that it is called alike in each.
    void place(std::size_t mesh, std::vector<ObjectDesc> surfaces, const Bounds& bounds,
               const std::vector<Stand>& where, UniqueNames& names) {
        for (const Stand& stand : where) bounds_.add(bounds, stand.toWorld);
        if (where.size() == 1) {
            const auto& [toWorld, isMoved] = where.front();
            if (isMoved || !isIdentity(toWorld)) surfaces = {{GroupDesc{toTransform(toWorld), std::move(surfaces)}}};
            std::move(surfaces.begin(), surfaces.end(), std::back_inserter(scene_.objects));
            return;
        }
        const std::string name = names.unique(file_.model.meshes[mesh].name, "mesh", mesh);
        scene_.prototypes[name] = std::move(surfaces);
        for (const Stand& stand : where) scene_.objects.push_back({InstanceDesc{name, toTransform(stand.toWorld), {}}});
    }

    // ---- light ------------------------------------------------------------------------------------------------------

    void addLights() {
        for (const GltfNodes::Placed& placed : nodes_.placed()) {
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
            if (source.type != "point" && !(glm::length(forward) > 0)) { // a scale of 0, as hides nodes
                ++undirected_;
                continue;
            }
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

    void addNotices() {
        std::vector<std::string>& notices = scene_.notices;
        notices.insert(notices.end(), file_.notices.begin(), file_.notices.end());
        if (withoutTriangles_ > 0)
            notices.push_back(counted(withoutTriangles_, "primitive", "primitives") +
                              " of points, lines or no triangle " + (withoutTriangles_ == 1 ? "is" : "are") +
                              " left out");
        if (flattened_ > 0)
            notices.push_back(counted(flattened_, "mesh is", "meshes are") +
                              " left out: the transform of the node cannot be inverted");
        if (undirected_ > 0)
            notices.push_back(counted(undirected_, "light is", "lights are") +
                              " left out: the transform of the node leaves it no direction");
        if (withoutJoints_ > 0)
            notices.push_back(counted(withoutJoints_, "skin is", "skins are") + " left out: vertices have no joints");
        if (rescaled_ > 0)
            notices.push_back("weights of joints are scaled to the sum 1 at " +
                              counted(rescaled_, "vertex", "vertices"));
        addAnimationNotice();
        if (file_.model.scenes.size() > 1) notices.emplace_back("scenes other than the default one are left out");
    }

    void addMotion() {
        Motion& motion = scene_.motion;
        motion.animations = animationNames(file_);
        motion.chosen = chosenAnimation(motion.animations, moment_).value_or(0);
        motion.length = nodes_.animationSeconds();
        if (!motion.animations.empty()) motion.time = moment_.time;
    }

    // Tells those who asked for no moment that there are others.
    void addAnimationNotice() {
        const std::vector<std::string>& names = scene_.motion.animations;
        if (names.empty()) return noticeStandstill(moment_, scene_.notices);
        if (moment_ != Moment() || moment_.isAsked) return;
        std::ostringstream text;
        text << "animation \"" << names.front() << '"';
        if (names.size() > 1) text << ", the first of " << names.size() << ",";
        text << " is shown at its start: --time poses it, from 0 to " << nodes_.animationSeconds() << " s";
        if (names.size() > 1) text << "; --animation chooses another";
        scene_.notices.push_back(text.str());
    }

    const GltfFile& file_;
    const Moment moment_;
    const GltfStart* const start_;
    GltfPoses& poses_;
    GltfBudget budget_;
    SceneDesc scene_;
    GltfMaterials materials_;
    const GltfNodes nodes_;
    Bounds bounds_; // of everything, in world space
    std::size_t withoutTriangles_ = 0;
    std::size_t flattened_ = 0;     // places of meshes
    std::size_t undirected_ = 0;    // lights
    std::size_t withoutJoints_ = 0; // nodes with a skin that moves nothing
    std::size_t rescaled_ = 0;      // vertices whose joints' weights are no shares
};

} // namespace

SceneDesc loadGltfScene(const std::filesystem::path& path, const Moment& moment) {
    return GltfScene(path).at(moment);
}

GltfScene::GltfScene(const std::filesystem::path& path)
    : file_(std::make_unique<const GltfFile>(readWhole(path))), poses_(std::make_unique<GltfPoses>()) {}
GltfScene::~GltfScene() = default;

bool GltfScene::isAnimated() const {
    return !file_->model.animations.empty();
}

SceneDesc GltfScene::at(const Moment& moment) {
    GltfPoses& poses = *poses_;
    const bool isStart = !isAnimated() || moment.time == 0;
    if (isStart || poses.animation != moment.animation) {
        const Moment start = isStart ? moment : Moment{moment.animation};
        Importer importer(*file_, start, nullptr, poses);
        SceneDesc scene = importer.run();
        poses.start = {importer.bounds(), scene.cameras};
        poses.animation = moment.animation;
        if (isStart) return scene;
    }
    return Importer(*file_, moment, &poses.start, poses).run();
}

} // namespace rt::scene
