#include "Common/Scene/Compiler/SpecularCasters.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Compiler/CasterLights.h"
#include "Common/Shared/Material/Materials.h"

namespace rt::scene {

namespace {

constexpr double kMinIor = 1.01;      // below it a sphere focuses nothing
constexpr double kMinIorInside = 1.3; // see kNearestInside
constexpr double kMinShare = 0.1;     // of the light that goes on from spheres; less is not worth the time
constexpr double kMirrorWorth = 0.25; // see kWorthConnecting
// Of spheres and lights, at least kCasterLights: eight of more spheres matter less than the time to choose them.
constexpr std::size_t kMaxPairs = 1 << 23;

bool isMirror(const shared::Material& material) {
    return material.kind == shared::kMaterialMetal && material.parameter[shared::kMetalFuzz] <= shared::kMirrorFuzz;
}

// Clear glass, or a mirror.
bool isSmooth(const shared::Material& material) {
    const bool isGlass =
        material.kind == shared::kMaterialDielectric && material.parameter[shared::kDielectricIor] >= kMinIor;
    return (isGlass || isMirror(material)) && material.texture == shared::kNone &&
           material.emission == shared::vec3(0.0f);
}

// Where spheres stand: in the world, or in an instance that scales all lengths by one factor.
struct InstancePlacement {
    Affine toWorld;
    double scale = 1;
    std::uint32_t instance = shared::kNone;
    std::uint32_t material = shared::kNone; // replaces theirs unless kNone
};

const shared::Material& materialAt(const CompiledScene& scene, std::uint32_t sphere, const InstancePlacement& at) {
    return scene.materials[at.material != shared::kNone ? at.material : scene.spheres[sphere].material];
}

// Nothing where spheres do not stay spheres.
std::optional<InstancePlacement> placementOf(const CompiledScene& scene, std::uint32_t index) {
    const shared::Instance& instance = scene.instances[index];
    InstancePlacement at;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            at.toWorld.linear[column][row] = static_cast<double>(instance.toWorld[row][column]);
        at.toWorld.offset[row] = static_cast<double>(instance.toWorld[row].w);
    }
    const std::optional<double> scale = uniformScale(at.toWorld);
    if (!scale) return std::nullopt;
    at.scale = *scale;
    at.instance = index;
    at.material = instance.material;
    return at;
}

shared::SpecularCaster specularCaster(const CompiledScene& scene, std::uint32_t index, const InstancePlacement& at,
                                      std::uint32_t crossings) {
    const shared::Sphere& sphere = scene.spheres[index];
    const shared::Material& material = materialAt(scene, index, at);
    shared::SpecularCaster smooth{};
    smooth.center = shared::vec3(at.toWorld.point(sphere.center));
    smooth.radius = static_cast<float>(static_cast<double>(sphere.radius) * at.scale);
    if (!scene.sphereMotions.empty()) smooth.motion = shared::vec3(at.toWorld.vector(scene.sphereMotions[index]));
    smooth.inverseEta = isMirror(material) ? 0.0f : 1.0f / material.parameter[shared::kDielectricIor];
    smooth.tint = material.albedo;
    for (std::uint32_t i = 0; i < crossings; ++i) smooth.tint *= material.albedo;
    smooth.crossings = crossings;
    smooth.primitive = index;
    smooth.instance = at.instance;
    if (at.instance != shared::kNone) {
        const double reach = glm::length(glm::dvec3(sphere.center)) + static_cast<double>(sphere.radius);
        smooth.error = 32 * shared::kEpsilon * static_cast<float>(at.scale * reach + glm::length(at.toWorld.offset));
    }
    return smooth;
}

struct Candidate {
    shared::SpecularCaster sphere;
    double flux; // that goes on from it
};

// The candidates that most light goes on from, those first, and that which most is refracted by of those that are worth
// aiming at; of equal ones the first that came.
class CasterSelection {
  public:
    CasterSelection(const CompiledScene& scene, double minVariance) : scene_(scene), minVariance_(minVariance) {}

    void consider(std::uint32_t index, const InstancePlacement& at) {
        const shared::Material& material = materialAt(scene_, index, at);
        const auto by = [&](std::uint32_t crossings) { return specularCaster(scene_, index, at, crossings); };
        if (isMirror(material)) {
            consider(by(shared::kReflectedOutside), minVariance_ * kMirrorWorth);
        } else if (consider(by(shared::kRefracted), minVariance_)) {
            consider(by(shared::kReflectedOutside), 0);
            if (material.parameter[shared::kDielectricIor] >= kMinIorInside) consider(by(shared::kReflectedInside), 0);
        }
    }

    // Adds them to the scene, with the patches of the sky, or else the one to aim at, unless they are too small a part
    // of all.
    void addTo(CompiledScene& out) const {
        double flux = 0;
        for (const Candidate& candidate : spheres_) flux += candidate.flux;
        if (!spheres_.empty() && flux >= kMinShare * flux_) {
            for (const Candidate& candidate : spheres_) addSpecularCaster(candidate.sphere, *sky_, out);
            for (const BrightPatch& patch : sky_->patches) out.skyPatches.push_back(patch.texels);
        } else if (aimed_.flux > 0 && aimed_.flux >= kMinShare * aimedFlux_) {
            out.globals.aimed = aimedSphere(aimed_.sphere, *sky_, out);
        }
    }

