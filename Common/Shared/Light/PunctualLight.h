// Lights without extent: points, spots and directional lights, as KHR_lights_punctual of glTF defines them. No ray hits
// them, so that only next-event estimation finds them.
#ifndef RT_SHARED_PUNCTUAL_LIGHT_H
#define RT_SHARED_PUNCTUAL_LIGHT_H
#include "Common/Shared/Light/LightSample.h"

RT_SHARED_BEGIN

RT_FN bool isPunctual(Features features, RT_IN(Light) light) {
    return has(features, kFeaturePunctualLights) && light.kind >= kLightPoint;
}

// Fraction of a spot's intensity that leaves it in the unit direction w: 1 within the inner angle, 0 from the outer one
// on, the square of a ramp over the cosine in between, as glTF recommends.
RT_FN float spotFalloff(RT_IN(Light) spot, vec3 w) {
    // 1 - cos from the chord: of narrow spots the cosine itself would leave few digits.
    vec3 chord = w - spot.normal;
    float ramp = clamp((spot.edgeU.x - 0.5f * dot(chord, chord)) * spot.edgeU.y, 0.0f, 1.0f);
    return ramp * ramp;
}

// The one direction in which the light lies. `pdf` is 1, its probability; `radiance` is the irradiance that arrives
// across it. `normal` as in sampleLight.
RT_FN LightSample samplePunctualLight(RT_IN(Light) light, vec3 position, vec3 normal) {
    LightSample s = noLightSample();
    s.radiance = light.emission;
    if (light.kind == kLightDirectional) {
        s.wi = -light.normal;
        s.distance = kInfinity;
        s.pdf = 1.0f;
    } else {
        vec3 toLight = light.position - position;
        float squared = max(dot(toLight, toLight), 1.0e-37f);
        s.distance = sqrt(squared);
        s.wi = toLight / s.distance;
        s.radiance *= 1.0f / squared;
        if (light.kind == kLightSpot) s.radiance *= spotFalloff(light, -s.wi);
        s.point = light.position;
        // Not at the very place of the light, where there is no direction.
        float strongest = maxComponent(s.radiance);
        s.pdf = squared > 1.0e-37f && strongest > 0.0f && strongest < kInfinity ? 1.0f : 0.0f;
    }
    s.normal = -s.wi;
    if (isSurface(normal) && !(dot(normal, s.wi) > 0.0f)) s.pdf = 0.0f;
    return s;
}

RT_SHARED_END

#endif
