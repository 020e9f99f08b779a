#include "Common/Scene/Compiler/SmoothSpheres.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "Common/Scene/Affine.h"
#include "Common/Shared/Light/LightContribution.h"
#include "Common/Shared/Material/Materials.h"

namespace rt::scene {

namespace {

constexpr double kLeastIor = 1.01;   // below it a sphere focuses nothing
constexpr double kUsedFlux = 0.9;    // of what falls on a sphere; what passes near its rim is spread widely
constexpr double kLeastGain = 0.004; // of the irradiance at a sphere; less is not worth a connection
constexpr double kMostGain = 4;
constexpr std::size_t kMostInstanced = 1 << 20; // eight of more spheres matter less than the time to choose them

shared::vec2 cosineAndSine(double angle) {
    return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

bool isClearGlass(const CompiledScene& scene, std::uint32_t index) {
    const shared::Material& material = scene.materials[index];
    return material.kind == shared::kMaterialDielectric && material.parameter[0] >= kLeastIor &&
           material.texture == shared::kNone && material.emission == shared::vec3(0.0f);
}

// Where spheres stand: in the world, or in an instance that scales all lengths by one factor.
struct Standing {
    Affine toWorld;
    double scale = 1;
    std::uint32_t instance = shared::kNone;
    std::uint32_t material = shared::kNone; // replaces theirs unless kNone
};

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

shared::SmoothSphere smoothSphere(const CompiledScene& scene, std::uint32_t index, const Standing& at) {
    const shared::Sphere& sphere = scene.spheres[index];
    const shared::Material& material = scene.materials[at.material != shared::kNone ? at.material : sphere.material];
    shared::SmoothSphere smooth{};
    smooth.center = shared::vec3(at.toWorld.point(sphere.center));
    smooth.radius = static_cast<float>(static_cast<double>(sphere.radius) * at.scale);
    if (!scene.sphereMotions.empty()) smooth.motion = shared::vec3(at.toWorld.vector(scene.sphereMotions[index]));
    smooth.inverseEta = 1.0f / material.parameter[0];
    smooth.tint = material.albedo * material.albedo;
    smooth.primitive = index;
    smooth.instance = at.instance;
    if (at.instance != shared::kNone) {
        const double reach = glm::length(glm::dvec3(sphere.center)) + static_cast<double>(sphere.radius);
        smooth.error = 32 * shared::kEpsilon * static_cast<float>(at.scale * reach + glm::length(at.toWorld.offset));
    }
    return smooth;
}

shared::vec3 middleOf(const shared::SmoothSphere& sphere) { // of its way while the shutter is open
    return sphere.center + 0.5f * sphere.motion;
}

// What a light irradiates the sphere's centre by.
float irradianceAt(const shared::SmoothSphere& sphere, const shared::Light& light, const shared::LightBound& bound) {
    const bool hasExtent = light.kind < shared::kLightPoint && light.kind != shared::kLightSky;
    return hasExtent ? shared::lightContribution(bound, middleOf(sphere), shared::vec3(0.0f)) : 0.0f;
}

// How the sphere sees a light at the middle of the shutter.
shared::SphereReach reachOf(const shared::SmoothSphere& sphere, const shared::Light& light,
                            const shared::LightBound& bound) {
    const shared::vec3 toLight = bound.center - middleOf(sphere);
    const double distance = glm::length(toLight);
    const double sine = distance > bound.radius ? bound.radius / distance : 1;
    shared::SphereReach reach{};
    reach.axis = distance > 0 ? toLight / static_cast<float>(distance) : shared::vec3(0, 0, 1);
    reach.extent = cosineAndSine(std::asin(sine));
    reach.weight = irradianceAt(sphere, light, bound);
    return reach;
}

// Greatest angle, seen from the centre, between where a point is and where it would be opposite an end of the path at
// which `near` is at most nearY: over all paths but those near the rim that pass the centre on the other side.
double reachAngle(double inverseEta, double nearX, double nearY) {
    constexpr int kSteps = 1000;
    double most = 0;
    for (int k = 1; k <= kSteps; ++k) {
        const double incident = std::numbers::pi / 2 * k / kSteps, sine = std::sin(incident);
        const double turn =
            2 * (incident - std::asin(inverseEta * sine)) - std::asin(nearX * sine) - std::asin(nearY * sine);
        most = std::max(most, sine * sine < kUsedFlux ? std::abs(turn) : -turn);
    }
    return most;
}

// Mean irradiance where light from a distance of radius / nearY falls at one of radius / nearX, over that at the
// centre: as if it fell evenly on a disc. `spread` is 1 less the cosine of the extent of the light.
double meanGain(double inverseEta, double nearX, double nearY, double spread) {
    constexpr int kSteps = 64;
    double flux = 0, bent = 0;
    for (int k = 0; k < kSteps; ++k) {
        const double sine = std::sqrt((k + 0.5) / kSteps), incident = std::asin(sine);
        const double refracted = std::asin(inverseEta * sine);
        const double turn = 2 * (incident - refracted) - std::asin(nearX * sine) - std::asin(nearY * sine);
        const double across = std::sin(incident - refracted) / std::sin(incident + refracted);
        const double along = std::tan(incident - refracted) / std::tan(incident + refracted);
        const double entered = 1 - 0.5 * (across * across + along * along);
        flux += entered * entered / kSteps;
        bent += entered * entered * (1 - std::cos(turn)) / kSteps;
    }
    return std::min(flux * nearX * nearX / (2 * (2 * bent / flux + spread)), kMostGain);
}

// What the lights that a sphere sees have in common.
struct LightsSeen {
    double nearest = 0;  // greatest radius of the sphere over distance of a light
    double widest = 0;   // angle
    double meanNear = 0; // of that ratio, by weight
    double spread = 0;   // likewise, 1 less the cosine of the extent
};

// Fills `reach` and `nearest`.
void boundReach(const LightsSeen& lights, shared::SmoothSphere& sphere) {
    const double inverseEta = static_cast<double>(sphere.inverseEta);
    sphere.nearest = 1;
    for (std::uint32_t step = shared::kReachSteps; step-- > 0;) {
        const double nearX = std::min((step + 1.0) / shared::kReachSteps, 1.0);
        const double angle = std::min(reachAngle(inverseEta, nearX, lights.nearest), std::numbers::pi - lights.widest);
        const double middle = (step + 0.5) / shared::kReachSteps;
        const double gain = meanGain(inverseEta, middle, lights.meanNear, lights.spread);
        sphere.reach[step] = {static_cast<float>(std::cos(angle)), static_cast<float>(gain)};
        if (angle > 0 && gain > kLeastGain) sphere.nearest = static_cast<float>(step) / shared::kReachSteps;
    }
}

void addSphere(shared::SmoothSphere sphere, CompiledScene& out) {
    LightsSeen lights;
    double sum = 0;
    for (std::size_t i = 0; i < out.globals.lightCount; ++i) {
        const shared::SphereReach reach = reachOf(sphere, out.lights[i], out.lightBounds[i]);
        out.sphereReaches.push_back(reach);
        if (!(reach.weight > 0)) continue;
        const shared::LightBound& bound = out.lightBounds[i];
        const double distance = glm::length(bound.center - middleOf(sphere));
        const double nearest = std::max(distance - static_cast<double>(bound.radius), 0.0);
        const double radius = static_cast<double>(sphere.radius);
        lights.nearest = std::max(lights.nearest, radius / std::max(nearest, radius));
        lights.widest = std::max(lights.widest, std::acos(static_cast<double>(reach.extent.x)));
        const double weight = static_cast<double>(reach.weight);
        sum += weight;
        lights.meanNear += weight * radius / std::max<double>(distance, radius);
        lights.spread += weight * (1 - static_cast<double>(reach.extent.x));
    }
    lights.meanNear /= sum;
    lights.spread /= sum;
    boundReach(lights, sphere);
    out.smoothSpheres.push_back(sphere);
}

// A sphere of clear glass, and what falls on it.
struct Candidate {
    shared::SmoothSphere sphere;
    double flux;
};

// The candidates that most light falls on, those first; of equal ones the first that came.
class Brightest {
  public:
    Brightest(const CompiledScene& scene, double leastVariance) : scene_(scene), leastVariance_(leastVariance) {}

    // A sample finds light i, of radiance L_i and irradiance E_i, with probability E_i / (pi L_i): its second moment is
    // sum(L_i E_i) / pi, its mean sum(E_i) / pi.
    void consider(std::uint32_t index, const Standing& at) {
        const shared::SmoothSphere sphere = smoothSphere(scene_, index, at);
        double mean = 0, second = 0;
        for (std::size_t i = 0; i < scene_.globals.lightCount; ++i) {
            const double irradiance = irradianceAt(sphere, scene_.lights[i], scene_.lightBounds[i]);
            mean += irradiance;
            second += irradiance * static_cast<double>(shared::luminance(scene_.lights[i].emission));
        }
        const double radius = static_cast<double>(sphere.radius);
        const double flux = mean * radius * radius;
        if (flux > 0 && std::numbers::pi * second / (mean * mean) - 1 >= leastVariance_) add({sphere, flux});
    }

    const std::vector<Candidate>& spheres() const { return spheres_; }

  private:
    void add(const Candidate& candidate) {
        spheres_.insert(std::ranges::upper_bound(spheres_, candidate.flux, std::greater(), &Candidate::flux),
                        candidate);
        if (spheres_.size() > shared::kConnectedSpheres) spheres_.pop_back();
    }

    const CompiledScene& scene_;
    const double leastVariance_;
    std::vector<Candidate> spheres_;
};

void considerWorld(const CompiledScene& scene, Brightest& brightest) {
    const shared::Geometry& world = scene.geometries.front();
    for (std::uint32_t i = world.firstSphere; i < world.firstSphere + world.sphereCount; ++i)
        if (isClearGlass(scene, scene.spheres[i].material)) brightest.consider(i, {});
}

class InstancedGlass {
  public:
    explicit InstancedGlass(const CompiledScene& scene) : scene_(scene), own_(scene.geometries.size()) {
        for (std::size_t g = 1; g < scene.geometries.size(); ++g) {
            const shared::Geometry& geometry = scene.geometries[g];
            for (std::uint32_t i = geometry.firstSphere; i < geometry.firstSphere + geometry.sphereCount; ++i)
                if (isClearGlass(scene, scene.spheres[i].material)) own_[g].push_back(i);
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
    // All spheres of an instance whose material replaces theirs, or those of glass.
    std::size_t countIn(const shared::Instance& instance) const {
        if (instance.material == shared::kNone) return own_[instance.geometry].size();
        return isClearGlass(scene_, instance.material) ? scene_.geometries[instance.geometry].sphereCount : 0;
    }
    std::uint32_t sphereIn(const shared::Instance& instance, std::size_t k) const {
        if (instance.material == shared::kNone) return own_[instance.geometry][k];
        return scene_.geometries[instance.geometry].firstSphere + static_cast<std::uint32_t>(k);
    }

    const CompiledScene& scene_;
    std::vector<std::vector<std::uint32_t>> own_; // spheres that are of glass by themselves, of each geometry
    std::size_t count_ = 0;
};

} // namespace

void findSmoothSpheres(CompiledScene& out, double leastVariance) {
    if (out.globals.lightCount == 0 || out.globals.lightCount > shared::kContributionLights) return;
    Brightest brightest(out, leastVariance);
    considerWorld(out, brightest);
    const InstancedGlass glass(out);
    if (glass.count() <= kMostInstanced) glass.consider(brightest);
    for (const Candidate& candidate : brightest.spheres()) addSphere(candidate.sphere, out);
}

} // namespace rt::scene
