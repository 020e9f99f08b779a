// Light sampling by projected solid angle, the solid angle weighed by the cosine to the receiver's normal: an
// unoccluded diffuse receiver then sees no variance. This header is all that others need of the folder.
//
// Densities are on the unit disk of the receiver's tangent plane; per steradian that is times the cosine.
#ifndef RT_SHARED_PROJECTED_LIGHTS_H
#define RT_SHARED_PROJECTED_LIGHTS_H
#include "Common/Shared/Light/Projected/ProjectedCap.h"
#include "Common/Shared/Light/Projected/ProjectedPolygon.h"
#include "Common/Shared/Light/Projected/VisibleCap.h"

RT_SHARED_BEGIN

RT_FN ProjectedPolygon projectedFlat(RT_IN(Light) light, vec3 corner, vec3 normal) {
    return makeProjectedPolygon(corner, light.edgeU, light.edgeV, light.normal, light.kind == kLightTriangle, normal);
}

// (u, v) on a quad or triangle, and the density there, which is 0 if nothing of it is visible. `corner` relative to the
// receiver, `normal` the receiver's, unit.
RT_CALL vec3 sampleProjectedFlat(RT_IN(Light) light, vec3 corner, vec3 normal, vec2 u) {
    ProjectedPolygon polygon = projectedFlat(light, corner, normal);
    if (!(polygon.total > 0.0f)) return vec3(0.0f);
    return vec3(sampleProjectedPolygon(polygon, u), 1.0f / polygon.total);
}

// Density at every direction that meets the light.
RT_CALL float projectedFlatDensity(RT_IN(Light) light, vec3 corner, vec3 normal) {
    float total = projectedFlat(light, corner, normal).total;
    return total > 0.0f ? 1.0f / total : 0.0f;
}

// A direction to a sphere that the receiver is outside of, and the density there, which is 0 if nothing of it is
// visible.
RT_CALL ProjectedDirection sampleProjectedSphere(vec3 toCenter, float radius, vec3 normal, vec2 u) {
    return sampleProjectedCap(makeProjectedCap(makeSphereCone(toCenter, radius), normal), radius, u);
}

// Density at a direction that meets the sphere.
RT_CALL float projectedSphereDensity(vec3 toCenter, float radius, vec3 normal, vec3 wi) {
    return projectedCapDensity(makeProjectedCap(makeSphereCone(toCenter, radius), normal), wi);
}

RT_SHARED_END

#endif
