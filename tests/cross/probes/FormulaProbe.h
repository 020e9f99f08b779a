// Every shared formula on pseudo-random arguments, valid as C++20 and as GLSL: the same function runs on both sides,
// and a test compares what comes out. Arguments are made of hashes, so they are the same words on both sides.
#ifndef RT_SHADERS_FORMULA_PROBE_H
#define RT_SHADERS_FORMULA_PROBE_H
#include "Common/Shared/Base/Random.h"
#include "Common/Shared/Camera.h"
#include "Common/Shared/Light/LightClusters.h"
#include "Common/Shared/Light/LightContribution.h"
#include "Common/Shared/Light/Lights.h"
#include "Common/Shared/Material/Bsdf.h"
#include "Common/Shared/Medium/Media.h"
#include "Common/Shared/Shape/Shapes.h"
#include "Common/Shared/Texture/Color.h"
#include "Common/Shared/Tonemap.h"
#include "ProbeArguments.h"

RT_SHARED_BEGIN

// Results are integers below kProbeFloats and bits of floats from there on.
const uint kProbeHash = 0u;
const uint kProbePermute = 1u;
const uint kProbeSampler = 2u;
const uint kProbeQuotient = 3u;
const uint kProbeFloats = 4u;
const uint kProbeSinCos = 4u;
const uint kProbeArcTan = 5u;
const uint kProbeExponential = 6u;
const uint kProbeLogarithm = 7u;
const uint kProbeSrgb = 8u;
const uint kProbeFrame = 9u;
const uint kProbeHemisphere = 10u;
const uint kProbeSphere = 11u;
const uint kProbeOffset = 12u;
const uint kProbeFresnel = 13u;
const uint kProbeMetal = 14u;
const uint kProbeMetalPdf = 15u;
const uint kProbeDielectric = 16u;
const uint kProbeSphereLight = 17u;
const uint kProbeQuadLight = 18u;
const uint kProbeTriangleLight = 19u;
const uint kProbeContribution = 20u;
const uint kProbeSphereHit = 21u;
const uint kProbeQuadHit = 22u;
const uint kProbeTriangleHit = 23u;
const uint kProbeSphereMedium = 24u;
const uint kProbeBoxMedium = 25u;
const uint kProbeFreeFlight = 26u;
const uint kProbeCamera = 27u;
const uint kProbeSphereProjected = 28u; // lights by projected solid angle, several of them cut by the horizon
const uint kProbeQuadProjected = 29u;
const uint kProbeTriangleProjected = 30u;
const uint kProbeCluster = 31u;
const uint kProbeSpherePoint = 32u;
const uint kProbeTonemap = 33u;
const uint kProbeEllipsoidLight = 34u;
const uint kProbeAxisQuadHit = 35u;
const uint kProbeCuboidHit = 36u;
const uint kProbeCount = 37u;

// In the cube [-1, 1]^3.
RT_FN vec3 cubePoint(RT_INOUT(Arguments) a) {
    vec2 xy = uniformPair(a);
    return vec3(2.0f * xy.x - 1.0f, 2.0f * xy.y - 1.0f, 2.0f * uniformNumber(a) - 1.0f);
}
// By arithmetic alone, so that both sides have nearly the same one.
RT_FN vec3 unitVector(RT_INOUT(Arguments) a) {
    vec3 v = cubePoint(a);
    float squared = dot(v, v);
    return squared > 1.0e-6f ? v / sqrt(squared) : vec3(0.0f, 0.0f, 1.0f);
}
// On the side of n.
RT_FN vec3 hemisphereVector(RT_INOUT(Arguments) a, vec3 n) {
    vec3 v = unitVector(a);
    return dot(v, n) < 0.0f ? -v : v;
}

RT_FN uvec4 probeSampler(uint i) {
    RenderParams params = probeParams(kShapeAuto);
    params.samplerKind = i % 4u;
    uvec2 words = sampleWords(makeSampler(params, i / 4u, i & 1u, i & 255u), i & 15u);
    return uvec4(words.x, words.y, 0u, 0u);
}

RT_FN Bsdf probeMaterial(uint kind, float parameter) {
    Bsdf m;
    m.kind = kind;
    m.albedo = vec3(0.8f, 0.6f, 0.4f);
    m.parameter[0] = parameter;
    m.parameter[1] = 0.0f;
    m.lobes = noLobes();
    return m;
}

