// From a hit to the surface there: position with its rounding error, normals, texture coordinates, material, light.
#ifndef RT_SHARED_SURFACE_H
#define RT_SHARED_SURFACE_H
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/Sampling.h"
#include "Common/Shared/Base/SceneAccess.h"
#include "Common/Shared/Base/Types.h"
#include "Common/Shared/Medium/Media.h"
#include "Common/Shared/Shape/Ellipsoids.h"
#include "Common/Shared/Shape/Rounds.h"
#include "Common/Shared/Shape/Shapes.h"
#include "Common/Shared/Texture/Textures.h"

RT_SHARED_BEGIN

struct Surface {
    vec3 position;
    vec3 error;   // bound on the rounding error of position, per axis
    vec3 normal;  // geometric, unit, on the front side
    vec3 shading; // unit, on the front side; differs from normal only on smooth meshes
    vec2 uv;
    vec2 uv2;     // a mesh's second set; these two and the next two are of use to principled materials only
    vec4 color;   // of the vertices, with opacity
    vec4 tangent; // direction of u, and the bitangent's sign; w = 0: there is none
    uint material;
    uint light; // kNone: not in the light table
};

// gamma_n of Higham, "Accuracy and Stability of Numerical Algorithms", ch. 3, for float.
RT_FN float gammaBound(float n) {
    return n * kEpsilon / (1.0f - n * kEpsilon);
}

// Bound of what the engines' ways of meeting flat primitives and of placing the point add up to. That of the formulas
// below would be 7; but a device's own triangle test also has to see that a ray leaves its surface, and NVIDIA's let
// one in 2000 paths of a closed box fall through with 7.
const float kFlatError = 30.0f;

// What few surfaces have more than.
RT_FN void addDetail(vec2 uv, vec4 tangent, RT_INOUT(Surface) s) {
    s.uv2 = uv;
    s.color = vec4(1.0f, 1.0f, 1.0f, 1.0f);
    s.tangent = tangent;
}

// The object-space normal taken to world space by the inverse transpose: the columns of toObject.
RT_FN vec3 transformNormal(vec4 row0, vec4 row1, vec4 row2, vec3 n) {
    return normalize(vec3(row0) * n.x + vec3(row1) * n.y + vec3(row2) * n.z);
}

RT_FN vec3 sphereCenter(Features features, SceneRef scene, RT_IN(Sphere) sphere, uint index, float time) {
    if (!has(features, kFeatureMovingSpheres)) return sphere.center;
    return sphere.center + loadSphereMotion(scene, index) * time;
}

RT_FN Surface sphereSurface(Features features, SceneRef scene, RT_IN(Ray) ray, RT_IN(Hit) hit) {
    RT_IN(Sphere) sphere = loadSphere(scene, hit.primitive);
    vec3 center = sphereCenter(features, scene, sphere, hit.primitive, ray.time);
    SpherePoint point = spherePoint(ray, center, sphere.radius, sphere.power, hit.t);
    Surface s;
    s.normal = point.normal;
    s.shading = s.normal;
    s.position = point.position;
    s.error = vec3(point.error);
    s.uv = vec2(0.0f, 0.0f);
    if (has(features, kFeatureImages)) s.uv = sphereUv(s.normal);
    // u runs eastwards.
    if (has(features, kFeatureVertexAttributes)) addDetail(s.uv, vec4(s.normal.z, 0.0f, -s.normal.x, 1.0f), s);
    s.material = sphere.material;
    s.light = sphere.light;
    return s;
}

RT_FN Surface quadSurface(Features features, SceneRef scene, RT_IN(Hit) hit) {
    RT_IN(Quad) quad = loadQuad(scene, hit.primitive);
    Surface s;
    vec3 alongU = quad.edgeU * hit.u;
    vec3 alongV = quad.edgeV * hit.v;
    s.position = quad.corner + alongU + alongV;
    s.error =
        gammaBound(kFlatError) * (abs(quad.corner) + abs(alongU) + abs(alongV)) + extentError(quad.edgeU, quad.edgeV);
    s.normal = quad.normal;
    s.shading = quad.normal;
    s.uv = vec2(hit.u, hit.v);
    if (has(features, kFeatureVertexAttributes)) addDetail(s.uv, vec4(quad.edgeU, 1.0f), s);
    s.material = quad.material;
    s.light = quad.light;
    return s;
}

