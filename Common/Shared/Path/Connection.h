#ifndef RT_SHARED_CONNECTION_H
#define RT_SHARED_CONNECTION_H
#include "Common/Shared/Light/SphereRefraction.h"
#include "Common/Shared/Path/DirectLight.h"
#include "Common/Shared/Material/Dielectric.h"

namespace rt::shared { struct SmoothSphere { vec3 center; float radius; vec3 motion; float ior; vec3 tint; }; }
extern int gAimCount; extern float gTau, gPre;
extern rt::shared::SmoothSphere gAim[8];
namespace rt::shared { struct Reach { vec3 axis; float power; vec2 half; }; }
extern rt::shared::Reach gReach[8][32]; extern rt::shared::vec2 gMost[8][16];

RT_SHARED_BEGIN

// What a connection from x through a sphere to the point y of a light depends on.
struct ConnectionPair {
    RefractionPair angles;
    vec3 along;  // unit, from x to the centre
    vec3 aside;  // unit, across it, towards y
};

RT_FN ConnectionPair connectionPair(RT_IN(SmoothSphere) sphere, vec3 center, vec3 x, vec3 y) {
    ConnectionPair c;
    vec3 toCenter = center - x;
    vec3 toY = y - center;
    float inverseX = 1.0f / sqrt(dot(toCenter, toCenter));
    float inverseY = 1.0f / sqrt(max(dot(toY, toY), 1.0e-30f));
    c.along = toCenter * inverseX;
    vec3 w = toY * inverseY;
    vec3 axis = cross(c.along, w);
    float sine = sqrt(dot(axis, axis));
    c.angles.inverseEta = 1.0f / sphere.ior;
    c.angles.nearX = sphere.radius * inverseX;
    c.angles.nearY = sphere.radius * inverseY;
    c.angles.bend = vec2(dot(c.along, w), sine);
    c.aside = cross(axis, c.along) * (1.0f / max(sine, 1.0e-12f));
    return c;
}

const float kNearestToSphere = 0.999f; // R over the distance of x and of y

RT_FN bool isConnectable(RT_IN(RefractionPair) p) {
    return p.nearX < kNearestToSphere && p.nearY < kNearestToSphere;
}

RT_FN float transmittedTwice(RT_IN(RefractionPair) p, RT_IN(Refraction) r) {
    return square(1.0f - fresnel(r.incident.x, p.inverseEta).x);
}

// Whether light may go from light `l` through the sphere to x: along = unit direction from x to the centre.
RT_FN bool mayReach(RT_IN(Reach) reach, vec3 along, vec2 most) {
    return dot(reach.axis, along) > most.x * reach.half.x - most.y * reach.half.y;
}

// Weight of connections against scattering, both as densities of solid angle at x.
RT_FN float connectionWeight(float connecting, float scattering) {
    return powerHeuristic(connecting, scattering);
}

// Density of area at y of the light's points, times the choice of light and sphere.
RT_FN float connectionLightDensity(uint features, SceneRef scene, RT_IN(RenderParams) params, uint light, vec3 center, float time, vec3 y, vec3 normal, float probability) {
    vec3 v = y - center;
    float d2 = dot(v, v);
    vec3 wi = v * (1.0f / sqrt(d2));
    float pdf = lightPdf(features, params, loadLight(scene, light), center, vec3(0.0f), time, wi, sqrt(d2), normal);
    return probability * pdf * abs(dot(normal, wi)) / d2 / float(gAimCount);
}

// Emission that a path hit which was refracted by one sphere after it had scattered at `from` with density `pdf`.
RT_FN float refractedEmissionWeight(uint features, SceneRef scene, RT_IN(RenderParams) params, vec3 from, float pdf, uint light, RT_IN(Ray) ray, vec3 y, vec3 normal) {
    for (int i = 0; i < gAimCount; i++) {
        SmoothSphere sphere = gAim[i];
        vec3 center = sphere.center + sphere.motion * ray.time;
        vec3 o = ray.origin - center;
        float d = sqrt(dot(o, o));
        if (abs(d - sphere.radius) > 1.0e-3f * sphere.radius) continue;
        ConnectionPair c = connectionPair(sphere, center, from, y);
        if (!isConnectable(c.angles)) return 1.0f;
        float total = 0.0f, share = 0.0f;
        vec2 most = gMost[i][min(uint(c.angles.nearX * 16.0f), 15u)];
        for (uint l = 0u; l < loadGlobals(scene).lightCount; l++) {
            float w = mayReach(gReach[i][l], c.along, most) ? gReach[i][l].power : 0.0f;
            total += w; if (l == light) share = w;
        }
        if (!(share > 0.0f)) return 1.0f;
        share /= total;
        RefractionRoots n = refractionRoots(c.angles, leastTurn(c.angles));
        if (n.count == 0u) return 1.0f;
        vec3 b = cross(o, ray.direction);
        Refraction r = refractionAt(c.angles, angleOfSine(min(sqrt(dot(b, b)) / sphere.radius, 1.0f)));
        r.turn.y = c.angles.bend.y;
        float density = refractionDensity(c.angles, r) / square(sphere.radius) * abs(dot(normal, ray.direction));
        float connecting = connectionLightDensity(features, scene, params, light, center, ray.time, y, normal, share) * gPre / max(density, 1e-30f);
        return 1.0f - connectionWeight(connecting, pdf * transmittedTwice(c.angles, r));
    }
    return 1.0f;
}

RT_SHARED_END

#endif
