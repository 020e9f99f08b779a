#include "Common/Scene/Compiler/CasterLights.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <utility>

#include "Common/Shared/Light/LightContribution.h"
#include "Common/Shared/Light/SphereRefraction.h"
#include "Common/Shared/Material/Dielectric.h"

namespace rt::scene {

namespace {

constexpr double kUsedFlux = 0.9; // of what falls on a sphere; what passes near its rim is spread widely
// Gains of which less is not worth a connection. What is reflected is noise far away too, spread as it is.
constexpr double kMinRefracted = 0.004, kMinReflected = 2.5e-5;
constexpr int kSteps = 64; // of means over the light that falls on a sphere
constexpr double kMaxGain = 4;
constexpr double kMinReached = 0.5; // of the light that could be connected to; with less, noise stays

shared::vec2 cosineAndSine(double angle) {
    return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

shared::vec3 middleOf(const shared::SpecularCaster& sphere) { // of its way while the shutter is open
    return sphere.center + 0.5f * sphere.motion;
}

// What a light irradiates the sphere's centre by; of the sky only patches are connected to.
double irradianceAt(const shared::SpecularCaster& sphere, const shared::Light& light, const shared::LightBound& bound) {
    const bool hasExtent = light.kind <= shared::kLightEllipsoid && light.kind != shared::kLightSky;
    return hasExtent ? shared::lightContribution(bound, middleOf(sphere), shared::vec3(0.0f)) : 0.0f;
}

double irradianceOf(std::span<const LightOnSphere> lights) {
    double sum = 0;
    for (const LightOnSphere& light : lights) sum += light.irradiance;
    return sum;
}

// As many as a sphere can be connected to; none if that is too small a part of their light.
void keepNoisiest(std::vector<LightOnSphere>& lights) {
    const double minimum = kMinReached * irradianceOf(lights);
    const auto end = lights.begin() + shared::kCasterLights;
    std::ranges::partial_sort(lights, end, std::greater(), &LightOnSphere::noise);
    lights.erase(end, lights.end());
    if (irradianceOf(lights) < minimum) return lights.clear();
    std::ranges::sort(lights, {}, [](const LightOnSphere& light) { return std::pair(light.light, light.skyPatch); });
}

// How the sphere sees a light at the middle of the shutter.
shared::CasterLight reachOf(const shared::SpecularCaster& sphere, const shared::LightBound& bound) {
    const shared::vec3 toLight = bound.center - middleOf(sphere);
    const double distance = glm::length(toLight);
    const double sine = distance > bound.radius ? bound.radius / distance : 1;
    shared::CasterLight reach{};
    reach.axis = distance > 0 ? toLight / static_cast<float>(distance) : shared::vec3(0, 0, 1);
    reach.extent = cosineAndSine(std::asin(sine));
    return reach;
}

shared::CasterLight reachOf(const BrightPatch& patch) {
    shared::CasterLight reach{};
    reach.axis = patch.axis;
    reach.extent = cosineAndSine(patch.angle);
    return reach;
}

// A sphere by which light comes from one of two points to the other, each at a distance of the radius over this.
struct Ends {
    double inverseEta;
    std::uint32_t crossings;
    double nearX, nearY;
    // As `turn` in SphereRefraction.h, by the sine of the angle of incidence.
    double turn(double sine) const {
        return 2 * (std::asin(sine) - crossings * std::asin(inverseEta * sine)) - std::asin(nearX * sine) -
               std::asin(nearY * sine);
    }
};

// Of the light that meets a sphere of glass at an angle of incidence with this sine, what goes on after its crossings.
double fractionAt(double sine, double inverseEta, std::uint32_t crossings) {
    const double cosine = std::sqrt(1 - sine * sine);
    const float reflected = shared::fresnel(static_cast<float>(cosine), static_cast<float>(inverseEta)).x;
    return static_cast<double>(shared::fractionAfter(crossings, reflected));
}

// The sine of the angle of incidence in the middle of one of kSteps parts of the light that falls on a sphere.
double sineOf(int part) {
    return std::sqrt((part + 0.5) / kSteps);
}

// Greatest angle, seen from the centre, between where a point is and where it would be opposite an end of the path at
// which `near` is at most nearY, or at that end: over all paths but those near the rim that turn the other way.
double focusAngle(const Ends& ends) {
    constexpr int kAngles = 1000;
    double maximum = 0;
    for (int k = 1; k <= kAngles; ++k) {
        const double sine = std::sin(std::numbers::pi / 2 * k / kAngles), turn = ends.turn(sine);
        maximum = std::max(maximum, sine * sine < kUsedFlux ? std::abs(turn) : -turn);
    }
    return maximum;
}

// Mean irradiance where light from one end falls at the other, over that at the centre: as if it fell evenly on a disc.
// `spread` is 1 less the cosine of the extent of the light.
double focusGain(const Ends& ends, double spread) {
    double flux = 0, bent = 0;
    for (int k = 0; k < kSteps; ++k) {
        const double fraction = fractionAt(sineOf(k), ends.inverseEta, ends.crossings) / kSteps;
        flux += fraction;
        bent += fraction * (1 - std::cos(ends.turn(sineOf(k))));
    }
    return std::min(flux * ends.nearX * ends.nearX / (2 * (2 * bent / flux + spread)), kMaxGain);
}

// As focusGain(): parallel light is reflected into all directions alike. A quarter of it: it varies so little over a
// light that fewer connections do.
double reflectionGain(double inverseEta, double nearX) {
    return 0.25 * meanFraction(inverseEta, shared::kReflectedOutside) * nearX * nearX / 4;
}

// What the lights that a sphere sees have in common.
struct LightsSeen {
    double nearest = 0;  // greatest radius of the sphere over distance of a light
    double widest = 0;   // angle
    double meanNear = 0; // of that ratio, by weight
    double spread = 0;   // mean of 1 less the cosine of the extent, by weight
};

// Fills `reach` and `nearest`.
void boundReach(const LightsSeen& lights, shared::SpecularCaster& sphere) {
    const double inverseEta = static_cast<double>(sphere.inverseEta);
    const bool reflects = sphere.crossings == shared::kReflectedOutside;
    const double minGain = sphere.crossings == shared::kRefracted ? kMinRefracted : kMinReflected;
    sphere.nearest = 1;
    for (std::uint32_t step = shared::kReachSteps; step-- > 0;) {
        const double farthest = static_cast<double>(step) / shared::kReachSteps;
        const double nearest = (step + 1.0) / shared::kReachSteps, middle = (step + 0.5) / shared::kReachSteps;
        const Ends outermost{inverseEta, sphere.crossings, nearest, lights.nearest};
        const double angle = std::min(reflects ? std::numbers::pi - std::asin(farthest) : focusAngle(outermost),
                                      std::numbers::pi - lights.widest);
        const Ends typical{inverseEta, sphere.crossings, middle, lights.meanNear};
        const double gain = reflects ? reflectionGain(inverseEta, middle) : focusGain(typical, lights.spread);
        sphere.reach[step] = {static_cast<float>(std::cos(angle)), static_cast<float>(gain)};
        if (angle > 0 && gain > minGain) sphere.nearest = static_cast<float>(farthest);
    }
}

// The lights that are connected to as the sphere sees them. Fills its `reach` and `nearest`.
std::vector<shared::CasterLight> findCasterLights(shared::SpecularCaster& sphere, const BrightSky& sky,
                                                  const CompiledScene& scene) {
    std::vector<shared::CasterLight> reaches;
    LightsSeen lights;
    double sum = 0;
    for (const LightOnSphere& light : lightsOn(sphere, scene, sky).connected) {
        const bool isSky = light.skyPatch != shared::kNone;
        const shared::LightBound& bound = scene.lightBounds[light.light];
        shared::CasterLight reach = isSky ? reachOf(sky.patches[light.skyPatch]) : reachOf(sphere, bound);
        reach.axis *= shared::sideAfter(sphere.crossings);
        reach.weight = static_cast<float>(light.irradiance);
        reach.light = light.light;
        reach.skyPatch = light.skyPatch;
        reaches.push_back(reach);
        lights.widest = std::max(lights.widest, std::acos(static_cast<double>(reach.extent.x)));
        sum += light.irradiance;
        lights.spread += light.irradiance * (1 - static_cast<double>(reach.extent.x));
        if (isSky) continue; // at no distance that matters
        const double distance = glm::length(bound.center - middleOf(sphere));
        const double nearest = std::max(distance - static_cast<double>(bound.radius), 0.0);
        const double radius = static_cast<double>(sphere.radius);
        lights.nearest = std::max(lights.nearest, radius / std::max(nearest, radius));
        lights.meanNear += light.irradiance * radius / std::max<double>(distance, radius);
    }
    lights.meanNear /= sum;
    lights.spread /= sum;
    boundReach(lights, sphere);
    return reaches;
}

} // namespace

LightsOnSphere lightsOn(const shared::SpecularCaster& sphere, const CompiledScene& scene, const BrightSky& sky) {
    LightsOnSphere lights;
    lights.irradiance = sky.irradiance;
    for (std::uint32_t i = 0; i < scene.globals.lightCount; ++i) {
        const double irradiance = irradianceAt(sphere, scene.lights[i], scene.lightBounds[i]);
        if (!(irradiance > 0)) continue;
        lights.irradiance += irradiance;
        const double radiance = static_cast<double>(shared::luminance(scene.lights[i].emission));
        lights.connected.push_back({i, shared::kNone, irradiance, radiance});
    }
    for (std::uint32_t i = 0; i < sky.patches.size(); ++i)
        lights.connected.push_back({scene.globals.skyLight, i, sky.patches[i].irradiance, sky.patches[i].radiance});
    if (lights.connected.size() > shared::kCasterLights) keepNoisiest(lights.connected);
    return lights;
}

double meanFraction(double inverseEta, std::uint32_t crossings) {
    double sum = 0;
    for (int k = 0; k < kSteps; ++k) sum += fractionAt(sineOf(k), inverseEta, crossings);
    return sum / kSteps;
}

void addSpecularCaster(shared::SpecularCaster sphere, const BrightSky& sky, CompiledScene& out) {
    const std::vector<shared::CasterLight> reaches = findCasterLights(sphere, sky, out);
    sphere.firstLight = static_cast<std::uint32_t>(out.casterLights.size());
    sphere.lightCount = static_cast<std::uint32_t>(reaches.size());
    out.casterLights.insert(out.casterLights.end(), reaches.begin(), reaches.end());
    out.specularCasters.push_back(sphere);
    float irradiance = 0;
    for (const shared::CasterLight& reach : reaches) irradiance += reach.weight;
    out.globals.maxCasterIrradiance = std::max(out.globals.maxCasterIrradiance, irradiance);
}

shared::AimedSphere aimedSphere(shared::SpecularCaster sphere, const BrightSky& sky, const CompiledScene& scene) {
    // All lights as one, around their mean direction, as from where the sphere looks 33 degrees wide: paths that are
    // aimed by it have the error of those that are by each light (within 0.02 in Cornell Box Lights).
    constexpr std::uint32_t kTypicalStep = shared::kReachSteps / 4;
    constexpr double kTypicalNear = (kTypicalStep + 0.5) / shared::kReachSteps;
    const std::vector<shared::CasterLight> reaches = findCasterLights(sphere, sky, scene);
    glm::dvec3 direction(0);
    double weight = 0, angle = 0;
    for (const shared::CasterLight& reach : reaches) {
        direction += static_cast<double>(reach.weight) * glm::dvec3(reach.axis);
        weight += static_cast<double>(reach.weight);
    }
    const double length = glm::length(direction);
    direction = length > 0 ? direction / length : glm::dvec3(reaches.front().axis);
    for (const shared::CasterLight& reach : reaches) {
        const double apart = std::acos(std::clamp(glm::dot(direction, glm::dvec3(reach.axis)), -1.0, 1.0));
        angle += static_cast<double>(reach.weight) * (apart + std::acos(static_cast<double>(reach.extent.x)));
    }
    const shared::vec2 typical = sphere.reach[kTypicalStep];
    angle = std::min(angle / weight + std::acos(static_cast<double>(typical.x)), std::numbers::pi);
    shared::AimedSphere aimed{};
    aimed.center = sphere.center;
    aimed.radius = sphere.radius;
    aimed.axis = shared::vec3(-direction);
    aimed.gain = static_cast<float>(weight * static_cast<double>(typical.y) / (kTypicalNear * kTypicalNear));
    aimed.limit = static_cast<float>(std::cos(angle));
    return aimed;
}

} // namespace rt::scene
