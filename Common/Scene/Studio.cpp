#include "Common/Scene/Studio.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Json/JsonNode.h"

namespace rt::scene {
namespace {

// The sky is neutral, so that colours are right, and brighter above, so that what is white has shades.
constexpr double kHorizon = 0.2, kZenith = 0.37; // radiance; the opposite of the zenith is as much below the horizon
// Far from the boxes the floor is as bright as the horizon, where no edge is seen for that: what it receives of a sky
// whose radiance is linear in the height of the direction is pi times this.
constexpr double kFloorIrradiance = kHorizon + (kZenith - kHorizon) * 2 / 3;
// In radii of the model.
constexpr double kFloorHalf = 40;  // from its middle to its edges
constexpr double kFloorGap = 1e-3; // below the model, so that a flat one does not lie in it
constexpr double kBoxDistance = 5; // from the middle of the model: beyond what framingCamera() sees

constexpr const char* kStudio = "studio"; // the prototype

struct SoftBox {
    const char* name;
    glm::dvec3 towards; // from the middle of the model
    double halfWidth, halfHeight;
    double radiance; // low enough for mirrors to show the box rather than a blot
};
constexpr SoftBox kBoxes[] = {{"studio key", {-0.8, 0.9, 0.7}, 2, 2, 2.7},
                              {"studio fill", {1, 0.3, 0.6}, 1.5, 2, 0.8},
                              {"studio rim", {0.4, 1, -0.9}, 2, 1.5, 2.5}};

bool emitsWhite(const SceneDesc& scene, const std::string& name) {
    const auto material = scene.materials.find(name);
    if (material == scene.materials.end()) return false;
    const glm::dvec3& emission = material->second.emission;
    const double most = std::max({emission.r, emission.g, emission.b});
    return material->second.emissionTexture.empty() ? most >= 1 : most > 1;
}

bool isLight(const SceneDesc& scene, const ObjectDesc& object);

struct LightTest {
    const SceneDesc& scene;

    bool operator()(const PointLightDesc&) const { return true; }
    bool operator()(const SpotLightDesc&) const { return true; }
    bool operator()(const DirectionalLightDesc&) const { return true; }
    bool operator()(const MediumDesc&) const { return false; }
    bool operator()(const InstanceDesc& instance) const { return emitsWhite(scene, instance.material); }
    bool operator()(const GroupDesc& group) const {
        return std::any_of(group.objects.begin(), group.objects.end(),
                           [this](const ObjectDesc& object) { return isLight(scene, object); });
    }
    template <class Surface>
    bool operator()(const Surface& surface) const {
        return surface.light && emitsWhite(scene, surface.material);
    }
};

bool isLight(const SceneDesc& scene, const ObjectDesc& object) {
    return !object.hidden && std::visit(LightTest{scene}, object.shape);
}

// `but`: a list of objects that does not count.
bool anyIsLight(const SceneDesc& scene, const std::vector<ObjectDesc>* but) {
    const auto hasLight = [&](const std::vector<ObjectDesc>& objects) {
        const auto shines = [&scene](const ObjectDesc& object) { return isLight(scene, object); };
        return &objects != but && std::any_of(objects.begin(), objects.end(), shines);
    };
    const auto& prototypes = scene.prototypes;
    return hasLight(scene.objects) ||
           std::any_of(prototypes.begin(), prototypes.end(), [&](const auto& named) { return hasLight(named.second); });
}

// The bounds of lists of objects, of each prototype once.
class MeshBounds {
  public:
    explicit MeshBounds(const SceneDesc& scene) : scene_(scene) {}

    Bounds of(const std::vector<ObjectDesc>& objects) {
        Bounds bounds;
        for (const ObjectDesc& object : objects) {
            if (const auto* mesh = std::get_if<MeshDesc>(&object.shape)) {
                if (const auto* data = std::get_if<Boxed<MeshData>>(&mesh->source))
                    for (const glm::dvec3& position : (*data)->positions) bounds.add(position);
            } else if (const auto* group = std::get_if<GroupDesc>(&object.shape)) {
                bounds.add(of(group->objects), toAffine(group->transform));
            } else if (const auto* instance = std::get_if<InstanceDesc>(&object.shape)) {
                bounds.add(ofPrototype(instance->prototype), toAffine(instance->transform));
            }
        }
        return bounds;
    }

  private:
    const Bounds& ofPrototype(const std::string& name) {
        const auto [bounds, isNew] = known_.try_emplace(name);
        const auto prototype = scene_.prototypes.find(name);
        if (isNew && prototype != scene_.prototypes.end()) bounds->second = of(prototype->second);
        return bounds->second;
    }

