#include "Common/Scene/Compiler/SmoothSpheres.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "Common/Shared/Light/LightContribution.h"
#include "Common/Shared/Material/Materials.h"

namespace rt::scene {

namespace {

constexpr double kLeastIor = 1.01; // below it a sphere focuses nothing

shared::vec2 cosineAndSine(double angle) {
    return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

bool isConnectable(const CompiledScene& scene, const shared::Sphere& sphere) {
    const shared::Material& material = scene.materials[sphere.material];
    return material.kind == shared::kMaterialDielectric && material.parameter[0] >= kLeastIor &&
           material.texture == shared::kNone && material.emission == shared::vec3(0.0f) &&
           sphere.light == shared::kNone;
}

shared::SmoothSphere smoothSphere(const CompiledScene& scene, std::uint32_t index) {
    const shared::Sphere& sphere = scene.spheres[index];
    const shared::Material& material = scene.materials[sphere.material];
    shared::SmoothSphere smooth{};
    smooth.center = sphere.center;
    smooth.radius = sphere.radius;
    if (!scene.sphereMotions.empty()) smooth.motion = scene.sphereMotions[index];
    smooth.inverseEta = 1.0f / material.parameter[0];
    smooth.tint = material.albedo * material.albedo;
    smooth.primitive = index;
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
// which `near` is at most nearY: over the paths that pass the centre on that side.
double reachAngle(double inverseEta, double nearX, double nearY) {
    constexpr int kSteps = 1000;
    double most = 0;
    for (int k = 1; k <= kSteps; ++k) {
        const double incident = std::numbers::pi / 2 * k / kSteps, sine = std::sin(incident);
        const double turn =
            2 * (incident - std::asin(inverseEta * sine)) - std::asin(nearX * sine) - std::asin(nearY * sine);
        most = std::max(most, -turn);
    }
    return most;
}

// Fills `reach` and `nearest`, given how near the nearest light is.
void boundReach(shared::SmoothSphere& sphere, double nearY, double widest) {
    const double inverseEta = static_cast<double>(sphere.inverseEta);
    sphere.nearest = 1;
    for (std::uint32_t step = shared::kReachSteps; step-- > 0;) {
        const double nearX = std::min((step + 1.0) / shared::kReachSteps, 1.0);
        const double angle = std::min(reachAngle(inverseEta, nearX, nearY), std::numbers::pi - widest);
        sphere.reach[step] = cosineAndSine(angle);
        if (angle > 0) sphere.nearest = static_cast<float>(step) / shared::kReachSteps;
    }
}

void addSphere(std::uint32_t index, CompiledScene& out) {
    shared::SmoothSphere sphere = smoothSphere(out, index);
    double nearY = 0, widest = 0;
    for (std::size_t i = 0; i < out.globals.lightCount; ++i) {
        const shared::SphereReach reach = reachOf(sphere, out.lights[i], out.lightBounds[i]);
        out.sphereReaches.push_back(reach);
        if (!(reach.weight > 0)) continue;
        const shared::LightBound& bound = out.lightBounds[i];
        const double distance = glm::length(bound.center - middleOf(sphere));
        const double nearest = std::max(distance - static_cast<double>(bound.radius), 0.0);
        const double radius = static_cast<double>(sphere.radius);
        nearY = std::max(nearY, radius / std::max(nearest, radius));
        widest = std::max(widest, std::acos(static_cast<double>(reach.extent.x)));
    }
    boundReach(sphere, nearY, widest);
    out.smoothSpheres.push_back(sphere);
}

// What falls on it.
double flux(const CompiledScene& scene, std::uint32_t index) {
    const shared::SmoothSphere sphere = smoothSphere(scene, index);
    double sum = 0;
    for (std::size_t i = 0; i < scene.globals.lightCount; ++i)
        sum += irradianceAt(sphere, scene.lights[i], scene.lightBounds[i]);
    return sum * sphere.radius * sphere.radius;
}

struct Candidate {
    std::uint32_t index;
    double flux;
};

} // namespace

void findSmoothSpheres(CompiledScene& out) {
    if (out.globals.lightCount == 0 || out.globals.lightCount > shared::kContributionLights) return;
    const shared::Geometry& world = out.geometries.front();
    std::vector<Candidate> candidates;
    for (std::uint32_t i = world.firstSphere; i < world.firstSphere + world.sphereCount; ++i) {
        if (!isConnectable(out, out.spheres[i])) continue;
        const Candidate candidate{i, flux(out, i)};
        if (candidate.flux > 0) candidates.push_back(candidate);
    }
    std::ranges::stable_sort(candidates, std::greater(), &Candidate::flux);
    if (candidates.size() > shared::kConnectedSpheres) candidates.resize(shared::kConnectedSpheres);
    for (const Candidate& candidate : candidates) addSphere(candidate.index, out);
}

} // namespace rt::scene
