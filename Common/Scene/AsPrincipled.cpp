#include "Common/Scene/AsPrincipled.h"

#include <algorithm>
#include <cmath>

namespace rt::scene {

MaterialDesc asPrincipled(const MaterialDesc& material, std::vector<std::string>& notices) {
    if (material.kind == MaterialKind::Principled) return material;
    MaterialDesc result = material;
    result.kind = MaterialKind::Principled;
    result.principled = {};
    PrincipledDesc& p = result.principled;
    const double number = material.parameters[0].value_or(0);
    if (material.kind == MaterialKind::Dielectric) {
        p.transmission.factor = 1;
        p.roughness.factor = 0;
        p.ior = std::clamp(material.parameters[0].value_or(1.5), 1.0, kLargestIor);
        if (p.ior != material.parameters[0].value_or(1.5)) notices.emplace_back("the index of refraction becomes 1");
        if (material.albedo != ColorOrTexture(glm::dvec3(1)))
            notices.emplace_back("the tint of what a dielectric reflects is left out");
    } else if (material.kind == MaterialKind::Metal) {
        // Fuzz moves directions by up to that, facets of a width turn them by about two and a half times that.
        constexpr double kWidthOfFuzz = 0.4;
        p.metallic.factor = 1;
        p.roughness.factor = std::sqrt(kWidthOfFuzz * number);
        if (number > 0) notices.emplace_back("fuzz becomes a roughness that blurs about as much");
    } else {
        p.specular.factor = 0;
        p.roughness.factor = 1;
        if (material.kind == MaterialKind::Emitter) result.albedo = glm::dvec3(0);
    }
    return result;
}

} // namespace rt::scene