    const SceneDesc& scene_;
    std::map<std::string, Bounds> known_;
};

// One that the scene does not have yet.
template <class Named>
std::string freeName(const std::map<std::string, Named>& taken, std::string name) {
    while (taken.count(name) > 0) name += '\'';
    return name;
}

// What the studio is in proportion to: finite and not too small, whatever the bounds are, so that a scene file may have
// all of it and it is not lost to rounding.
struct StudioPlace {
    explicit StudioPlace(const Bounds& bounds)
        : center(glm::clamp(bounds.center(), -kLargest / 2, kLargest / 2)),
          radius(bounds.empty()
                     ? 1
                     : std::clamp(bounds.radius(), std::max(1 / kLargest, 1e-7 * glm::length(center)), kLargest / 100)),
          floor((bounds.empty() ? -1 : std::clamp(bounds.lower.y, -kLargest / 2, kLargest / 2)) - kFloorGap * radius) {}

    glm::dvec3 center;
    double radius;
    double floor; // y
};

// Shines towards the middle of the model; from behind it is black.
QuadDesc softBox(const SoftBox& box, const StudioPlace& place, const std::string& material) {
    const glm::dvec3 towards = glm::normalize(box.towards);
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), towards));
    QuadDesc quad;
    quad.edgeU = 2 * box.halfHeight * place.radius * glm::cross(towards, right);
    quad.edgeV = 2 * box.halfWidth * place.radius * right;
    quad.corner = place.center + kBoxDistance * place.radius * towards - 0.5 * (quad.edgeU + quad.edgeV);
    quad.material = material;
    return quad;
}

QuadDesc floorQuad(const StudioPlace& place, const std::string& material) {
    const double half = kFloorHalf * place.radius;
    QuadDesc quad;
    quad.corner = {place.center.x - half, place.floor, place.center.z - half};
    quad.edgeU = {0, 0, 2 * half};
    quad.edgeV = {2 * half, 0, 0};
    quad.material = material;
    return quad;
}

bool isSeenFromBelow(const SceneDesc& scene, double floor) {
    const auto isBelow = [floor](const CameraDesc& camera) { return camera.lookFrom.y < floor; };
    return isBelow(scene.camera) || std::any_of(scene.cameras.begin(), scene.cameras.end(),
                                                [&](const auto& named) { return isBelow(named.second); });
}

} // namespace

bool bringsLight(const SceneDesc& scene) {
    return scene.background != Background(ConstantBackground{}) || anyIsLight(scene, nullptr);
}

Bounds boundsOfMeshes(const SceneDesc& scene) {
    return MeshBounds(scene).of(scene.objects);
}

void addStudioIfUnlit(SceneDesc& scene, const Bounds& bounds) {
    if (!bringsLight(scene)) addStudio(scene, bounds);
}

void addStudio(SceneDesc& scene, const Bounds& bounds) {
    const StudioPlace place(bounds);
    scene.background = GradientBackground{glm::dvec3(2 * kHorizon - kZenith), glm::dvec3(kZenith)};
    std::vector<ObjectDesc> studio;
    for (const SoftBox& box : kBoxes) {
        MaterialDesc material;
        material.albedo = glm::dvec3(0);
        material.emission = glm::dvec3(box.radiance);
        material.sides = Sides::Front;
        const std::string name = freeName(scene.materials, box.name);
        scene.materials[name] = std::move(material);
        studio.push_back({softBox(box, place, name)});
    }
    if (!isSeenFromBelow(scene, place.floor)) {
        const std::string name = freeName(scene.materials, "studio floor");
        scene.materials[name].albedo = glm::dvec3(kHorizon / kFloorIrradiance);
        studio.push_back({floorQuad(place, name)});
    }
    const std::string name = freeName(scene.prototypes, kStudio);
    scene.prototypes[name] = std::move(studio);
    scene.objects.push_back({InstanceDesc{name, {}, {}}});
    scene.notices.insert(scene.notices.begin(),
                         "there is no light in the file: the model stands in a studio of soft "
                         "boxes, the prototype \"" +
                             name + "\"");
}

std::optional<std::size_t> studioOf(const SceneDesc& scene) {
    SceneDesc usual;
    usual.camera = scene.camera;
    usual.cameras = scene.cameras;
    addStudio(usual, boundsOfMeshes(scene));
    const std::vector<ObjectDesc>& parts = usual.prototypes.at(kStudio);
    const auto isUsual = [&](const std::vector<ObjectDesc>& studio) {
        return std::equal(studio.begin(), studio.end(), parts.begin(), parts.end(), [&](const auto& a, const auto& b) {
            const auto* quad = std::get_if<QuadDesc>(&a.shape);
            const auto found = quad == nullptr ? scene.materials.end() : scene.materials.find(quad->material);
            return found != scene.materials.end() && !a.hidden &&
                   found->second == usual.materials.at(std::get<QuadDesc>(b.shape).material);
        });
    };
    if (scene.background != usual.background) return std::nullopt;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const auto* instance = std::get_if<InstanceDesc>(&scene.objects[i].shape);
        if (instance == nullptr || scene.objects[i].hidden || *instance != InstanceDesc{instance->prototype, {}, {}})
            continue;
        const auto prototype = scene.prototypes.find(instance->prototype);
        if (prototype != scene.prototypes.end() && isUsual(prototype->second) && !anyIsLight(scene, &prototype->second))
            return i;
    }
    return std::nullopt;
}

} // namespace rt::scene