  private:
    // A sample finds light i, of radiance L_i and irradiance E_i, with probability E_i / (pi L_i): its second moment is
    // sum(L_i E_i) / pi, its mean sum(E_i) / pi. Of the second moment only what is connected to counts. Returns whether
    // the sphere is worth connections.
    bool consider(const shared::SpecularCaster& sphere, double minVariance) {
        if (!sky_) sky_ = findBrightSky(scene_);
        const LightsOnSphere lights = lightsOn(sphere, scene_, *sky_);
        if (lights.connected.empty()) return false;
        const double mean = lights.irradiance;
        double second = 0;
        for (const LightOnSphere& light : lights.connected) second += light.noise();
        const double radius = static_cast<double>(sphere.radius);
        const bool refracts = sphere.crossings == shared::kRefracted;
        const double part = refracts ? 1 : meanFraction(static_cast<double>(sphere.inverseEta), sphere.crossings);
        const double flux = mean * radius * radius * part;
        if (!(flux > 0)) return false;
        const double variance = (std::numbers::pi * second / (mean * mean) - 1) * part;
        if (variance >= minVariance) add({sphere, flux});
        if (variance >= kWorthAiming && refracts) {
            aimedFlux_ += flux;
            if (flux > aimed_.flux) aimed_ = {sphere, flux};
        }
        return variance >= minVariance;
    }

    void add(const Candidate& candidate) {
        flux_ += candidate.flux;
        spheres_.insert(std::ranges::upper_bound(spheres_, candidate.flux, std::greater(), &Candidate::flux),
                        candidate);
        if (spheres_.size() > shared::kConnectedSpheres) spheres_.pop_back();
    }

    const CompiledScene& scene_;
    const double minVariance_;
    std::optional<BrightSky> sky_; // found when the first sphere asks for it
    std::vector<Candidate> spheres_;
    double flux_ = 0; // of all candidates
    Candidate aimed_{};
    double aimedFlux_ = 0; // of all that are worth aiming at
};

using Visit = std::function<void(std::uint32_t sphere, const InstancePlacement& at)>;

// Of a mirror that is the ground, say: what connections keep off its surface by, a part of the radius, would be more
// than what stands there.
bool isTooNear(const shared::Sphere& sphere) {
    return std::abs(sphere.power) < 0.02f * sphere.radius * sphere.radius;
}

// The spheres of a geometry whose own material is smooth, whatever that of an instance is.
std::vector<std::uint32_t> specularCastersOf(const CompiledScene& scene, const shared::Geometry& geometry) {
    std::vector<std::uint32_t> spheres;
    for (std::uint32_t i = geometry.firstSphere; i < geometry.firstSphere + geometry.sphereCount; ++i)
        if (isSmooth(scene.materials[scene.spheres[i].material]) && !isTooNear(scene.spheres[i])) spheres.push_back(i);
    return spheres;
}

// The smooth spheres of instances.
class InstancedSpheres {
  public:
    explicit InstancedSpheres(const CompiledScene& scene) : scene_(scene), own_(scene.geometries.size()) {
        for (std::size_t g = 1; g < scene.geometries.size(); ++g)
            own_[g] = specularCastersOf(scene, scene.geometries[g]);
        for (const shared::Instance& instance : scene.instances) count_ += countIn(instance);
    }

    std::size_t count() const { return count_; }

    void each(const Visit& visit) const {
        for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
            const std::size_t count = countIn(scene_.instances[i]);
            const std::optional<InstancePlacement> at = count > 0 ? placementOf(scene_, i) : std::nullopt;
            for (std::size_t k = 0; at && k < count; ++k) visit(sphereIn(scene_.instances[i], k), *at);
        }
    }

  private:
    // All spheres of an instance whose material replaces theirs and is smooth, or those that are smooth themselves.
    std::size_t countIn(const shared::Instance& instance) const {
        if (instance.material == shared::kNone) return own_[instance.geometry].size();
        return isSmooth(scene_.materials[instance.material]) ? scene_.geometries[instance.geometry].sphereCount : 0;
    }
    std::uint32_t sphereIn(const shared::Instance& instance, std::size_t k) const {
        if (instance.material == shared::kNone) return own_[instance.geometry][k];
        return scene_.geometries[instance.geometry].firstSphere + static_cast<std::uint32_t>(k);
    }

    const CompiledScene& scene_;
    std::vector<std::vector<std::uint32_t>> own_; // spheres of each geometry that are smooth themselves
    std::size_t count_ = 0;
};

// Visits the smooth spheres of the world and those of instances; none of either if they are more than `most`.
void eachSpecularCaster(const CompiledScene& scene, std::size_t maximum, const Visit& visit) {
    const std::vector<std::uint32_t> world = specularCastersOf(scene, scene.geometries.front());
    if (world.size() <= maximum)
        for (const std::uint32_t sphere : world) visit(sphere, {});
    const InstancedSpheres instanced(scene);
    if (instanced.count() <= maximum) instanced.each(visit);
}

} // namespace

void findSpecularCasters(CompiledScene& out, double minVariance) {
    out.specularCasters.clear();
    out.casterLights.clear();
    out.globals.aimed = {};
    out.globals.maxCasterIrradiance = 0;
    out.skyPatches.clear();
    if (out.globals.lightCount == 0) return;
    const std::size_t maximum = kMaxPairs / std::max(out.globals.lightCount, shared::kCasterLights);
    CasterSelection brightest(out, minVariance);
    eachSpecularCaster(out, maximum,
                       [&](std::uint32_t sphere, const InstancePlacement& at) { brightest.consider(sphere, at); });
    brightest.addTo(out);
}

std::vector<shared::SpecularCaster> allSpecularCasters(const CompiledScene& scene, std::size_t maximum) {
    std::vector<shared::SpecularCaster> spheres;
    eachSpecularCaster(scene, maximum, [&](std::uint32_t index, const InstancePlacement& at) {
        const bool isGlass = !isMirror(materialAt(scene, index, at));
        spheres.push_back(specularCaster(scene, index, at, isGlass ? shared::kRefracted : shared::kReflectedOutside));
    });
    return spheres;
}

} // namespace rt::scene
