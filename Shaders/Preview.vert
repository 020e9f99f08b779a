// Places the primitives of a draw, one kind at a time and any number of instances: triangles, quads as two triangles,
// and for each sphere, disk or cylinder a box around it, of which the fragments find out where their rays meet that.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "Preview.glsl"

layout(location = 0) out vec2 weights;     // of the vertices 1 and 2 of a triangle; along the edges of a quad
layout(location = 1) flat out uvec2 place; // primitive, instance

const vec2 kQuadCorners[6] = vec2[](vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(0, 1));

vec3 trianglePoint(SceneRef scene, uint vertex, out uint primitive) {
    primitive = vertex / 3u;
    uint corner = vertex % 3u;
    weights = vec2(corner == 1u ? 1.0f : 0.0f, corner == 2u ? 1.0f : 0.0f);
    return loadPosition(scene, loadTriangle(scene, primitive)[corner]);
}

vec3 quadPoint(SceneRef scene, uint vertex, out uint primitive) {
    primitive = vertex / 6u;
    weights = kQuadCorners[vertex % 6u];
    Quad quad = loadQuad(scene, primitive);
    return quad.corner + quad.edgeU * weights.x + quad.edgeV * weights.y;
}

const float kMargin = 1.001f; // of boxes, for the rounding of their corners

// A corner of the cube from -1 to 1. Its faces turn counter-clockwise when seen from outside, also after a reflection.
vec3 cubeCorner(uint vertex, bool isReflected) {
    weights = vec2(0.0f);
    uint face = vertex / 6u % 6u;
    vec2 corner = kQuadCorners[vertex % 6u] * 2.0f - 1.0f;
    vec3 local = face < 3u ? vec3(corner, 1.0f) : vec3(corner.yx, -1.0f);
    for (uint turn = face % 3u; turn > 0u; turn--) local = local.zxy;
    if (isReflected) local.x = -local.x;
    return local;
}

vec3 sphereBoxPoint(SceneRef scene, uint vertex, bool isReflected, out uint primitive) {
    primitive = vertex / 36u;
    Sphere sphere = loadSphere(scene, primitive);
    return sphere.center + cubeCorner(vertex, isReflected) * (sphere.radius * kMargin);
}

vec3 roundBoxPoint(SceneRef scene, uint vertex, bool isReflected, out uint primitive) {
    primitive = vertex / 36u;
    Round r = loadRound(scene, primitive);
    bool isMirrored = dot(cross(r.edgeU, r.edgeV), r.axis) < 0.0f;
    vec3 local = cubeCorner(vertex, isReflected != isMirrored) * kMargin;
    // A disk's box is flat, but not so flat that rounding turns its faces round.
    float thickness = 0.01f * max(length(r.edgeU), length(r.edgeV));
    vec3 along = r.hole < 0.0f ? r.axis * (0.5f + 0.5f * local.z) : r.axis * (thickness * local.z);
    return r.origin + r.edgeU * local.x + r.edgeV * local.y + along;
}

void main() {
    SceneRef scene;
    scene.unused = 0u;
    uint index = launch.indices.at[gl_InstanceIndex];
    bool isPlaced = has(kFeatures, kFeatureInstances) && index != kNone;
    vec4 rows[3] = vec4[](vec4(1, 0, 0, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0));
    if (isPlaced) rows = loadInstance(scene, index).toWorld;
    uint vertex = uint(gl_VertexIndex);
    vec3 point;
    if (kShape == kTriangle) {
        point = trianglePoint(scene, vertex, place.x);
    } else if (kShape == kQuad) {
        point = quadPoint(scene, vertex, place.x);
    } else {
        bool isReflected = determinant(mat3(rows[0].xyz, rows[1].xyz, rows[2].xyz)) < 0.0f;
        point = kShape == kRound ? roundBoxPoint(scene, vertex, isReflected, place.x)
                                 : sphereBoxPoint(scene, vertex, isReflected, place.x);
    }
    place.y = isPlaced ? index : kNone;
    vec4 p = vec4(transformPoint(rows[0], rows[1], rows[2], point), 1.0f);
    gl_Position = vec4(dot(launch.clipX, p), dot(launch.clipY, p), launch.near, dot(launch.clipW, p));
}
