// Every sampler of directions and the choice among lights, on a few fixed cases each and under stress, valid as C++20
// and as GLSL: tests/cross/hot/SamplersTest.cpp proves the same things of what both sides draw.
#ifndef RT_SHADERS_SAMPLER_PROBE_H
#define RT_SHADERS_SAMPLER_PROBE_H
#include "Common/Shared/Base/SceneAccess.h"
#include "Common/Shared/Light/LightSelection.h"
#include "Common/Shared/Light/Lights.h"
#include "Common/Shared/Material/Bsdf.h"
#include "ProbeArguments.h"

RT_SHARED_BEGIN

// What a device compiles into one pipeline.
const uint kProbeShapes = 3u;    // families 0 to 2: lights of the kinds sphere, quad and triangle
const uint kProbeProjected = 3u; // families 3 to 5: the same by projected solid angle
const uint kProbeEllipsoids = 6u;
const uint kProbeScattering = 7u; // materials and the phase function
const uint kProbeChoice = 8u;     // among lights
const uint kProbeFamilies = 9u;
const uint kProbeCases = 4u; // of each family

const uint kProbeDraws = 0u;   // independent numbers
const uint kProbeStrata = 1u;  // blocks of kProbeSide squared jittered numbers
const uint kProbeDensity = 2u; // densities of directions
const uint kProbeStress = 3u;  // flags of what is wrong with a sample of a case that is thrown anew: 0
const uint kProbeModes = 4u;
const uint kProbeSide = 16u;
const uint kProbeLights = 12u; // to choose from

RT_FN vec3 probeUnit(RT_INOUT(Arguments) a) {
    return sampleSphere(uniformPair(a));
}
// 10^low to 10^high.
RT_FN float probeDecades(RT_INOUT(Arguments) a, float low, float high) {
    return exponential(2.302585093f * mix(low, high, uniformNumber(a)));
}
// The pair that draws sample i: in mode kProbeStrata that of a cell of a square.
RT_FN vec2 probeSquare(RT_INOUT(Arguments) a, uint mode, uint i) {
    vec2 u = uniformPair(a);
    if (mode != kProbeStrata) return u;
    vec2 cell = vec2(float(i % kProbeSide), float(i / kProbeSide % kProbeSide));
    return min((cell + u) * (1.0f / float(kProbeSide)), vec2(0.99999994f));
}

// ---- lights --------------------------------------------------------------------------------------------------------

RT_FN Light probeLightOf(uint kind, vec3 position, vec3 edgeU, vec3 edgeV, float radius) {
    Light light;
    light.kind = kind;
    light.material = 0u;
    light.position = position;
    light.edgeU = kind == kLightSphere ? vec3(0.0f) : edgeU;
    light.edgeV = edgeV;
    vec3 across = cross(edgeU, edgeV);
    float area = length(across);
    light.normal = area > 0.0f ? across * (1.0f / area) : vec3(0.0f, 1.0f, 0.0f);
    light.radius = radius;
    light.area = kind == kLightSphere ? 4.0f * kPi * radius * radius : area * (kind == kLightTriangle ? 0.5f : 1.0f);
    light.emission = vec3(1.0f);
    light.sides = kSidesBoth;
    light.selection = 1.0f;
    light.cdf = 1.0f;
    return light;
}

RT_FN bool isProbeProjected(uint family) {
    return family >= kProbeProjected && family < kProbeProjected + kProbeShapes;
}
RT_FN uint probeKind(uint family) {
    return family == kProbeEllipsoids ? kLightEllipsoid : family % kProbeShapes;
}

// Half axes x, y, z, the first turned towards z and sheared. `radius`: of a sphere that holds it.
RT_FN Light probeEllipsoid(vec3 center, float x, float y, float z, float radius) {
    Light light = probeLightOf(kLightEllipsoid, center, vec3(x, 0.0f, 0.5f * x), vec3(0.0f, y, 0.0f), radius);
    light.normal = vec3(-0.3f * z, 0.2f * z, z);
    return light;
}

