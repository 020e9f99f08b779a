// Where a primitive of an acceleration structure stands in the scene.
#include "Bindings.glsl"
#include "Common/Shared/Medium/Media.h"
#include "Common/Shared/Shape/Rounds.h"
#include "Common/Shared/Shape/Shapes.h"

// Of an instance with this custom index. They are numbered from 1 in the acceleration structure; the world's own
// geometry is 0.
uint instanceOf(uint customIndex) {
    if (!has(kFeatures, kFeatureInstances)) return kNone;
    return customIndex - 1u;
}

Geometry geometryOf(uint instance) {
    Geometry none;
    none.firstSphere = 0u;
    none.firstQuad = 0u;
    none.firstTriangle = 0u;
    none.firstRound = 0u;
    if (!has(kFeatures, kFeatureInstances)) return none;
    return constants.arrays.geometries.at[instance == kNone ? 0u : constants.arrays.instances.at[instance].geometry];
}

// A ray of the world in the coordinates of an instance, by the map that Surface.h brings hits back with: a device may
// invert an instance's map, and round, in ways of its own, by which a ray from an ellipsoid would meet it again.
Ray objectRay(Ray ray, uint index) {
    if (index == kNone) return ray;
    Instance instance = constants.arrays.instances.at[index];
    Ray local = ray;
    local.origin = transformPoint(instance.toObject[0], instance.toObject[1], instance.toObject[2], ray.origin);
    local.direction = transformVector(instance.toObject[0], instance.toObject[1], instance.toObject[2], ray.direction);
    return local;
}

// Where a ray of the world meets a sphere of an instance before tMax; not positive: nowhere.
float sphereHit(Ray ray, uint instance, uint index, float tMax) {
    Sphere sphere = constants.arrays.spheres.at[index];
    if (has(kFeatures, kFeatureMovingSpheres)) {
        sphere.center = sphereCenter(sphere.center, constants.arrays.sphereMotions.at[index], ray.time);
    }
    Ray local = objectRay(ray, instance);
    float inverseSquaredLength = 1.0f / dot(local.direction, local.direction);
    return intersectSphere(local, inverseSquaredLength, sphere.center, sphere.radius, sphere.power, tMax);
}

// The same of a disk or cylinder.
float roundHit(Ray ray, uint instance, uint index, float tMax) {
    Round r = constants.arrays.rounds.at[index];
    return intersectRound(objectRay(ray, instance), r.origin, roundFrame(r.edgeU, r.edgeV, r.axis), r.hole, tMax);
}

// (u, v) of a hit of one of the two triangles that a quad is in the acceleration structure; `weights` of the vertices 1
// and 2:
//
//   corner+V .------. corner+U+V     even: corner, +U, +U+V     (u, v) = (w1 + w2, w2)
//            | odd /|                odd:  corner, +U+V, +V     (u, v) = (w1, w1 + w2)
//            |  /   |
//     corner '------' corner+U
vec2 quadUv(uint triangle, vec2 weights) {
    float sum = weights.x + weights.y;
    return (triangle & 1u) == 0u ? vec2(sum, weights.y) : vec2(weights.x, sum);
}
