// Traverses what Common/Accel/GpuBvh builds. One routine answers both questions, what a ray hits first and whether it
// hits anything, because lanes of a group ask both at a time.
#include "Bindings.glsl"
#include "Common/Shared/Medium/Media.h"
#include "Common/Shared/Shape/Shapes.h"

layout(constant_id = kTreeDepthId) const uint kTreeDepth = 0u; // references that a traversal has to remember
layout(constant_id = kTreeIsWideId) const uint kTreeIsWide = 0u; // nodes have four children instead of two
layout(constant_id = kIsLinearId) const uint kIsLinear = 1u;   // there are the lists instead of a tree
layout(constant_id = kListedSpheresId) const uint kListedSpheres = 0u;
layout(constant_id = kListedXQuadsId) const uint kListedXQuads = 0u; // along axes, perpendicular to x
layout(constant_id = kListedYQuadsId) const uint kListedYQuads = 0u;
layout(constant_id = kListedZQuadsId) const uint kListedZQuads = 0u;
layout(constant_id = kListedCuboidsId) const uint kListedCuboids = 0u;
layout(constant_id = kListedQuadsId) const uint kListedQuads = 0u;
layout(constant_id = kListedTrianglesId) const uint kListedTriangles = 0u;

// See PathLoop.glsl: all lanes of a group shade at a time, then all trace. Of lists a program can hold two copies.
const uint kRaysPerStep = 2u;
bool tracesApart() { return kIsLinear != 0u || !has(kFeatures, kFeatureLights); }

layout(set = 0, binding = 2, scalar) uniform LinearLists { vec4 listVectors[kListVectors]; };

// ---- shapes --------------------------------------------------------------------------------------------------------

// A ray with what the tests of shapes derive from it.
struct TracedRay {
    Ray ray;
    float inverseSquaredLength; // of its direction
    float rayLength;
    TriangleRay triangleRay;
};

TracedRay makeTracedRay(Ray ray, bool isUnit) {
    TracedRay r;
    r.ray = ray;
    float squared = isUnit ? 1.0f : dot(ray.direction, ray.direction);
    r.inverseSquaredLength = 1.0f / squared;
    r.rayLength = sqrt(squared);
    if (has(kFeatures, kFeatureTriangles)) r.triangleRay = makeTriangleRay(ray.direction);
    return r;
}

// A negative radius marks a near sphere; `index` is that of the primitive.
float testNearSphere(TracedRay r, vec4 sphere, uint index, float tMax) {
    float power = constants.arrays.spheres.at[index].power;
    return intersectSphere(r.ray, r.inverseSquaredLength, sphere.xyz, -sphere.w, power, tMax);
}

float testSphere(TracedRay r, vec4 sphere, vec3 motion, float tMax) {
    vec3 center = sphere.xyz;
    if (has(kFeatures, kFeatureMovingSpheres)) center = sphereCenter(center, motion, r.ray.time);
    return intersectSphere(r.ray, r.inverseSquaredLength, center, sphere.w, tMax);
}

ShapeHit testQuad(TracedRay r, vec4 corner, vec4 normal, vec4 dualU, vec4 dualV, float tMax) {
    QuadFrame frame;
    frame.normal = normal.xyz;
    frame.dualU = dualU.xyz;
    frame.dualV = dualV.xyz;
    frame.margin = vec2(dualU.w, dualV.w);
    return intersectQuad(r.ray, r.rayLength, corner.xyz, frame, tMax);
}

ShapeHit testTriangle(TracedRay r, vec4 vertex0, vec4 vertex1, vec4 vertex2, float tMax) {
    return intersectTriangle(r.ray.origin, r.triangleRay, vertex0.xyz, vertex1.xyz, vertex2.xyz, tMax);
}

// The nearest hit so far.
struct Nearest {
    float t;
    uint kind;
    uint place; // in the array of its kind, or the primitive itself; kNone: nothing was hit
    float u;
    float v;
};

void accept(inout Nearest nearest, ShapeHit hit, uint kind, uint place) {
    if (!(hit.t > 0.0f)) return;
    nearest.t = hit.t;
    nearest.kind = kind;
    nearest.place = place;
    nearest.u = hit.u;
    nearest.v = hit.v;
}