// The light of a case, to be seen from the origin on a surface with the normal +y.
RT_FN Light probeCaseLight(uint family, uint which) {
    uint kind = probeKind(family);
    bool projected = isProbeProjected(family);
    if (kind == kLightEllipsoid) {
        if (which == 1u) return probeEllipsoid(vec3(-0.5f, 1.2f, 1.0f), 0.2f, -0.5f, 0.05f, 0.6f); // mirrored
        if (which == 2u) return probeEllipsoid(vec3(1.5f, 0.1f, -0.4f), 0.3f, 0.5f, 0.1f, 0.6f);   // cut by the horizon
        return probeEllipsoid(vec3(0.6f, 1.0f, -0.4f), which == 3u ? 2.0f : 0.4f, which == 3u ? 3.0f : 0.1f,
                              which == 3u ? 1.5f : 0.6f, which == 3u ? 4.0f : 0.8f);
    }
    if (kind == kLightSphere) {
        float high = projected ? (which == 0u ? 0.9f : (which == 1u ? 0.2f : -0.25f)) : 0.7f;
        float radius = !projected && which == 3u ? 2.0f : (which == 2u && !projected ? 0.9f : 0.5f);
        return probeLightOf(kind, vec3(0.6f, high, -0.4f), vec3(0.0f), vec3(0.0f),
                            which == 3u && projected ? 0.7f : radius);
    }
    if (which == 0u)
        return probeLightOf(kind, vec3(0.5f, 0.3f, -0.7f), vec3(0.0f, 0.3f, 1.2f), vec3(0.6f, 0.8f, -0.2f), 0.0f);
    if (which == 1u) // projected: the zenith is inside
        return probeLightOf(kind, vec3(-0.6f, 0.8f, -0.5f), vec3(1.5f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 1.6f), 0.0f);
    if (which == 2u) // cut by the horizon, no rectangle
        return probeLightOf(kind, vec3(0.5f, -0.4f, -0.7f), vec3(0.0f, 0.3f, 1.2f), vec3(0.4f, 1.2f, 0.3f), 0.0f);
    return probeLightOf(kind, vec3(0.2f, 1.0f, -2.0f), vec3(0.0f, 0.0f, 4.0f), vec3(0.15f, 0.0f, 0.0f), 0.0f); // thin
}

RT_FN uint probeShape(uint family, uint which) {
    if (isProbeProjected(family)) return kShapeProjected;
    if (which == 0u) return kShapeArea;
    bool automatic = which == 3u || (which == 1u && family == kLightQuad); // as a strip; weighted by the cosine
    return automatic ? kShapeAuto : kShapeSolidAngle;
}

// A light of any of twelve decades in size and distance: thin, edge-on, touched, or far from the origin.
RT_FN Light probeStressLight(RT_INOUT(Arguments) a, uint kind, RT_INOUT(vec3) position) {
    vec3 u = probeUnit(a);
    u *= probeDecades(a, -6.0f, 6.0f);
    vec3 v = probeUnit(a) * length(u);
    if ((a.key & 8u) != 0u) v *= probeDecades(a, -5.0f, 0.0f);
    vec3 across = cross(u, v);
    float side = sqrt(length(across));
    vec3 corner = probeUnit(a);
    corner *= probeDecades(a, -6.0f, 6.0f);
    if ((a.key & 48u) == 16u)
        corner = -0.3f * u - 0.4f * v + across * (probeDecades(a, -6.0f, 0.0f) / max(side, 1.0e-30f));
    if ((a.key & 48u) == 32u)
        corner = 2.0f * u - 0.3f * v + across * (probeDecades(a, -7.0f, -4.0f) / max(side, 1.0e-30f));
    position = (a.key & 64u) == 0u ? vec3(0.0f) : vec3(1.0e5f, -2.0e5f, 5.0e4f);
    Light light = probeLightOf(kind, position + corner, u, v, length(u));
    if (kind == kLightEllipsoid) { // v at right angles to u
        light.edgeV = cross(light.normal, u) * (length(v) / length(u));
        light.normal *= length(u) * probeDecades(a, -4.0f, 0.0f);
    }
    return light;
}

