#include "Common/Scene/Compiler/SmoothSpheres.h"

#include <algorithm>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Compiler/SphereReaches.h"
#include "Common/Shared/Material/Materials.h"

namespace rt::scene {

namespace {

constexpr double kLeastIor = 1.01;              // below it a sphere focuses nothing
constexpr double kLeastShare = 0.1;             // of the light that goes on from spheres; less is not worth the time
constexpr double kMirrorWorth = 0.25;           // see kWorthConnecting
constexpr std::size_t kMostInstanced = 1 << 18; // eight of more spheres matter less than the time to choose them

bool isMirror(const shared::Material& material) {
    return material.kind == shared::kMaterialMetal && material.parameter[shared::kMetalFuzz] <= shared::kMirrorFuzz;
}

// Clear glass, or a mirror.
bool isSmooth(const shared::Material& material) {
    const bool isGlass =
        material.kind == shared::kMaterialDielectric && material.parameter[shared::kDielectricIor] >= kLeastIor;
    return (isGlass || isMirror(material)) && material.texture == shared::kNone &&
           material.emission == shared::vec3(0.0f);
}

// Where spheres stand: in the world, or in an instance that scales all lengths by one factor.
struct Standing {
    Affine toWorld;
    double scale = 1;
    std::uint32_t instance = shared::kNone;
    std::uint32_t material = shared::kNone; // replaces theirs unless kNone
};

const shared::Material& materialAt(const CompiledScene& scene, std::uint32_t sphere, const Standing& at) {
    return scene.materials[at.material != shared::kNone ? at.material : scene.spheres[sphere].material];
}

// Nothing where spheres do not stay spheres.
std::optional<Standing> standing(const CompiledScene& scene, std::uint32_t index) {
    const shared::Instance& instance = scene.instances[index];
    Standing at;
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

shared::SmoothSphere smoothSphere(const CompiledScene& scene, std::uint32_t index, const Standing& at, bool reflects) {
    const shared::Sphere& sphere = scene.spheres[index];
    const shared::Material& material = materialAt(scene, index, at);
    shared::SmoothSphere smooth{};
    smooth.center = shared::vec3(at.toWorld.point(sphere.center));
    smooth.radius = static_cast<float>(static_cast<double>(sphere.radius) * at.scale);
    if (!scene.sphereMotions.empty()) smooth.motion = shared::vec3(at.toWorld.vector(scene.sphereMotions[index]));
    smooth.inverseEta = isMirror(material) ? 0.0f : 1.0f / material.parameter[shared::kDielectricIor];
    smooth.tint = reflects ? material.albedo : material.albedo * material.albedo;
    smooth.reflects = reflects ? 1 : 0;
    smooth.primitive = index;
    smooth.instance = at.instance;
    if (at.instance != shared::kNone) {
        const double reach = glm::length(glm::dvec3(sphere.center)) + static_cast<double>(sphere.radius);
        smooth.error = 32 * shared::kEpsilon * static_cast<float>(at.scale * reach + glm::length(at.toWorld.offset));
    }
    return smooth;
}

struct Candidate {
    shared::SmoothSphere sphere;
    double flux; // that goes on from it
};

// The candidates that most light goes on from, those first; of equal ones the first that came.
class Brightest {
  public:
    Brightest(const CompiledScene& scene, double leastVariance) : scene_(scene), leastVariance_(leastVariance) {}

    void consider(std::uint32_t index, const Standing& at) {
        if (!isMirror(materialAt(scene_, index, at))) consider(smoothSphere(scene_, index, at, false));
        consider(smoothSphere(scene_, index, at, true));
    }

    // Calls add(sphere) for each, unless they are too small a part of all.
    template <typename Add>
    void forEach(const Add& add) const {
        double flux = 0;
        for (const Candidate& candidate : spheres_) flux += candidate.flux;
        if (flux < kLeastShare * flux_) return;
        for (const Candidate& candidate : spheres_) add(candidate.sphere);
    }

  private:
    // A sample finds light i, of radiance L_i and irradiance E_i, with probability E_i / (pi L_i): its second moment is
    // sum(L_i E_i) / pi, its mean sum(E_i) / pi.
    void consider(const shared::SmoothSphere& sphere) {
        double mean = 0, second = 0;
        for (std::size_t i = 0; i < scene_.globals.lightCount; ++i) {
            const double irradiance = irradianceAt(sphere, scene_.lights[i], scene_.lightBounds[i]);
            mean += irradiance;
            second += irradiance * static_cast<double>(shared::luminance(scene_.lights[i].emission));
        }
        const double radius = static_cast<double>(sphere.radius);
        const double part = sphere.reflects != 0 ? meanReflectance(static_cast<double>(sphere.inverseEta)) : 1;
        const double flux = mean * radius * radius * part;
        const double least = sphere.inverseEta == 0.0f ? leastVariance_ * kMirrorWorth : leastVariance_;
        if (flux > 0 && (std::numbers::pi * second / (mean * mean) - 1) * part >= least) add({sphere, flux});
    }

    void add(const Candidate& candidate) {
        flux_ += candidate.flux;
        spheres_.insert(std::ranges::upper_bound(spheres_, candidate.flux, std::greater(), &Candidate::flux),
                        candidate);
        if (spheres_.size() > shared::kConnectedSpheres) spheres_.pop_back();
    }

    const CompiledScene& scene_;
    const double leastVariance_;
    std::vector<Candidate> spheres_;
    double flux_ = 0; // of all candidates
};

void considerWorld(const CompiledScene& scene, Brightest& brightest) {
    const shared::Geometry& world = scene.geometries.front();
    for (std::uint32_t i = world.firstSphere; i < world.firstSphere + world.sphereCount; ++i)
        if (isSmooth(scene.materials[scene.spheres[i].material])) brightest.consider(i, {});
}

// The smooth spheres of instances.
class InstancedSpheres {
  public:
    explicit InstancedSpheres(const CompiledScene& scene) : scene_(scene), own_(scene.geometries.size()) {
        for (std::size_t g = 1; g < scene.geometries.size(); ++g) {
            const shared::Geometry& geometry = scene.geometries[g];
            for (std::uint32_t i = geometry.firstSphere; i < geometry.firstSphere + geometry.sphereCount; ++i)
                if (isSmooth(scene.materials[scene.spheres[i].material])) own_[g].push_back(i);
        }
        for (const shared::Instance& instance : scene.instances) count_ += countIn(instance);
    }

    std::size_t count() const { return count_; }

    void consider(Brightest& brightest) const {
        for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
            const std::size_t count = countIn(scene_.instances[i]);
            const std::optional<Standing> at = count > 0 ? standing(scene_, i) : std::nullopt;
            for (std::size_t k = 0; at && k < count; ++k) brightest.consider(sphereIn(scene_.instances[i], k), *at);
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

} // namespace

void findSmoothSpheres(CompiledScene& out, double leastVariance) {
    if (out.globals.lightCount == 0 || out.globals.lightCount > shared::kContributionLights) return;
    Brightest brightest(out, leastVariance);
    considerWorld(out, brightest);
    const InstancedSpheres instanced(out);
    if (instanced.count() <= kMostInstanced) instanced.consider(brightest);
    brightest.forEach([&](const shared::SmoothSphere& sphere) { addSmoothSphere(sphere, out); });
}

} // namespace rt::scene
