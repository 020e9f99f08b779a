// Sampling of triangles, uniform in area or solid angle.
#ifndef RT_SHARED_TRIANGLE_LIGHT_H
#define RT_SHARED_TRIANGLE_LIGHT_H
#include "Common/Shared/Light/FlatLight.h"
#include "Common/Shared/Shape/SphericalShapes.h"

RT_SHARED_BEGIN

RT_FN uint triangleLightStrategy(Features features, uint method, RT_IN(Light) light, vec3 corner, vec3 normal) {
    bool area = method == kShapeArea || wantsProjected(features, method, normal);
    if (method == kShapeAuto)
        area = isFar(corner + (light.edgeU + light.edgeV) * (1.0f / 3.0f), light.edgeU, light.edgeV);
    return area ? kStrategyArea : kStrategySolidAngle;
}

RT_FN SphericalTriangle triangleShape(RT_IN(Light) light, vec3 corner) {
    return makeSphericalTriangle(corner, corner + light.edgeU, corner + light.edgeV,
                                 light.normal * (2.0f * light.area));
}

RT_FN LightSample sampleTriangleLight(Features features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position,
                                      vec3 normal, vec2 u) {
    LightSample s = noLightSample();
    vec3 corner = light.position - position;
    uint strategy = triangleLightStrategy(features, params.triangleLight, light, corner, normal);
    if (strategy == kStrategySolidAngle) {
        SphericalTriangle t = triangleShape(light, corner);
        if (t.solidAngle >= kTinySolidAngle) {
            s.wi = sampleSphericalTriangle(t, u);
            projectToLight(s, light, corner, position);
            s.pdf = 1.0f / t.solidAngle;
            return s;
        }
    }
    s.uv = sampleTriangleArea(u);
    placeOnLight(s, light, position);
    s.pdf = areaPdf(light.area, s.distance, dot(light.normal, s.wi));
    return s;
}

RT_FN float triangleLightPdf(Features features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position,
                             vec3 normal, vec3 wi, float distance) {
    vec3 corner = light.position - position;
    uint strategy = triangleLightStrategy(features, params.triangleLight, light, corner, normal);
    if (strategy == kStrategySolidAngle) {
        float solidAngle = triangleShape(light, corner).solidAngle;
        if (solidAngle >= kTinySolidAngle) return 1.0f / solidAngle;
    }
    return areaPdf(light.area, distance, dot(light.normal, wi));
}

RT_SHARED_END

#endif