// A point on a light, the normal there, and the inverse of the point's density per area: uniform but for ellipsoids.
RT_FN vec3 probeLightPoint(RT_IN(Light) light, vec2 u, RT_INOUT(vec3) normal, RT_INOUT(float) area) {
    area = light.area;
    if (light.kind == kLightEllipsoid) {
        vec3 n = sampleSphere(u);
        vec3 across = cross(light.edgeV, light.normal) * n.x + cross(light.normal, light.edgeU) * n.y +
                      cross(light.edgeU, light.edgeV) * n.z; // outwards or, mirrored, inwards
        area = 4.0f * kPi * length(across);
        normal = normalize(across) * signOf(dot(light.edgeU, cross(light.edgeV, light.normal)));
        return light.position + light.edgeU * n.x + light.edgeV * n.y + light.normal * n.z;
    }
    if (light.kind == kLightSphere) {
        normal = sampleSphere(u);
        return light.position + normal * light.radius;
    }
    normal = light.normal;
    bool beyond = light.kind == kLightTriangle && u.x + u.y > 1.0f;
    vec2 w = beyond ? vec2(1.0f) - u : u;
    return light.position + light.edgeU * w.x + light.edgeV * w.y;
}

// Of a round light.
RT_FN bool isProbeInside(RT_IN(Light) light, vec3 position) {
    vec3 toCenter = light.position - position;
    if (light.kind == kLightEllipsoid) toCenter = toSphere(ellipsoidOf(light), toCenter);
    float radius = light.kind == kLightEllipsoid ? 1.0f : light.radius;
    return dot(toCenter, toCenter) <= radius * radius;
}

// kProbeDraws, kProbeStrata: direction and density. kProbeDensity: the density asked for again over that of the sample,
// 1 if there is none; and the density per area, times the area, at a point uniform in it. kProbeStress, bits: 0 not
// finite, 1 no positive density, 2 no unit vector, 3 an unusable density when asked again.
RT_FN uvec4 probeLight(uint family, uint which, uint mode, uint i) {
    Arguments a;
    a.key = i;
    a.next = ((family * kProbeCases + which) * kProbeModes + mode) << 8u;
    uint kind = probeKind(family);
    Features features = kind == kLightSphere ? kFeatureSphereLights
                                             : (kind == kLightQuad ? kFeatureQuadLights : kFeatureTriangleLights);
    if (kind == kLightEllipsoid) features = kFeatureEllipsoidLights;
    if (isProbeProjected(family)) features |= kMethodProjected;
    bool stress = mode == kProbeStress;
    Light light = probeCaseLight(family, which);
    vec3 position = vec3(0.0f);
    vec3 normal = vec3(0.0f, 1.0f, 0.0f);
    if (stress) {
        light = probeStressLight(a, kind, position);
        normal = (i & 128u) == 0u ? probeUnit(a) : vec3(0.0f);
    }
    RenderParams params = probeParams(probeShape(family, which));
    LightSample s = sampleLight(features, params, light, position, normal, 0.0f, probeSquare(a, mode, i));
    if (mode <= kProbeStrata) return floatWords(s.wi, s.pdf);
    vec3 onLight = vec3(0.0f);
    float area = 0.0f;
    vec3 v = probeLightPoint(light, uniformPair(a), onLight, area) - position;
    float again = 1.0f;
    float perArea = 0.0f;
    for (uint n = 0u; n < 2u; n++) { // one call for two densities: compilers copy the code into each
        float d = n == 0u ? s.distance : length(v);
        vec3 wi = n == 0u ? s.wi : v * (1.0f / max(d, 1.0e-30f));
        vec3 facing = n == 0u ? s.normal : onLight;
        float cosine = abs(dot(wi, facing));
        bool hidden = (dot(wi, facing) > 0.0f) != isProbeInside(light, position) &&
                      (light.kind == kLightSphere || light.kind == kLightEllipsoid);
        if (n == 0u ? s.pdf > 0.0f : (!stress && dot(wi, normal) > 0.0f && !hidden)) {
            float pdf = lightPdf(features, params, light, position, normal, 0.0f, wi, d, facing);
            if (n == 0u) {
                again = stress ? pdf : pdf / s.pdf;
            } else {
                perArea = pdf * cosine / (d * d) * area;
            }
        }
    }
    if (!stress) return floatWords(again, perArea, 0.0f, 0.0f);
    uint flags = isFinite(s.pdf) ? 0u : 1u;
    if (s.pdf < 0.0f) flags |= 2u;
    if (s.pdf > 0.0f) {
        if (!(isFinite(s.wi) && isFinite(s.point) && isFinite(s.distance))) flags |= 1u;
        if (!(abs(dot(s.wi, s.wi) - 1.0f) < 1.0e-4f)) flags |= 4u;
        if (!(isFinite(again) && again >= 0.0f)) flags |= 8u;
    }
    return uvec4(flags, 0u, 0u, 0u);
}

