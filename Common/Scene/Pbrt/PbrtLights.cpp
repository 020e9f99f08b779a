#include "Common/Scene/Pbrt/PbrtLights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Pbrt/PbrtValues.h"

namespace rt::scene {

namespace {

constexpr const char* kLights = "point, spot, distant, infinite, goniometric, projection";

glm::dvec3 bounded(const glm::dvec3& light) {
    return glm::min(light, glm::dvec3(kLargest));
}

glm::dvec3 positionOf(const PbrtParameters& parameters, const glm::dvec3& from, const Affine& toWorld) {
    const glm::dvec3 position = toWorld.point(from);
    for (int c = 0; c < 3; ++c)
        if (!(std::abs(position[c]) <= kLargest)) parameters.fail("its place exceeds 1e9");
    return position;
}

// In which it shines, in the world.
glm::dvec3 directionOf(const PbrtParameters& parameters, const glm::dvec3& from, const glm::dvec3& to,
                       const Affine& toWorld) {
    const glm::dvec3 direction = toWorld.vector(to - from);
    if (!(glm::length(direction) > 0)) parameters.fail("\"from\" and \"to\" must differ");
    return glm::normalize(direction);
}

} // namespace

void PbrtLights::add(const std::string& kind, const PbrtParameters& parameters, const Affine& toWorld) {
    if (kind == "point" || kind == "goniometric") {
        if (kind == "goniometric") {
            parameters.find("filename");
            notices_.add("goniometric lights shine alike in all directions", parameters.place);
        }
        point(parameters, toWorld);
    } else if (kind == "spot") {
        spot(parameters, toWorld);
    } else if (kind == "projection") {
        projection(parameters, toWorld);
    } else if (kind == "distant") {
        distant(parameters, toWorld);
    } else if (kind == "infinite") {
        infinite(parameters, toWorld);
    } else {
        parameters.fail("the light is unknown; known are " + std::string(kLights));
    }
    notices_.addUnused(parameters);
}

// Spectra of light are divided by their luminance, see pbrtLightOf(), so "scale" is the luminance of what is emitted.
// Without a spectrum it is the white of sRGB.
glm::dvec3 PbrtLights::color(const PbrtParameters& parameters, const char* name) {
    const PbrtParameter* found = parameters.find(name);
    const glm::dvec3 light = found ? pbrtLight(*found, files_) : glm::dvec3(1);
    return light * parameters.number("scale", 1, 0, kLargest);
}

// "power" is the light's luminous power, by which the scale grows: over what an intensity of 1 has.
void PbrtLights::point(const PbrtParameters& parameters, const Affine& toWorld) {
    PointLightDesc light;
    light.position = positionOf(parameters, parameters.vector("from", glm::dvec3(0)), toWorld);
    const double power = parameters.number("power", -1);
    light.intensity = bounded(color(parameters, "I") * (power > 0 ? power / (4 * std::numbers::pi) : 1));
    scene_.objects.push_back({light});
}

void PbrtLights::addSpot(const PbrtParameters& parameters, SpotLightDesc light) {
    constexpr double kMinAngle = 1e-3; // degrees, as scene files have it
    if (light.outerAngle > 90) notices_.add("spot lights of more than 90 degrees end there", parameters.place);
    light.outerAngle = std::clamp(light.outerAngle, kMinAngle, 90.0);
    light.innerAngle = std::clamp(light.innerAngle, 0.0, light.outerAngle * (1 - 1e-9));
    light.intensity = bounded(light.intensity);
    scene_.objects.push_back({light});
}

void PbrtLights::spot(const PbrtParameters& parameters, const Affine& toWorld) {
    const glm::dvec3 from = parameters.vector("from", glm::dvec3(0)), to = parameters.vector("to", {0, 0, 1});
    SpotLightDesc light;
    light.position = positionOf(parameters, from, toWorld);
    light.direction = directionOf(parameters, from, to, toWorld);
    light.outerAngle = parameters.number("coneangle", 30, 0, 180);
    light.innerAngle = light.outerAngle - parameters.number("conedeltaangle", 5, 0, 180);
    light.intensity = color(parameters, "I");
    const double inner = std::cos(glm::radians(light.innerAngle)), outer = std::cos(glm::radians(light.outerAngle));
    // Over its cone, of whose edge the mean of both angles is taken.
    const double solidAngle = 2 * std::numbers::pi * ((1 - inner) + (inner - outer) / 2);
    if (const double power = parameters.number("power", -1); power > 0 && solidAngle > 0)
        light.intensity *= power / solidAngle;
    addSpot(parameters, light);
}

void PbrtLights::projection(const PbrtParameters& parameters, const Affine& toWorld) {
    notices_.add("projection lights are spots without their image", parameters.place);
    for (const char* left : {"filename", "power"}) parameters.find(left);
    SpotLightDesc light;
    light.position = toWorld.offset;
    light.direction = directionOf(parameters, {0, 0, 0}, {0, 0, 1}, toWorld);
    light.outerAngle = parameters.number("fov", 90, 0, 180) / 2;
    light.innerAngle = light.outerAngle;
    light.intensity = color(parameters, "I");
    addSpot(parameters, light);
}

void PbrtLights::distant(const PbrtParameters& parameters, const Affine& toWorld) {
    DirectionalLightDesc light;
    const glm::dvec3 from = parameters.vector("from", glm::dvec3(0)), to = parameters.vector("to", {0, 0, 1});
    light.direction = directionOf(parameters, from, to, toWorld);
    const double illuminance = parameters.number("illuminance", -1);
    light.irradiance = bounded(color(parameters, "L") * (illuminance > 0 ? illuminance : 1));
    scene_.objects.push_back({light});
}

void PbrtLights::infinite(const PbrtParameters& parameters, const Affine& toWorld) {
    if (parameters.has("portal")) notices_.add("portals of infinite lights are left out", parameters.place);
    const std::string file = parameters.string("filename", "");
    if (!file.empty()) return addImage(parameters, file, toWorld);
    const double illuminance = parameters.number("illuminance", -1);
    const glm::dvec3 light = color(parameters, "L") * (illuminance > 0 ? illuminance / std::numbers::pi : 1);
    if (auto* constant = std::get_if<ConstantBackground>(&scene_.background)) // which add up
        constant->color = bounded(constant->color + light);
    else
        notices_.add("of several infinite lights the one with an image counts alone", parameters.place);
}

// Its directions are those of the light's own space: see SkyProjection.
void PbrtLights::addImage(const PbrtParameters& parameters, const std::string& file, const Affine& toWorld) {
    ImageBackground image;
    image.file = files_.existing(file, parameters.find("filename")->place).generic_string();
    image.factor = bounded(color(parameters, "L"));
    image.projection = SkyProjection::Pbrt;
    if (parameters.number("illuminance", -1) > 0)
        notices_.add("the illuminance of images is left out", parameters.place);
    const std::optional<Affine> toLight = inverse(toWorld);
    if (!toLight) parameters.fail("its transform cannot be inverted");
    const double scale = std::cbrt(std::abs(glm::determinant(toLight->linear)));
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            image.orientation[static_cast<std::size_t>(3 * row + column)] = toLight->linear[column][row] / scale;
    const auto* constant = std::get_if<ConstantBackground>(&scene_.background);
    if (!constant || constant->color != glm::dvec3(0))
        notices_.add("of several infinite lights the one with an image counts alone", parameters.place);
    scene_.background = image;
}

void PbrtLights::addEmission(const PbrtParameters& parameters, const PbrtShape& shape, const Affine& toWorld,
                             PbrtSurface& surface) {
    const bool isTwoSided = parameters.boolean("twosided", false);
    surface.sides = isTwoSided ? Sides::Both : Sides::Front;
    surface.emission = color(parameters, "L");
    if (const std::string file = parameters.string("filename", ""); !file.empty())
        surface.emissionTexture = textures_.image(file, ColorSpace::Srgb, parameters.find("filename")->place);
    if (const double power = parameters.number("power", -1); power > 0) {
        const double area = pbrtArea(shape, toWorld) * (isTwoSided ? 2 : 1);
        // Each light of a shape has all of it, which a mesh's triangles get in the mean.
        const double factor = power * static_cast<double>(shape.lights) / (std::numbers::pi * area);
        if (area > 0) surface.emission *= std::min(factor, kLargest);
        if (!surface.emissionTexture.empty())
            notices_.add("the power of lights with an image is that without it", parameters.place);
    }
    surface.emission = bounded(surface.emission);
    if (shape.isInsideOut && !isTwoSided && surface.emission != glm::dvec3(0)) {
        surface.sides = Sides::Both;
        notices_.add("spheres and cylinders that emit inwards emit on both sides", parameters.place);
    }
    notices_.addUnused(parameters);
}

} // namespace rt::scene