void acceptSphere(inout Nearest nearest, float t, uint place) {
    if (!(t > 0.0f)) return;
    nearest.t = t;
    nearest.kind = kSphere;
    nearest.place = place;
}

Nearest nothingWithin(float tMax) {
    Nearest nearest;
    nearest.t = tMax;
    nearest.kind = kSphere;
    nearest.place = kNone;
    nearest.u = 0.0f;
    nearest.v = 0.0f;
    return nearest;
}

// ---- lists ---------------------------------------------------------------------------------------------------------

// Hits beyond this do not matter. When any will do there is no order to keep: tests do not wait for each other.
float searchEnd(Nearest nearest, bool anyHit, float tMax) {
    return anyHit ? tMax : nearest.t;
}

// Marks the place of a rectangle, whose u and v are not known yet.
const uint kOnRectangle = 0x80000000u;

// The quads perpendicular to an axis, from a vector of the lists on.
void traceAxisQuads(TracedRay r, uint axis, uint first, uint count, bool anyHit, float tMax, inout Nearest nearest) {
    vec3 origin = axisLast(r.ray.origin, axis);
    vec3 direction = axisLast(r.ray.direction, axis);
    float inverse = 1.0f / direction.z;
    for (uint at = first; at < first + 2u * count; at += 2u) {
        vec4 center = listVectors[at];
        vec2 halfExtent = listVectors[at + 1u].xy;
        vec3 toCenter = axisLast(center.xyz, axis) - origin;
        float end = searchEnd(nearest, anyHit, tMax);
        float t = intersectAxisQuad(toCenter, halfExtent, direction, inverse, r.rayLength, end);
        if (t > 0.0f) {
            nearest.t = t;
            nearest.place = floatBitsToUint(center.w) | kOnRectangle;
        }
    }
}

// The face, one of a cuboid's six; kNoFace: it has none there.
uint listedFace(vec4 center, vec4 alongX, uint face) {
    uint faces = floatBitsToUint(face < 3u ? center.w : alongX.w);
    return faces >> (face < 3u ? 8u * face : 8u * face - 24u) & 255u;
}

// The cuboid that begins with this vector of the lists.
void traceCuboid(TracedRay r, uint at, bool anyHit, float tMax, inout Nearest nearest) {
    vec4 center = listVectors[at];
    vec4 alongX = listVectors[at + 1u];
    vec3 alongY = listVectors[at + 2u].xyz;
    vec3 alongZ = listVectors[at + 3u].xyz;
    vec3 f = center.xyz - r.ray.origin;
    vec3 d = r.ray.direction;
    CuboidHit hit = intersectCuboid(vec3(dot(alongX.xyz, f), dot(alongY, f), dot(alongZ, f)),
                                    vec3(dot(alongX.xyz, d), dot(alongY, d), dot(alongZ, d)));
    if (!(hit.enter <= hit.leave)) return;
    uint face = listedFace(center, alongX, hit.enterFace);
    float t = hit.enter;
    if (!(t > 0.0f) || face == kNoFace) {
        face = listedFace(center, alongX, hit.leaveFace);
        t = hit.leave;
    }
    if (t > 0.0f && t < searchEnd(nearest, anyHit, tMax) && face != kNoFace) {
        nearest.t = t;
        nearest.place = face | kOnRectangle;
    }
}

// To follow: where a rectangle was hit, if it was.
void placeOnRectangle(Ray ray, inout Nearest nearest) {
    if (nearest.place == kNone || (nearest.place & kOnRectangle) == 0u) return;
    nearest.kind = kQuad;
    nearest.place &= ~kOnRectangle;
    Quad quad = constants.arrays.quads.at[nearest.place];
    vec2 uv = rectanglePlace(ray, nearest.t, quad.corner, quad.edgeU, quad.edgeV);
    nearest.u = uv.x;
    nearest.v = uv.y;
}