// ---- materials -----------------------------------------------------------------------------------------------------

RT_FN Bsdf probeCaseBsdf(uint which) {
    Bsdf m;
    m.kind = which == 0u ? kMaterialLambertian : kMaterialMetal;
    m.albedo = vec3(1.0f);
    m.parameter[kMetalFuzz] = which == 2u ? 0.1f : 0.6f;
    m.parameter[1] = 0.0f;
    m.lobes = noLobes();
    return m;
}

// Cases 0 to 3: diffuse, a medium, metal of little and of much fuzz. Axis of the cone that holds all directions of a
// case, and the cosine of its half angle; wo is 20 degrees off the normal.
const vec3 kProbeOutwards = vec3(0.34202014f, 0.93969262f, 0.0f);
RT_FN vec4 probeCone(uint which) {
    if (which == 0u) return vec4(0.0f, 1.0f, 0.0f, 0.0f);
    if (which == 1u) return vec4(0.0f, 1.0f, 0.0f, -1.0f);
    float fuzz = probeCaseBsdf(which).parameter[kMetalFuzz];
    return vec4(-kProbeOutwards.x, kProbeOutwards.y, 0.0f, sqrt((1.0f - fuzz) * (1.0f + fuzz)));
}

// As probeLight; kProbeDensity: a direction uniform in the cone takes the place of a point on the light.
RT_FN uvec4 probeScattering(uint which, uint mode, uint i) {
    Arguments a;
    a.key = i;
    a.next = ((kProbeScattering * kProbeCases + which) * kProbeModes + mode) << 8u;
    bool stress = mode == kProbeStress;
    Bsdf m = probeCaseBsdf(which);
    vec3 n = vec3(0.0f, 1.0f, 0.0f);
    vec3 wo = kProbeOutwards;
    if (stress) { // grazing directions and the smallest lobes
        n = probeUnit(a);
        wo = normalize(makeFrame(n).tangent + n * probeDecades(a, -7.0f, 3.0f));
        m.parameter[kMetalFuzz] = min(probeDecades(a, -7.0f, 0.1f), 1.0f);
    }
    vec2 u = probeSquare(a, mode, i);
    if (stress && (i & 7u) < 4u) u = vec2(float(i & 1u), float(i >> 1u & 1u)) * 0.99999994f;
    BsdfSample s = sampleBsdf(kFeatureAll, m, n, 1u, wo, u, uniformNumber(a));
    if (which == 1u) s = samplePhase(m.albedo, u);
    if (mode <= kProbeStrata) return floatWords(s.wi, s.pdf);
    vec4 cone = probeCone(which);
    vec2 w = uniformPair(a);
    float cosine = mix(1.0f, cone.w, w.x);
    vec2 sc = sinCos2Pi(w.y) * sqrt(max((1.0f - cosine) * (1.0f + cosine), 0.0f));
    vec3 wi = toWorld(makeFrame(vec3(cone)), vec3(sc.y, sc.x, cosine));
    float there = which == 1u ? kPhasePdf : evalBsdf(kFeatureAll, m, n, wo, wi).w;
    there *= 2.0f * kPi * (1.0f - cone.w);
    float again = which == 1u || !(s.pdf > 0.0f) ? s.pdf : evalBsdf(kFeatureAll, m, n, wo, s.wi).w;
    if (!stress) return floatWords(s.pdf > 0.0f ? again / s.pdf : 1.0f, there, 0.0f, 0.0f);
    uint flags = isFinite(s.pdf) && isFinite(there) && there >= 0.0f ? 0u : 1u;
    if (s.pdf < 0.0f) flags |= 2u;
    if (s.pdf > 0.0f && !(isFinite(s.wi) && abs(dot(s.wi, s.wi) - 1.0f) < 1.0e-4f)) flags |= 4u;
    if (!isDelta(kFeatureAll, m) && !(isFinite(again) && again >= 0.0f)) flags |= 8u;
    return uvec4(flags, 0u, 0u, 0u);
}

// ---- choice among lights -------------------------------------------------------------------------------------------

