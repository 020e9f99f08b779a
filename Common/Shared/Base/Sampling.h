// What samplers have in common: frames, hemispheres, disks and spheres, heuristics, origins of secondary rays. A
// sampler maps a pair of uniforms on the grid of Random.h, k 2^-24 in [0, 1 - 2^-24], to its domain; densities are per
// steradian.
#ifndef RT_SHARED_SAMPLING_H
#define RT_SHARED_SAMPLING_H
#include "Common/Shared/Base/Elementary.h"

RT_SHARED_BEGIN

// ---- frames --------------------------------------------------------------------------------------------------------

// Right-handed, orthonormal; local z is `normal`.
struct Frame {
    vec3 tangent;
    vec3 bitangent;
    vec3 normal;
};

// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017. Continuous except across n.z = 0, where the
// sign bit decides, so that -0 goes the same way on every device.
RT_FN Frame makeFrame(vec3 n) {
    float s = signOf(n.z);
    float a = -1.0f / (s + n.z);
    float b = n.x * n.y * a;
    Frame f;
    f.tangent = vec3(1.0f + s * n.x * n.x * a, s * b, -s * n.x);
    f.bitangent = vec3(b, s + n.y * n.y * a, -n.y);
    f.normal = n;
    return f;
}

RT_FN vec3 toWorld(RT_IN(Frame) f, vec3 local) {
    return f.tangent * local.x + f.bitangent * local.y + f.normal * local.z;
}

RT_FN float square(float x) {
    return x * x;
}

// `first ? a : b` without a branch, for loops over lanes.
RT_FN vec2 select(bool first, vec2 a, vec2 b) {
    return vec2(first ? a.x : b.x, first ? a.y : b.y);
}
RT_FN vec3 select(bool first, vec3 a, vec3 b) {
    return vec3(first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z);
}

RT_FN float maxComponent(vec3 v) {
    return max(v.x, max(v.y, v.z));
}

RT_FN float luminance(vec3 rgb) {
    return 0.2126f * rgb.x + 0.7152f * rgb.y + 0.0722f * rgb.z;
}

// ---- standard domains ----------------------------------------------------------------------------------------------

// Where in an interval, [0,1], the integral of the linear function from a at 0 to b at 1 reaches `part`.
RT_FN float invertLinear(float a, float b, float part) {
    float root = sqrt(max(a * a + 2.0f * (b - a) * part, 0.0f));
    return min(2.0f * part / max(a + root, 1.0e-37f), 1.0f);
}

// Uniform on the unit disk, as (x, y, r) with |r| the radius: the concentric map (Shirley & Chiu 1997), which keeps
// neighbours neighbours. Grid points are moved to the middle of their cells, so the centre and the rim are never hit.
RT_FN vec3 sampleDiskRadius(vec2 u) {
    float a = (2.0f * u.x - 1.0f) + kEpsilon;
    float b = (2.0f * u.y - 1.0f) + kEpsilon;
    bool wide = abs(a) > abs(b);
    conditionalSwap(wide, a, b); // b is the radius
    vec2 sc = sinCosOctant(0.125f * a / b);
    conditionalSwap(wide, sc.x, sc.y);
    return vec3(b * sc.x, b * sc.y, b);
}

RT_FN vec2 sampleDisk(vec2 u) {
    vec3 d = sampleDiskRadius(u);
    return vec2(d.x, d.y);
}

// Density z / pi about local +z; z >= 3e-4.
RT_FN vec3 sampleCosineHemisphere(vec2 u) {
    vec3 d = sampleDiskRadius(u);
    return vec3(d.x, d.y, sqrt((1.0f - d.z) * (1.0f + d.z)));
}

// Density 1 / (4 pi).
RT_FN vec3 sampleSphere(vec2 u) {
    float z = 1.0f - 2.0f * u.x;
    float r = 2.0f * sqrt(u.x * (1.0f - u.x));
    vec2 sc = sinCos2Pi(u.y);
    return vec3(r * sc.y, r * sc.x, z);
}

// ---- multiple importance sampling ----------------------------------------------------------------------------------

// Weight of the technique whose density is pdfA, against one of density pdfB. As 1 / (1 + ratio) nothing overflows.
RT_FN float balanceHeuristic(float pdfA, float pdfB) {
    return pdfA > 0.0f ? 1.0f / (1.0f + pdfB / pdfA) : 0.0f;
}

RT_FN float powerHeuristic(float pdfA, float pdfB) {
    return pdfA > 0.0f ? 1.0f / (1.0f + square(pdfB / pdfA)) : 0.0f;
}

// ---- origins of secondary rays -------------------------------------------------------------------------------------

// Moves p, known to within +-error per axis, along the geometric normal n to the side of w, so far that it lies beyond
// the true surface whatever the error and the rounding of the result. No absolute length enters: scaling by 2^k is
// exact.
RT_FN vec3 offsetOrigin(vec3 p, vec3 error, vec3 n, vec3 w) {
    float reach = dot(abs(n), error + abs(p) * (2.0f * kEpsilon));
    return p + n * (dot(n, w) < 0.0f ? -reach : reach);
}

// What a device's own test of a flat primitive may round by, in every direction: it works with the distances of the
// corners from the ray. A ray that leaves a large floor may so meet it again, although its height there is exact:
// without this an NVIDIA GPU lost up to a fifth of the light that reaches a point on the diagonal of a quad of 100 by
// 100. There 1 is too little and 2 is enough; much more would lift the origins of rays noticeably.
const float kExtentError = 3.0f;

RT_FN float extentError(vec3 edgeU, vec3 edgeV) {
    return kExtentError * kEpsilon * maxComponent(abs(edgeU) + abs(edgeV));
}

RT_SHARED_END

#endif