// Every primitive is tested, by all lanes together.
Hit traceLinear(Ray ray, bool anyHit, float tMax) {
    TracedRay r = makeTracedRay(ray, true);
    Nearest nearest = nothingWithin(tMax);
    if (has(kFeatures, kFeatureSpheres)) {
        for (uint i = 0u; i < kListedSpheres; i++) {
            vec4 sphere = listVectors[2u * i];
            vec4 motion = listVectors[2u * i + 1u];
            uint index = floatBitsToUint(motion.w);
            float end = searchEnd(nearest, anyHit, tMax);
            float t = sphere.w < 0.0f ? testNearSphere(r, sphere, index, end) : testSphere(r, sphere, motion.xyz, end);
            acceptSphere(nearest, t, index);
        }
    }
    uint first = 2u * kListedSpheres;
    if (has(kFeatures, kFeatureQuads)) {
        traceAxisQuads(r, 0u, first, kListedXQuads, anyHit, tMax, nearest);
        first += 2u * kListedXQuads;
        traceAxisQuads(r, 1u, first, kListedYQuads, anyHit, tMax, nearest);
        first += 2u * kListedYQuads;
        traceAxisQuads(r, 2u, first, kListedZQuads, anyHit, tMax, nearest);
        first += 2u * kListedZQuads;
        for (uint i = 0u; i < kListedCuboids; i++) traceCuboid(r, first + 4u * i, anyHit, tMax, nearest);
        first += 4u * kListedCuboids;
        if (!anyHit) placeOnRectangle(ray, nearest);
        for (uint i = 0u; i < kListedQuads; i++) {
            uint at = first + 4u * i;
            vec4 normal = listVectors[at + 1u];
            ShapeHit hit = testQuad(r, listVectors[at], normal, listVectors[at + 2u], listVectors[at + 3u], nearest.t);
            accept(nearest, hit, kQuad, floatBitsToUint(normal.w));
        }
    }
    if (has(kFeatures, kFeatureTriangles)) {
        for (uint i = 0u; i < kListedTriangles; i++) {
            uint at = first + 4u * kListedQuads + 3u * i;
            vec4 vertex = listVectors[at];
            ShapeHit hit = testTriangle(r, vertex, listVectors[at + 1u], listVectors[at + 2u], nearest.t);
            accept(nearest, hit, kTriangle, floatBitsToUint(vertex.w));
        }
    }
    Hit hit;
    hit.t = nearest.place == kNone ? -1.0f : (anyHit ? 0.0f : nearest.t);
    hit.kind = nearest.kind;
    hit.primitive = nearest.place;
    hit.instance = kNone;
    hit.u = nearest.u;
    hit.v = nearest.v;
    return hit;
}

// ---- nodes ---------------------------------------------------------------------------------------------------------

vec3 slabInverse(vec3 d) {
    return vec3(slabInverse(d.x), slabInverse(d.y), slabInverse(d.z));
}

// Where the ray is within the slab, of both children. From its middle by a difference and a sum: lower and upper bound
// would have to be put in order, and GPUs compute fewer minima than sums at a time.
void clipSlab(vec4 slab, float origin, float inverse, inout vec2 entry, inout vec2 leave) {
    vec2 middle = (slab.xz - origin) * inverse;
    vec2 reach = slab.yw * abs(inverse);
    entry = max(entry, middle - reach);
    leave = min(leave, middle + reach);
}

// Of each of four children.
void clipSlabs(vec4 middles, vec4 halves, float origin, float inverse, inout vec4 entry, inout vec4 leave) {
    vec4 middle = (middles - origin) * inverse;
    vec4 reach = halves * abs(inverse);
    entry = max(entry, middle - reach);
    leave = min(leave, middle + reach);
}

// Orders the children of a wide node: where the ray enters, and in the last two bits which of the four it is.
const uint kMissed = 0xffffffffu;

uint childKey(float entry, float leave, uint place) {
    return entry <= leave ? (floatBitsToUint(entry) & ~3u) | place : kMissed;
}

uint childAt(uvec4 children, uint key) {
    uvec2 pair = (key & 2u) != 0u ? children.zw : children.xy;
    return (key & 1u) != 0u ? pair.y : pair.x;
}