// Texture coordinates at a place of a triangle: of the set that begins at `first`, of the vertices `index`, with the
// weights of vertices 1 and 2.
RT_FN vec2 meshUv(SceneRef scene, RT_IN(Mesh) mesh, uint first, uvec3 index, vec2 weights) {
    uvec3 t = index + (first - mesh.firstVertex);
    float w = 1.0f - weights.x - weights.y;
    return loadUv(scene, t.x) * w + loadUv(scene, t.y) * weights.x + loadUv(scene, t.z) * weights.y;
}

// Vertex colour there, with opacity.
RT_FN vec4 meshColor(SceneRef scene, RT_IN(Mesh) mesh, uvec3 index, vec2 weights) {
    uvec3 c = index + (mesh.firstColor - mesh.firstVertex);
    float w = 1.0f - weights.x - weights.y;
    return loadColor(scene, c.x) * w + loadColor(scene, c.y) * weights.x + loadColor(scene, c.z) * weights.y;
}

RT_FN void addMeshDetail(SceneRef scene, RT_IN(Mesh) mesh, uvec3 index, RT_IN(Hit) hit, RT_INOUT(Surface) s) {
    float w = 1.0f - hit.u - hit.v;
    addDetail(s.uv, vec4(0.0f, 0.0f, 0.0f, 0.0f), s);
    if (mesh.firstUv2 != kNone) s.uv2 = meshUv(scene, mesh, mesh.firstUv2, index, vec2(hit.u, hit.v));
    if (mesh.firstColor != kNone) s.color = meshColor(scene, mesh, index, vec2(hit.u, hit.v));
    if (mesh.firstTangent != kNone) {
        uvec3 t = index + (mesh.firstTangent - mesh.firstVertex);
        vec4 t0 = loadTangent(scene, t.x);
        s.tangent = t0 * w + loadTangent(scene, t.y) * hit.u + loadTangent(scene, t.z) * hit.v;
        s.tangent.w = t0.w; // the same for all three
    }
}

RT_FN Surface triangleSurface(Features features, SceneRef scene, RT_IN(Hit) hit) {
    uvec3 index = loadTriangle(scene, hit.primitive);
    RT_IN(Mesh) mesh = loadMesh(scene, loadTriangleMesh(scene, hit.primitive));
    vec3 p0 = loadPosition(scene, index.x);
    vec3 p1 = loadPosition(scene, index.y);
    vec3 p2 = loadPosition(scene, index.z);
    float w = 1.0f - hit.u - hit.v;
    vec3 a = p0 * w;
    vec3 b = p1 * hit.u;
    vec3 c = p2 * hit.v;
    Surface s;
    s.position = a + b + c;
    s.error = gammaBound(kFlatError) * (abs(a) + abs(b) + abs(c)) + extentError(p1 - p0, p2 - p0);
    s.normal = normalize(cross(p1 - p0, p2 - p0));
    s.shading = s.normal;
    s.uv = vec2(hit.u, hit.v);
    if (has(features, kFeatureSmoothNormals) && mesh.firstNormal != kNone) {
        uvec3 n = index + (mesh.firstNormal - mesh.firstVertex);
        vec3 smoothed = loadNormal(scene, n.x) * w + loadNormal(scene, n.y) * hit.u + loadNormal(scene, n.z) * hit.v;
        float squared = dot(smoothed, smoothed);
        if (squared > 0.0f) s.shading = smoothed * (1.0f / sqrt(squared));
        // Vertex normals may contradict the winding, which alone decides what is the front.
        if (dot(s.shading, s.normal) < 0.0f) s.shading = -s.shading;
    }
    if (has(features, kFeatureImages) && mesh.firstUv != kNone) {
        s.uv = meshUv(scene, mesh, mesh.firstUv, index, vec2(hit.u, hit.v));
    }
    if (has(features, kFeatureVertexAttributes)) addMeshDetail(scene, mesh, index, hit, s);
    s.material = mesh.material;
    s.light = mesh.firstLight == kNone ? kNone : mesh.firstLight + hit.primitive - mesh.firstTriangle;
    return s;
}