// The scene whose lights these are, which the includer provides.
RT_FN Light probeTableLight(uint i) {
    Arguments a;
    a.key = i;
    a.next = 1u;
    vec3 place = probeUnit(a);
    place *= 0.5f + 3.0f * uniformNumber(a);
    vec3 u = probeUnit(a) * 0.2f;
    vec3 v = probeUnit(a) * 0.3f;
    Light light = probeLightOf(kLightQuad, place, u, v, 0.0f);
    light.sides = i % 3u == 0u ? kSidesFront : kSidesBoth;
    light.selection = 2.0f * float(i + 1u) / float(kProbeLights * (kProbeLights + 1u));
    light.cdf = float((i + 1u) * (i + 2u)) / float(kProbeLights * (kProbeLights + 1u));
    return light;
}

RT_FN LightBound probeTableBound(uint i) {
    Light light = probeTableLight(i);
    LightBound bound;
    bound.center = light.position + 0.5f * (light.edgeU + light.edgeV);
    bound.radius = 0.5f * length(abs(light.edgeU) + abs(light.edgeV));
    bound.axis = light.normal;
    bound.twoSided = light.sides == kSidesBoth ? 1.0f : 0.0f;
    bound.omnidirectional = 0.0f;
    bound.intensity = light.area * float(1u + i % 4u);
    return bound;
}

RT_FN uint probePolicy(uint which) {
    return which == 1u ? kSelectPower : (which == 2u ? kSelectUniform : kSelectContribution);
}

RT_FN LightContext probeContext(uint which) {
    LightContext context;
    context.position = vec3(0.3f, -0.2f, 0.1f);
    context.normal = which == 3u ? vec3(0.0f) : vec3(0.0f, 1.0f, 0.0f);
    context.total = 0.0f;
    return context;
}

// kProbeDraws, kProbeStrata: the light, its probability and that asked for again. kProbeDensity: the sum of all lights'
// probabilities. kProbeStress, bits: 0 not finite, 1 no positive probability, 2 a number outside of [0,1).
RT_FN uvec4 probeChoice(SceneRef scene, uint which, uint mode, uint i) {
    Arguments a;
    a.key = i;
    a.next = ((kProbeChoice * kProbeCases + which) * kProbeModes + mode) << 8u;
    LightContext context = probeContext(which);
    vec2 u = uniformPair(a);
    uint cells = kProbeSide * kProbeSide;
    if (mode == kProbeStrata) u.x = min((float(i % cells) + u.x) / float(cells), 0.99999994f);
    if (mode == kProbeStress) {
        context.position = probeUnit(a);
        context.position *= probeDecades(a, -6.0f, 12.0f);
        if (which != 3u) context.normal = probeUnit(a);
        if ((i & 7u) < 2u) u.x = float(i & 1u) * 0.99999994f;
    }
    LightChoice c = chooseLight(kFeatureQuadLights, scene, probePolicy(which), kProbeLights, u, context);
    float sum = 0.0f;
    float again = 0.0f;
    for (uint k = 0u; k < kProbeLights; k++) {
        float p = lightProbability(kFeatureQuadLights, scene, probePolicy(which), kProbeLights, k, context);
        sum += p;
        again = k == c.light ? p : again;
    }
    if (mode <= kProbeStrata) return uvec4(c.light, floatBitsToUint(c.probability), floatBitsToUint(again), 0u);
    if (mode == kProbeDensity) return floatWords(c.probability > 0.0f ? again / c.probability : 1.0f, sum, 0.0f, 0.0f);
    uint flags = isFinite(c.probability) && isFinite(sum) ? 0u : 1u;
    if (c.light != kNone && !(c.probability > 0.0f && c.light < kProbeLights)) flags |= 2u;
    if (c.light != kNone && !(c.u >= 0.0f && c.u < 1.0f)) flags |= 4u;
    return uvec4(flags, 0u, 0u, 0u);
}

// `scene` has the lights of probeTableLight() and their bounds.
RT_FN uvec4 probeSampler(SceneRef scene, uint family, uint which, uint mode, uint i) {
    if (family == kProbeScattering) return probeScattering(which, mode, i);
    if (family == kProbeChoice) return probeChoice(scene, which, mode, i);
    return probeLight(family, which, mode, i);
}

RT_SHARED_END

#endif
