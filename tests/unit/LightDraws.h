// Samples of one light as tests draw them.
#pragma once
#include "Common/Shared/Light/Lights.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {

inline const vec3 kLitUp(0, 0, 1);

inline RenderParams withMethod(uint method) {
    RenderParams params{};
    params.sphereLight = params.quadLight = params.triangleLight = method;
    return params;
}

// Estimates of the irradiance at the origin of a surface with the normal kLitUp, under a light of radiance 1, from a
// sample each.
inline test::Mean irradianceEstimates(const Light& light, uint method, std::uint32_t seed, int count) {
    test::Uniforms uniform(seed);
    test::Mean mean;
    for (int i = 0; i < count; ++i) {
        const LightSample s = sampleLight(kFeatureAll, withMethod(method), light, vec3(0), kLitUp, 0, uniform.pair());
        mean.add(s.pdf > 0 ? double(s.wi.z) / double(s.pdf) : 0);
    }
    return mean;
}

// The light with all its lengths times `scale`.
inline Light scaledLight(Light light, float scale) {
    light.position *= scale, light.edgeU *= scale, light.edgeV *= scale, light.area *= scale * scale;
    if (light.kind == kLightEllipsoid || light.kind == kLightCylinder) light.normal *= scale; // a length
    if (light.kind != kLightDisk) light.radius *= scale; // else a part of the whole one
    return light;
}

} // namespace rt::shared
