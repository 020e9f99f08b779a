// Sampling of disks: uniform in area, or as the spherical ellipse that is seen of them.
#ifndef RT_SHARED_DISK_LIGHT_H
#define RT_SHARED_DISK_LIGHT_H
#include "Common/Shared/Light/FlatLight.h"
#include "Common/Shared/Shape/Rounds.h"
#include "Common/Shared/Shape/SphericalEllipse.h"
#include "Common/Shared/Shape/SphericalShapes.h"

RT_SHARED_BEGIN

// Whether the half axes are at right angles and as long as each other: of all that affine maps make of a circle, only
// circles are sampled by what is seen of them.
RT_FN bool isCircle(vec3 edgeU, vec3 edgeV) {
    float u2 = dot(edgeU, edgeU);
    float skew = dot(edgeU, edgeV);
    return skew * skew <= 1.0e-12f * u2 * u2 && abs(u2 - dot(edgeV, edgeV)) <= 2.0e-6f * u2;
}

// Radius of a hole over that of the disk beyond which what is left of an azimuth takes too many digits.
const float kThinnestRing = 0.99f;

// The plane of the disk must be seen under an angle that a direction resolves.
RT_FN uint diskLightStrategy(RT_IN(RenderParams) params, RT_IN(Light) light, vec3 toCenter) {
    bool byArea = params.quadLight == kShapeArea || !isCircle(light.edgeU, light.edgeV) || light.radius > kThinnestRing;
    if (params.quadLight == kShapeAuto) byArea = byArea || isFar(toCenter, light.edgeU, light.edgeV);
    float height = dot(toCenter, light.normal);
    float d2 = dot(toCenter, toCenter);
    bool isResolved = dot(light.edgeU, light.edgeU) >= kTinyExtent * kTinyExtent * d2 &&
                      height * height >= kTinyExtent * kTinyExtent * d2;
    return byArea || !isResolved ? kStrategyArea : kStrategySolidAngle;
}

// `normal`: the receiver's, zero in a medium; so in all of these.
RT_FN vec3 diskReceiver(RT_IN(RenderParams) params, RT_IN(SphericalEllipse) e, vec3 normal) {
    return params.quadLight == kShapeAuto ? toEllipse(e, normal) : vec3(0.0f);
}

// A point of the unit disk but for its hole, uniform in area.
RT_FN vec2 sampleRing(float hole, vec2 u) {
    vec3 p = sampleDiskRadius(u);
    float radius = sqrt(mix(hole * hole, 1.0f, p.z * p.z));
    return vec2(p.x, p.y) * (radius / abs(p.z));
}

RT_CALL LightSample sampleDiskLight(RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal,
                                    vec2 u) {
    LightSample s = noLightSample();
    vec3 toCenter = light.position - position;
    bool byArea = diskLightStrategy(params, light, toCenter) == kStrategyArea;
    vec3 fromCenter;
    vec2 place;
    if (byArea) {
        place = sampleRing(light.radius, u);
        fromCenter = light.edgeU * place.x + light.edgeV * place.y;
    } else {
        float radius = length(light.edgeU);
        SphericalEllipse e = makeSphericalEllipse(toCenter, light.normal, radius, light.radius);
        EllipseSample drawn = sampleSphericalEllipse(e, diskReceiver(params, e, normal), u);
        fromCenter = (e.aside * drawn.place.x + e.y * drawn.place.y) * radius;
        place = vec2(dot(fromCenter, light.edgeU), dot(fromCenter, light.edgeV)) / (radius * radius);
        s.pdf = drawn.pdf;
    }
    vec3 v = toCenter + fromCenter;
    s.distance = length(v);
    s.wi = v * (1.0f / s.distance);
    s.point = light.position + fromCenter;
    s.normal = light.normal;
    if (byArea) s.pdf = areaPdf(light.area, s.distance, dot(light.normal, s.wi));
    s.uv = roundUv(vec3(place.x, place.y, 0.0f), light.radius);
    return s;
}

RT_CALL float diskLightPdf(RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal, vec3 wi,
                           float distance) {
    vec3 toCenter = light.position - position;
    if (diskLightStrategy(params, light, toCenter) == kStrategyArea) {
        return areaPdf(light.area, distance, dot(light.normal, wi));
    }
    SphericalEllipse e = makeSphericalEllipse(toCenter, light.normal, length(light.edgeU), light.radius);
    return sphericalEllipsePdf(e, diskReceiver(params, e, normal), wi);
}

RT_SHARED_END

#endif