RT_FN Light probeLight(RT_INOUT(Arguments) a, uint kind) {
    Light light;
    light.kind = kind;
    light.material = 0u;
    light.position = cubePoint(a) + vec3(0.0f, 3.0f, 0.0f);
    light.edgeU = vec3(0.4f, 0.0f, 0.0f) * (0.5f + uniformNumber(a));
    light.edgeV = vec3(0.0f, 0.0f, 0.7f) * (0.5f + uniformNumber(a));
    light.normal = vec3(0.0f, -1.0f, 0.0f);
    light.radius = 0.05f + 0.5f * uniformNumber(a);
    light.area = length(cross(light.edgeU, light.edgeV)) * (kind == kLightTriangle ? 0.5f : 1.0f);
    light.emission = vec3(4.0f, 3.0f, 2.0f);
    light.sides = kSidesBoth;
    light.selection = 1.0f;
    light.cdf = 1.0f;
    return light;
}

// No axis at right angles to another.
RT_FN Light probeEllipsoid(RT_INOUT(Arguments) a) {
    Light light = probeLight(a, kLightEllipsoid);
    light.edgeU += vec3(0.0f, 0.1f, -0.1f);
    light.edgeV += vec3(0.2f, 0.0f, 0.0f);
    light.normal = vec3(0.1f, 0.0f, 0.2f) + vec3(0.0f, light.radius, 0.0f);
    return light;
}

RT_FN uvec4 probeLightSample(RT_INOUT(Arguments) a, uint kind) {
    Light light = kind == kLightEllipsoid ? probeEllipsoid(a) : probeLight(a, kind);
    vec3 position = cubePoint(a);
    vec3 normal = vec3(0.0f, 1.0f, 0.0f);
    Features features = kFeatureSphereLights | kFeatureQuadLights | kFeatureTriangleLights | kFeatureEllipsoidLights;
    uint shape = a.key % 3u == 0u ? kShapeAuto : (a.key % 3u == 1u ? kShapeSolidAngle : kShapeArea);
    RenderParams params = probeParams(shape);
    LightSample s = sampleLight(features, params, light, position, normal, 0.0f, uniformPair(a));
    return floatWords(s.wi, s.pdf);
}

// The sample and, in its last word, how much the density at its direction differs from its own.
RT_FN uvec4 probeProjectedLight(RT_INOUT(Arguments) a, uint kind) {
    RenderParams params = probeParams(kShapeProjected);
    Light light = probeLight(a, kind);
    vec3 position = cubePoint(a);
    vec3 normal = unitVector(a);
    Features features = kFeatureSphereLights | kFeatureQuadLights | kFeatureTriangleLights | kMethodProjected;
    LightSample s = sampleLight(features, params, light, position, normal, 0.0f, uniformPair(a));
    if (!(s.pdf > 0.0f)) return floatWords(0.0f, 0.0f, 0.0f, 0.0f);
    float again = lightPdf(features, params, light, position, normal, 0.0f, s.wi, s.distance, s.normal);
    return floatWords(s.wi, clamp(again / s.pdf, 0.5f, 2.0f));
}

RT_FN uvec4 probeCluster(RT_INOUT(Arguments) a) {
    LightCluster c;
    c.center = cubePoint(a);
    c.radius = 0.5f * uniformNumber(a);
    c.axis = unitVector(a);
    c.meanResultantLength = uniformNumber(a);
    c.spreadCosine = sinCos2Pi(0.5f * uniformNumber(a)).y;
    c.planarIntensity = 2.0f;
    c.omnidirectionalIntensity = 0.5f;
    c.child = 7u;
    vec3 p = cubePoint(a);
    return floatWords(clusterContribution(c, p, unitVector(a)), 0.0f, 0.0f, 0.0f);
}

RT_FN uvec4 probeBsdf(RT_INOUT(Arguments) a, Bsdf m) {
    vec3 n = unitVector(a);
    vec3 wo = hemisphereVector(a, n);
    vec2 u = uniformPair(a);
    BsdfSample s = sampleBsdf(kFeatureAll, m, n, uint(u.x * 2.0f), wo, u, u.y);
    return floatWords(s.wi, s.pdf);
}

RT_FN Ray probeRay(RT_INOUT(Arguments) a) {
    Ray ray;
    ray.origin = cubePoint(a) * 4.0f;
    ray.direction = normalize(cubePoint(a) - ray.origin);
    ray.time = 0.0f;
    return ray;
}

RT_FN Medium probeMedium(uint shape) {
    Medium m;
    m.toLocal[0] = vec4(1.25f, 0.0f, 0.5f, 0.1f);
    m.toLocal[1] = vec4(0.0f, 0.75f, 0.0f, -0.2f);
    m.toLocal[2] = vec4(-0.5f, 0.0f, 1.25f, 0.3f);
    m.shape = shape;
    m.extinction = 1.0f;
    m.albedo = vec3(1.0f, 1.0f, 1.0f);
    m.texture = kNone;
    return m;
}