void sortPair(inout uint a, inout uint b) {
    uint minimum = min(a, b);
    b = max(a, b);
    a = minimum;
}

// The keys of the children that the ray enters before tMax, the nearest first.
uvec4 sortedChildren(WideTreeNode node, vec3 origin, vec3 inverse, float tMax) {
    vec4 entry = vec4(0.0f);
    vec4 leave = vec4(tMax);
    clipSlabs(node.middleX, node.halfX, origin.x, inverse.x, entry, leave);
    clipSlabs(node.middleY, node.halfY, origin.y, inverse.y, entry, leave);
    clipSlabs(node.middleZ, node.halfZ, origin.z, inverse.z, entry, leave);
    leave *= kSlabMargin;
    uint a = childKey(entry.x, leave.x, 0u);
    uint b = childKey(entry.y, leave.y, 1u);
    uint c = childKey(entry.z, leave.z, 2u);
    uint d = childKey(entry.w, leave.w, 3u);
    sortPair(a, b);
    sortPair(c, d);
    sortPair(a, c);
    sortPair(b, d);
    sortPair(b, c);
    return uvec4(a, b, c, d);
}

// ---- trees ---------------------------------------------------------------------------------------------------------

// A lane that has found a leaf waits until the others of its group have found one or visited so many nodes: leaves are
// then tested by more lanes at a time. Found by measuring, see docs/measurements/gpu-engine.md.
uint nodesBetweenLeaves() {
    if (kTreeIsWide != 0u || has(kFeatures, kFeatureVolumes)) return 1u;
    return has(kFeatures, kFeatureLights) ? 4u : 3u;
}

bool isTreeNode(uint reference) {
    return (reference & kTreeLeaf) == 0u;
}

void testLeaf(TracedRay r, uint leaf, inout Nearest nearest) {
    uint first = treeLeafFirst(leaf);
    uint end = first + treeLeafCount(leaf);
    uint kind = treeLeafKind(leaf);
    if (has(kFeatures, kFeatureTriangles) && kind == kTriangle) {
        for (uint i = first; i < end; i++) {
            TreeTriangle triangle = constants.tree.triangles.at[i];
            ShapeHit hit = testTriangle(r, triangle.vertex0, triangle.vertex1, triangle.vertex2, nearest.t);
            accept(nearest, hit, kTriangle, i);
        }
    } else if (has(kFeatures, kFeatureQuads) && kind == kQuad) {
        for (uint i = first; i < end; i++) {
            TreeQuad quad = constants.tree.quads.at[i];
            accept(nearest, testQuad(r, quad.corner, quad.normal, quad.dualU, quad.dualV, nearest.t), kQuad, i);
        }
    } else if (has(kFeatures, kFeatureSpheres) && kind == kSphere) {
        for (uint i = first; i < end; i++) {
            vec3 motion = vec3(0.0f);
            if (has(kFeatures, kFeatureMovingSpheres)) motion = constants.tree.sphereMotions.at[i].xyz;
            vec4 sphere = constants.tree.spheres.at[i];
            float t = sphere.w < 0.0f ? testNearSphere(r, sphere, constants.tree.sphereIndices.at[i], nearest.t)
                                      : testSphere(r, sphere, motion, nearest.t);
            acceptSphere(nearest, t, i);
        }
    }
}

uint primitiveAt(uint kind, uint place) {
    if (has(kFeatures, kFeatureTriangles) && kind == kTriangle) {
        return floatBitsToUint(constants.tree.triangles.at[place].vertex0.w);
    }
    if (has(kFeatures, kFeatureQuads) && kind == kQuad) return floatBitsToUint(constants.tree.quads.at[place].normal.w);
    return constants.tree.sphereIndices.at[place];
}

Ray toObject(uint index, Ray ray) {
    vec4 row0 = constants.arrays.instances.at[index].toObject[0];
    vec4 row1 = constants.arrays.instances.at[index].toObject[1];
    vec4 row2 = constants.arrays.instances.at[index].toObject[2];
    Ray local = ray;
    local.origin = transformPoint(row0, row1, row2, ray.origin);
    local.direction = transformVector(row0, row1, row2, ray.direction);
    return local;
}