RT_FN Surface roundSurface(Features features, SceneRef scene, RT_IN(Ray) ray, RT_IN(Hit) hit) {
    RT_IN(Round) r = loadRound(scene, hit.primitive);
    RoundPoint point = roundPoint(ray, r, hit.t);
    Surface s;
    s.position = point.position;
    s.error = vec3(point.error);
    s.normal = point.normal;
    s.shading = point.normal;
    s.uv = vec2(0.0f, 0.0f);
    if (has(features, kFeatureImages)) s.uv = roundUv(point.place, r.hole);
    if (has(features, kFeatureVertexAttributes)) {
        // u runs around from edgeU over edgeV.
        vec3 around = r.edgeV * point.place.x - r.edgeU * point.place.y;
        addDetail(s.uv, vec4(around, dot(cross(r.edgeU, r.edgeV), r.axis) < 0.0f ? -1.0f : 1.0f), s);
    }
    s.material = r.material;
    s.light = r.light;
    return s;
}

RT_FN Surface primitiveSurface(Features features, SceneRef scene, RT_IN(Ray) ray, RT_IN(Hit) hit) {
    if (has(features, kFeatureTriangles) && hit.kind == kTriangle) return triangleSurface(features, scene, hit);
    if (has(features, kFeatureQuads) && hit.kind == kQuad) return quadSurface(features, scene, hit);
    if (has(features, kRoundFeatures) && hit.kind == kRound) return roundSurface(features, scene, ray, hit);
    return sphereSurface(features, scene, ray, hit);
}

RT_FN Surface makeSurface(Features features, SceneRef scene, RT_IN(Ray) ray, RT_IN(Hit) hit) {
    if (!has(features, kFeatureInstances) || hit.instance == kNone) return primitiveSurface(features, scene, ray, hit);
    RT_IN(Instance) instance = loadInstance(scene, hit.instance);
    Ray local = ray;
    local.origin = transformPoint(instance.toObject[0], instance.toObject[1], instance.toObject[2], ray.origin);
    local.direction = transformVector(instance.toObject[0], instance.toObject[1], instance.toObject[2], ray.direction);
    Surface s = primitiveSurface(features, scene, local, hit);
    vec3 p = abs(s.position);
    vec4 r0 = abs(instance.toWorld[0]);
    vec4 r1 = abs(instance.toWorld[1]);
    vec4 r2 = abs(instance.toWorld[2]);
    s.error = transformVector(r0, r1, r2, s.error) + gammaBound(3.0f) * transformPoint(r0, r1, r2, p);
    s.position = transformPoint(instance.toWorld[0], instance.toWorld[1], instance.toWorld[2], s.position);
    s.normal = transformNormal(instance.toObject[0], instance.toObject[1], instance.toObject[2], s.normal);
    s.shading = transformNormal(instance.toObject[0], instance.toObject[1], instance.toObject[2], s.shading);
    if (has(features, kFeatureVertexAttributes)) {
        vec3 along = transformVector(instance.toWorld[0], instance.toWorld[1], instance.toWorld[2], vec3(s.tangent));
        // A map that mirrors turns the bitangent over.
        vec3 x = vec3(instance.toWorld[0]);
        float volume = dot(cross(x, vec3(instance.toWorld[1])), vec3(instance.toWorld[2]));
        s.tangent = vec4(along, volume < 0.0f ? -s.tangent.w : s.tangent.w);
    }
    if (instance.material != kNone) s.material = instance.material;
    if (has(features, kFeatureEllipsoidLights) && instance.light != kNone) {
        // Rays start where the map to the unit sphere leaves no doubt that they are outside, so that it does not light
        // itself.
        s.light = instance.light;
        vec3 q = transformPoint(abs(instance.toObject[0]), abs(instance.toObject[1]), abs(instance.toObject[2]),
                                abs(s.position));
        s.error += kEllipsoidError * transformVector(r0, r1, r2, q);
    }
    return s;
}

RT_SHARED_END

#endif
