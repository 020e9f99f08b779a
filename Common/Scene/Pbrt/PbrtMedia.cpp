#include "Common/Scene/Pbrt/PbrtMedia.h"

#include <algorithm>
#include <utility>
#include <variant>

#include <glm/common.hpp>

#include "Common/Core/Printable.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Pbrt/PbrtValues.h"

namespace rt::scene {

void PbrtMedia::define(const std::string& name, PbrtParameters parameters) {
    const std::string type =
        parameters.oneOf("type", "", {"homogeneous", "cloud", "nanovdb", "rgbgrid", "uniformgrid"});
    if (type.empty()) parameters.fail("\"string type\" is missing");
    known_[name] = std::move(parameters);
}

// Attenuation is neither light nor reflectance: RGB counts as it is, a spectrum by its mean.
glm::dvec3 PbrtMedia::coefficient(const PbrtParameters& parameters, const char* name, const glm::dvec3& usual) {
    const PbrtParameter* found = parameters.find(name);
    if (!found) return usual;
    glm::dvec3 value(0);
    if (found->type == PbrtType::Rgb && found->numbers.size() == 3)
        value = {found->numbers[0], found->numbers[1], found->numbers[2]};
    else
        value = glm::dvec3(pbrtIndex(*found, files_));
    for (int c = 0; c < 3; ++c)
        if (!(value[c] >= 0 && value[c] <= kLargest)) found->fail("must be from 0 to 1e9");
    return value;
}

void PbrtMedia::fill(const std::string& name, PbrtShape& shape, const Affine& toWorld, const PbrtPlace& place) {
    const std::vector<ObjectDesc> objects = std::exchange(shape.objects, {});
    if (name.empty()) return;
    const auto found = known_.find(name);
    if (found == known_.end()) place.fail("the medium \"" + printable(name, 100) + "\" is not defined");
    const PbrtParameters& parameters = found->second;
    const auto* sphere = objects.size() == 1 ? std::get_if<SphereDesc>(&objects.front().shape) : nullptr;
    if (parameters.string("type", "") != "homogeneous" || !sphere || !uniformScale(toWorld))
        return notices_.add("media are left out that are not homogeneous or not within a sphere", place);
    // Those of the format's documentation, per millimetre.
    const glm::dvec3 absorbed = coefficient(parameters, "sigma_a", {0.0011, 0.0024, 0.014});
    const glm::dvec3 scattered = coefficient(parameters, "sigma_s", {2.55, 3.21, 3.77});
    const glm::dvec3 total = absorbed + scattered;
    const double mean = (total.x + total.y + total.z) / 3;
    for (const char* left : {"preset", "Le", "Lescale"})
        if (parameters.has(left)) notices_.add("\"" + std::string(left) + "\" of media is left out", parameters.place);
    if (parameters.number("g", 0) != 0) notices_.add("media scatter alike in all directions", parameters.place);
    if (!(mean > 0)) return;
    if (glm::any(glm::greaterThan(glm::abs(total - mean), glm::dvec3(1e-9 * mean))))
        notices_.add("the extinction of media is the mean over the colours", parameters.place);
    MediumDesc medium;
    medium.boundary = SphereBoundary{sphere->center, sphere->radius};
    medium.density = std::clamp(mean * parameters.number("scale", 1, 0, kLargest), 1 / kLargest, kLargest);
    medium.albedo = glm::clamp(scattered / glm::max(total, glm::dvec3(1 / kLargest)), 0.0, 1.0);
    shape.objects.push_back({medium});
}

} // namespace rt::scene
