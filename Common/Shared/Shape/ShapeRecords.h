// The compiled scene's records of primitives, but for triangles, whose meshes Types.h has.
#ifndef RT_SHARED_SHAPE_RECORDS_H
#define RT_SHARED_SHAPE_RECORDS_H
#include "Common/Shared/Base/Shim.h"

RT_SHARED_BEGIN

struct Sphere {
    vec3 center;  // at time 0
    float radius; // > 0
    uint material;
    uint light;  // index into lights, or kNone
    float power; // |center|^2 - radius^2, not of their rounded values, of a near sphere; kInfinity of any other
};

// Parallelogram corner + a edgeU + b edgeV, a and b in [0,1]; the front is the side that edgeU x edgeV points to.
struct Quad {
    vec3 corner;
    vec3 edgeU;
    vec3 edgeV;
    vec3 normal; // unit, edgeU x edgeV
    uint material;
    uint light;
};

// A disk, perhaps with a hole, or an open cylinder. In its own coordinates, (u, v, w) of the point
// origin + u edgeU + v edgeV + w axis, a disk is the unit disk at w = 0 and a cylinder has the radius 1 and reaches
// from w = 0 to 1, so that any affine map of one is one. The front of a cylinder is its outside.
struct Round {
    vec3 origin; // of a disk its centre, of a cylinder that of its base
    vec3 edgeU;
    vec3 edgeV;
    vec3 axis;  // disk: unit, normal of its front; cylinder: from the centre of its base to that of its top
    float hole; // disk: radius of its hole over its own, in [0,1); negative: a cylinder
    uint material;
    uint light; // index into lights, or kNone
};

RT_SHARED_END

#endif