RT_FN Camera probeCamera() {
    Camera camera;
    camera.origin = vec3(0.25f, 0.5f, 3.0f);
    camera.corner = vec3(-2.0f, 1.125f, -4.0f);
    camera.across = vec3(4.0f, 0.0f, 0.0f);
    camera.down = vec3(0.0f, -2.25f, 0.0f);
    camera.lensU = vec3(0.1f, 0.0f, 0.0f);
    camera.lensV = vec3(0.0f, 0.1f, 0.0f);
    return camera;
}

RT_FN uvec4 probeHit(RT_INOUT(Arguments) a, Ray ray, uint which) {
    vec3 p = cubePoint(a);
    if (which == kProbeSphereHit) {
        return floatWords(intersectSphere(ray, p * 0.5f, 0.25f + uniformNumber(a), kInfinity), 0.0f, 0.0f, 0.0f);
    }
    vec3 u = cubePoint(a);
    vec3 v = cubePoint(a);
    ShapeHit hit = missedShape();
    if (which == kProbeQuadHit) {
        hit = intersectQuad(ray, p, quadFrame(u, v), kInfinity);
    } else {
        hit = intersectTriangle(ray, p, p + u, p + v, kInfinity);
    }
    return floatWords(hit.t, hit.u, hit.v, 0.0f);
}

RT_FN uvec4 probeElementary(RT_INOUT(Arguments) a, uint which) {
    vec2 u = uniformPair(a);
    if (which == kProbeSinCos) return floatWords(vec3(sinCos2Pi(u.x), 0.0f), 0.0f);
    if (which == kProbeArcTan) return floatWords(arcTan(2.0f * u.x - 1.0f, 2.0f * u.y - 1.0f), 0.0f, 0.0f, 0.0f);
    if (which == kProbeExponential) {
        return floatWords(exponential(40.0f * u.x - 20.0f), expm1(-u.y), 0.0f, 0.0f);
    }
    if (which == kProbeLogarithm) return floatWords(logarithm(u.x + 1.0e-6f), log1p(-u.y), 0.0f, 0.0f);
    return floatWords(srgbToLinear(u.x), srgbToLinear(u.y), 0.0f, 0.0f);
}

RT_FN uvec4 probeSampling(RT_INOUT(Arguments) a, uint which) {
    if (which == kProbeHemisphere) return floatWords(sampleCosineHemisphere(uniformPair(a)), 0.0f);
    if (which == kProbeSphere) return floatWords(sampleSphere(uniformPair(a)), 0.0f);
    vec3 n = unitVector(a);
    if (which == kProbeFrame) return floatWords(toWorld(makeFrame(n), vec3(0.25f, 0.5f, 0.75f)), 0.0f);
    vec3 p = cubePoint(a);
    return floatWords(offsetOrigin(p, vec3(1.0e-6f), n, unitVector(a)), 0.0f);
}

RT_FN uvec4 probeSurface(RT_INOUT(Arguments) a, uint which) {
    if (which == kProbeFresnel) {
        float cosine = uniformNumber(a);
        vec2 f = fresnel(cosine, 0.4f + 2.0f * uniformNumber(a));
        return floatWords(f.x, f.y, 0.0f, 0.0f);
    }
    float fuzz = 0.05f + 0.9f * uniformNumber(a);
    if (which == kProbeDielectric) return probeBsdf(a, probeMaterial(kMaterialDielectric, 1.5f));
    if (which == kProbeMetal) return probeBsdf(a, probeMaterial(kMaterialMetal, fuzz));
    vec3 n = unitVector(a);
    vec3 wo = hemisphereVector(a, n);
    vec4 f = evalBsdf(kFeatureAll, probeMaterial(kMaterialMetal, fuzz), n, wo, hemisphereVector(a, n));
    return floatWords(vec3(f), f.w);
}

RT_FN uvec4 probeNumbers(RT_INOUT(Arguments) a, uint which, uint i) {
    if (which == kProbeHash) return uvec4(hash3(uvec3(i, 3u, 5u)), owenScramble(i, hash1(i)));
    if (which == kProbePermute)
        return uvec4(permute(i % 977u, 977u, hash1(i)), sobolWords(i, uvec3(i, 11u, 13u)), hash1(i));
    if (which == kProbeSampler) return probeSampler(i);
    if (which == kProbeQuotient) {
        uint n = hash1(i) >> 10u;
        uint d = 1u + (hash1(i + 1u) >> (9u + i % 23u));
        uint rest;
        uint q = quotient(n, d, rest);
        return uvec4(q, rest, n / d, n % d);
    }
    return which <= kProbeSrgb ? probeElementary(a, which) : probeSampling(a, which);
}

