// Disks and cylinders as lights: their part in Lights.h and LightDensity.h.
#ifndef RT_SHARED_ROUND_LIGHT_H
#define RT_SHARED_ROUND_LIGHT_H
#include "Common/Shared/Light/CylinderLight.h"

RT_SHARED_BEGIN

RT_CONST Features kRoundLightFeatures = kFeatureDiskLights | kFeatureCylinderLights;

RT_FN bool isCylinderLight(Features features, RT_IN(Light) light) {
    return has(features, kFeatureCylinderLights) && light.kind == kLightCylinder;
}

RT_FN bool isRoundLight(Features features, RT_IN(Light) light) {
    return (has(features, kFeatureDiskLights) && light.kind == kLightDisk) || isCylinderLight(features, light);
}

// Bound of the error of a point on it, as lightPointError().
RT_FN vec3 roundLightError(RT_IN(Light) light) {
    vec3 extent = abs(light.position) + abs(light.edgeU) + abs(light.edgeV);
    if (light.kind == kLightCylinder) extent += abs(light.normal);
    return vec3(64.0f * kEpsilon * maxComponent(extent));
}

// As sampleLight(), of a disk from its lit side.
RT_FN LightSample sampleRoundLight(Features features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position,
                                   vec3 normal, vec2 u) {
    if (isCylinderLight(features, light)) return sampleCylinderLight(params, light, position, normal, u);
    return sampleDiskLight(params, light, position, normal, u);
}

RT_FN float roundLightPdf(Features features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal,
                          vec3 wi, float distance, vec3 lightNormal) {
    if (isCylinderLight(features, light)) {
        return cylinderLightPdf(params, light, position, normal, wi, distance, lightNormal);
    }
    return diskLightPdf(params, light, position, normal, wi, distance);
}

RT_SHARED_END

#endif
