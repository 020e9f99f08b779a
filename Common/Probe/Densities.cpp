#include "Common/Probe/Densities.h"

#include "Common/Shared/Light/Lights.h"
#include "Common/Shared/Light/Sky.h"

namespace rt::probe {

using namespace rt::shared;

LightContext contextAt(const shared::vec3& position, const shared::vec3& normal) {
    LightContext context;
    context.position = position;
    context.normal = normal;
    context.total = 0.0f;
    return context;
}

LightChoice chooseLightAt(const SceneFormulas& scene, const shared::vec2& u, LightContext& context) {
    return chooseLight(kFeatureAll, scene.view(), scene.params().lightSelection, scene.compiled()->globals.lightCount,
                       u, context);
}

float probabilityOf(const SceneFormulas& scene, uint light, const LightContext& context) {
    return lightProbability(kFeatureAll, scene.view(), scene.params().lightSelection,
                            scene.compiled()->globals.lightCount, light, context);
}

float lightDensity(const SceneFormulas& scene, const Light& light, const shared::vec3& position,
                   const shared::vec3& normal, float time, const shared::vec3& direction) {
    if (light.kind == kLightSky) return skyPdf(scene.view(), direction);
    if (isPunctual(kFeatureAll, light)) return 0.0f;
    return lightPdfAlong(kFeatureAll, scene.params(), light, position, normal, time, direction);
}

bool isHiddenByItself(const Light& light, const shared::vec3& position, float time, const LightSample& sampled) {
    constexpr float kRounding = 1e-4f;
    if (!isRoundLight(kFeatureAll, light)) return false;
    const float first = intersectRoundLight(light, position, time, sampled.wi).distance;
    return first > 0.0f && first < sampled.distance * (1.0f - kRounding);
}

float lightsDensity(const SceneFormulas& scene, const LightContext& context, float time,
                    const shared::vec3& direction) {
    float sum = 0.0f;
    for (uint k = 0; k < scene.compiled()->globals.lightCount; ++k) {
        const float density =
            lightDensity(scene, scene.view().lights[k], context.position, context.normal, time, direction);
        if (density > 0.0f) sum += density * probabilityOf(scene, k, context);
    }
    return sum;
}

Vertex vertexOn(const SceneFormulas& scene, const Surface& surface, const shared::vec3& wo) {
    PathState path{};
    path.vertex = 1u;
    path.ray.direction = -wo;
    Vertex v{};
    placeOnSurface(kFeatureAll, scene.view(), path, surface, scene.view().materials[surface.material], v);
    completeVertex(kFeatureAll, scene.view(), v);
    return v;
}

} // namespace rt::probe
