// Affine maps as three rows: x' = row . (x, 1).
#ifndef RT_SHARED_TRANSFORM_H
#define RT_SHARED_TRANSFORM_H
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

RT_FN vec3 transformPoint(vec4 row0, vec4 row1, vec4 row2, vec3 p) {
    return vec3(dot(vec3(row0), p) + row0.w, dot(vec3(row1), p) + row1.w, dot(vec3(row2), p) + row2.w);
}
RT_FN vec3 transformVector(vec4 row0, vec4 row1, vec4 row2, vec3 v) {
    return vec3(dot(vec3(row0), v), dot(vec3(row1), v), dot(vec3(row2), v));
}

// The direction is not normalised, so that parameters along both rays are the same.
RT_FN Ray transformRay(vec4 row0, vec4 row1, vec4 row2, RT_IN(Ray) ray) {
    Ray r = ray;
    r.origin = transformPoint(row0, row1, row2, ray.origin);
    r.direction = transformVector(row0, row1, row2, ray.direction);
    return r;
}

RT_FN Ray rayInObject(RT_IN(Instance) instance, RT_IN(Ray) ray) {
    return transformRay(instance.toObject[0], instance.toObject[1], instance.toObject[2], ray);
}

RT_SHARED_END

#endif
