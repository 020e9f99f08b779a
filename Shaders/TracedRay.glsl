// A ray on its way through lists or a tree of compute shaders: the tests of shapes, and the nearest hit.

// The ray with what the tests of shapes derive from it.
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

float testRound(TracedRay r, vec4 origin, vec4 dualU, vec4 dualV, vec4 dualW, float tMax) {
    RoundFrame frame;
    frame.dualU = dualU.xyz;
    frame.dualV = dualV.xyz;
    frame.dualW = dualW.xyz;
    return intersectRound(r.ray, origin.xyz, frame, origin.w, tMax);
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

void acceptRound(inout Nearest nearest, float t, uint place) {
    if (!(t > 0.0f)) return;
    nearest.t = t;
    nearest.kind = kRound;
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