RT_FN uvec4 probeLights(RT_INOUT(Arguments) a, uint which) {
    if (which <= kProbeTriangleLight) return probeLightSample(a, which - kProbeSphereLight);
    if (which == kProbeCluster) return probeCluster(a);
    if (which == kProbeEllipsoidLight) return probeLightSample(a, kLightEllipsoid);
    LightBound bound;
    bound.center = cubePoint(a);
    bound.radius = 0.3f;
    bound.axis = unitVector(a);
    bound.twoSided = 0.0f;
    bound.omnidirectional = 0.0f;
    bound.intensity = 2.0f;
    vec3 p = cubePoint(a);
    return floatWords(lightContribution(bound, p, unitVector(a)), 0.0f, 0.0f, 0.0f);
}

RT_FN uvec4 probeScene(RT_INOUT(Arguments) a, uint which, uint i) {
    Ray ray = probeRay(a);
    if (which <= kProbeTriangleHit) return probeHit(a, ray, which);
    if (which <= kProbeBoxMedium) {
        vec2 span = mediumInterval(probeMedium(which - kProbeSphereMedium), ray.origin, ray.direction);
        return floatWords(span.x, span.y, 0.0f, 0.0f);
    }
    if (which == kProbeFreeFlight) {
        float u = toFineUniform(hash1(i), hash1(i + 1u));
        return floatWords(sampleFreeFlight(u, 0.5f), transmittance(3.0f * u), collisionProbability(u), 0.0f);
    }
    if (which == kProbeSpherePoint) {
        // Every second sphere is huge against the ray.
        float radius = (i & 1u) == 0u ? 0.25f + uniformNumber(a) : 1000.0f;
        vec3 center = cubePoint(a) * 0.5f - vec3(0.0f, radius > 2.0f ? radius : 0.0f, 0.0f);
        float power = radius > 2.0f ? dot(center, center) - radius * radius : kInfinity;
        float t = intersectSphere(ray, 1.0f / dot(ray.direction, ray.direction), center, radius, power, kInfinity);
        if (t < 0.0f) return floatWords(t, 0.0f, 0.0f, 0.0f);
        return floatWords(spherePoint(ray, center, radius, power, t).position, 0.0f);
    }
    if (which == kProbeAxisQuadHit) {
        vec3 direction = ray.direction;
        float t = intersectAxisQuad(cubePoint(a) - ray.origin, vec2(0.4f, 0.7f), direction, 1.0f / direction.z,
                                    length(direction), kInfinity);
        if (t < 0.0f) return floatWords(t, 0.0f, 0.0f, 0.0f);
        vec3 corner = ray.origin + t * direction - vec3(0.2f, 0.3f, 0.0f);
        return floatWords(vec3(rectanglePlace(ray, t, corner, vec3(0.8f, 0.0f, 0.0f), vec3(0.0f, 1.4f, 0.0f)), t),
                          0.0f);
    }
    if (which == kProbeCuboidHit) {
        CuboidHit hit = intersectCuboid(cubePoint(a) * 0.8f - ray.origin, ray.direction);
        if (!(hit.enter <= hit.leave)) return floatWords(-1.0f, -1.0f, 0.0f, 0.0f);
        return floatWords(hit.enter, hit.leave, float(hit.enterFace), float(hit.leaveFace));
    }
    if (which == kProbeTonemap) return floatWords(tonemap(8.0f * (cubePoint(a) + 1.0f), 0.5f, i % 3u), 0.0f);
    vec2 image = uniformPair(a);
    ray = generateCameraRay(kFeatureThinLens, probeCamera(), uvec2(i % 640u, i % 360u), uvec2(640u, 360u), image,
                            uniformPair(a), 0.0f);
    return floatWords(ray.direction, ray.origin.x);
}

// Formulas that a device compiles into one pipeline: there are drivers that cannot compile all of them at once.
const uint kFamilyNumbers = 0u;
const uint kFamilySurfaces = 1u;
const uint kFamilyLights = 2u;
const uint kFamilyScene = 3u;
const uint kFamilyProjected = 4u; // and the next two: a light's shape each
const uint kFamilyCount = 7u;

RT_FN uint familyOf(uint which) {
    if (which <= kProbeOffset) return kFamilyNumbers;
    if (which <= kProbeDielectric) return kFamilySurfaces;
    if (which <= kProbeContribution || which == kProbeCluster || which == kProbeEllipsoidLight) return kFamilyLights;
    if (which >= kProbeSphereProjected && which <= kProbeTriangleProjected)
        return kFamilyProjected + which - kProbeSphereProjected;
    return kFamilyScene;
}

// family: that of the formula `which`.
RT_FN uvec4 probe(uint family, uint which, uint i) {
    Arguments a;
    a.key = i;
    a.next = which << 8u;
    if (family == kFamilyNumbers) return probeNumbers(a, which, i);
    if (family == kFamilySurfaces) return probeSurface(a, which);
    if (family == kFamilyLights) return probeLights(a, which);
    if (family == kFamilyScene) return probeScene(a, which, i);
    return probeProjectedLight(a, family - kFamilyProjected);
}

RT_SHARED_END

#endif
