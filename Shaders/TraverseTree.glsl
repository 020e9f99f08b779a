// Traces rays through the trees of GpuBvh.
layout(constant_id = kTreeDepthId) const uint kTreeDepth = 0u;  // references that a traversal has to remember
layout(constant_id = kTreeIsWideId) const uint kTreeIsWide = 0u; // nodes have four children instead of two

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

// Of a leaf of any kind.
bool isInstanceLeaf(uint leaf) {
    return treeLeafKind(leaf) == kInstanceLeaf && !(has(kFeatures, kRoundFeatures) && isRoundLeaf(leaf));
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
            // Asked although a ground is listed and no leaf may have a near sphere: without this branch drivers make
            // slower programs (docs/measurements/2026-11-30-gpu-since-the-house.md).
            float t = sphere.w < 0.0f ? testNearSphere(r, sphere, constants.tree.sphereIndices.at[i], nearest.t)
                                      : testSphere(r, sphere, motion, nearest.t);
            acceptSphere(nearest, t, i);
        }
    } else if (has(kFeatures, kRoundFeatures) && kind == kRound) {
        for (uint i = first; i < end - 1u; i++) {
            TreeRound round = constants.tree.rounds.at[i];
            acceptRound(nearest, testRound(r, round.origin, round.dualU, round.dualV, round.dualW, nearest.t), i);
        }
    }
}

// Marks the place of a listed sphere, which is the primitive itself.
const uint kOnList = 0x80000000u;

uint primitiveAt(uint kind, uint place) {
    if (kListedNearSpheres != 0u && (place & kOnList) != 0u) return place & ~kOnList;
    if (has(kFeatures, kFeatureTriangles) && kind == kTriangle) {
        return floatBitsToUint(constants.tree.triangles.at[place].vertex0.w);
    }
    if (has(kFeatures, kFeatureQuads) && kind == kQuad) return floatBitsToUint(constants.tree.quads.at[place].normal.w);
    if (has(kFeatures, kRoundFeatures) && kind == kRound) {
        return floatBitsToUint(constants.tree.rounds.at[place].dualU.w);
    }
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
    if (kListedNearSpheres != 0u) {
        traceListedNearSpheres(r, anyHit, tMax, nearest);
        if (nearest.place != kNone) nearest.place |= kOnList;
        if (anyHit && nearest.place != kNone) current = kTreeEnd;
    }
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
        } else if (has(kFeatures, kFeatureInstances) && isInstanceLeaf(current)) {
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