// The nearest child first; the others wait on the stack. Instances are followed one level down: what lies on the stack
// above kTreeReturn is in their space.
Hit traceTree(Ray ray, bool anyHit, float tMax) {
    uint stack[kTreeDepth + 2u]; // kTreeEnd, and a place that is written but not needed
    stack[0] = kTreeEnd;
    uint size = 1u;
    uint current = constants.tree.root;
    uint instance = kNone;
    uint hitInstance = kNone;
    TracedRay r = makeTracedRay(ray, true);
    vec3 inverse = slabInverse(ray.direction);
    Nearest nearest = nothingWithin(tMax);
    for (;;) {
        for (uint i = 0u; i < nodesBetweenLeaves() && isTreeNode(current); i++) {
            if (kTreeIsWide != 0u) {
                WideTreeNode node = constants.tree.wideNodes.at[current];
                uvec4 keys = sortedChildren(node, r.ray.origin, inverse, nearest.t);
                if (keys.w != kMissed) stack[size++] = childAt(node.children, keys.w);
                if (keys.z != kMissed) stack[size++] = childAt(node.children, keys.z);
                if (keys.y != kMissed) stack[size++] = childAt(node.children, keys.y);
                if (keys.x != kMissed) {
                    current = childAt(node.children, keys.x);
                } else {
                    current = stack[--size];
                }
            } else {
                TreeNode node = constants.tree.nodes.at[current];
                vec2 entry = vec2(0.0f);
                vec2 leave = vec2(nearest.t);
                clipSlab(node.x, r.ray.origin.x, inverse.x, entry, leave);
                clipSlab(node.y, r.ray.origin.y, inverse.y, entry, leave);
                clipSlab(node.z, r.ray.origin.z, inverse.z, entry, leave);
                leave *= kSlabMargin;
                bool enters0 = entry.x <= leave.x;
                bool enters1 = entry.y <= leave.y;
                bool second = !enters0 || (enters1 && entry.y < entry.x);
                // Written whether it is needed or not, which takes less time than to ask.
                stack[size] = second ? node.children.x : node.children.y;
                if (enters0 && enters1) size++;
                current = second ? node.children.y : node.children.x;
                if (!enters0 && !enters1) current = stack[--size];
            }
        }
        if (isTreeNode(current)) continue;
        if (current == kTreeEnd) break;
        if (has(kFeatures, kFeatureInstances) && current == kTreeReturn) {
            instance = kNone;
            r = makeTracedRay(ray, true);
            inverse = slabInverse(ray.direction);
            current = stack[--size];
        } else if (has(kFeatures, kFeatureInstances) && treeLeafKind(current) == kInstanceLeaf) {
            instance = treeLeafFirst(current);
            stack[size++] = kTreeReturn;
            r = makeTracedRay(toObject(instance, ray), false);
            inverse = slabInverse(r.ray.direction);
            current = constants.tree.instanceRoots.at[instance];
        } else {
            float before = nearest.t;
            testLeaf(r, current, nearest);
            if (has(kFeatures, kFeatureInstances) && nearest.t < before) hitInstance = instance;
            if (anyHit && nearest.place != kNone) break;
            current = stack[--size];
        }
    }
    Hit hit;
    hit.t = -1.0f;
    hit.kind = nearest.kind;
    hit.primitive = kNone;
    hit.instance = hitInstance;
    hit.u = nearest.u;
    hit.v = nearest.v;
    if (nearest.place == kNone) return hit;
    hit.t = nearest.t;
    if (!anyHit) hit.primitive = primitiveAt(nearest.kind, nearest.place);
    return hit;
}

// What the ray, of unit direction, meets in (0, tMax): the nearest, or when `anyHit` the first that is found, and then
// only the sign of t tells anything. A negative t if there is nothing.
Hit traceRay(Ray ray, bool anyHit, float tMax) {
    if (kIsLinear != 0u) return traceLinear(ray, anyHit, tMax);
    return traceTree(ray, anyHit, tMax);
}
