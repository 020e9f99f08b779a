// Connections: light that reaches a vertex which scatters widely by way of a smooth sphere: reflected on the outside,
// refracted where it enters and where it leaves, or also reflected once in between. A sphere, a way and a light are
// chosen (ConnectionChoice.h), a point on the light sampled as the sphere's centre sees it, and one of the paths drawn
// that lead there (SphereRefraction.h): two to four segments, which have to be free. They are weighed against
// scattering, which finds the same paths (ConnectionChain.h). What connections do not cover counts in full where
// scattering finds it: other orders of surfaces, lights around the sphere, and vertices that no light is thought to
// reach.
#ifndef RT_SHARED_CONNECTION_H
#define RT_SHARED_CONNECTION_H
#include "Common/Shared/Light/SkyPatches.h"
#include "Common/Shared/Light/SphereRefraction.h"
#include "Common/Shared/Material/Dielectric.h"
#include "Common/Shared/Path/DirectLight.h"
#include "Common/Shared/Technique/SpecularConnection/ConnectionChoice.h"

RT_SHARED_BEGIN

RT_FN SpecularConnection noConnection() {
    SpecularConnection p;
    p.radiance = vec3(0.0f);
    p.begin = vec3(0.0f);
    p.entry[0] = vec3(0.0f);
    p.entry[1] = vec3(0.0f);
    p.bounce = vec3(0.0f);
    p.leave[0] = vec3(0.0f);
    p.leave[1] = vec3(0.0f);
    p.end = vec3(0.0f);
    p.segments = 0u;
    return p;
}

// ---- the light's end -----------------------------------------------------------------------------------------------

// A point on a light, as a connection ends there.
struct LightEnd {
    vec3 point;
    vec3 error;
    vec3 normal;
    vec3 radiance;
    float density;  // of the point, over area, that a vertex connects to it through this sphere; 0: there is none
    float twoSided; // 1: it emits to both sides
};

// Density over area of a point of a light, of which the sphere's centre sees the density `pdf` over solid angle in the
// direction wi. 0 where connections do not cover it: from behind, or from within a round light.
RT_FN float endDensity(RT_IN(Light) light, vec3 center, vec3 wi, float distance, vec3 normal, float pdf) {
    bool isRound = light.kind == kLightSphere || light.kind == kLightEllipsoid;
    float cosine = dot(normal, wi);
    bool isSeen = isRound ? cosine < 0.0f : isLit(light, center);
    return isSeen ? pdf * abs(cosine) / square(distance) : 0.0f;
}

// Connections end in the sky at a distance from the sphere's centre from which all of the sphere is one point to the
// rounding of a direction, and beyond everything else in the scene. `radius` is the sphere's.
RT_FN float skyDistance(SceneRef scene, float radius) {
    return max(radius / kEpsilon, 8.0f * loadGlobals(scene).sceneRadius);
}

// As endDensity(), of a point of the sky.
RT_FN float skyEndDensity(float distance, float pdf) {
    return pdf / square(distance);
}

// `rate` as in SpecularChain.
RT_FN LightEnd sampleSkyEnd(SceneRef scene, RT_IN(ConnectionChoice) choice, vec3 center, float rate, vec2 u) {
    LightSample s = sampleSkyPatch(scene, loadSkyPatch(scene, choice.skyPatch), u);
    float distance = skyDistance(scene, loadSpecularCaster(scene, choice.sphere).radius);
    LightEnd end;
    end.point = center + s.wi * distance;
    end.error = vec3(0.0f);
    end.normal = s.normal;
    end.radiance = s.radiance;
    end.density = rate * choice.weight * skyEndDensity(distance, s.pdf);
    end.twoSided = 0.0f;
    return end;
}

RT_FN LightEnd sampleEnd(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(ConnectionChoice) choice,
                         vec3 center, float time, float rate, vec2 u) {
    if (has(features, kFeatureSkyImage) && choice.skyPatch != kNone) {
        return sampleSkyEnd(scene, choice, center, rate, u);
    }
    RT_IN(Light) light = loadLight(scene, choice.light);
    LightSample s = sampleLight(features, params, light, center, vec3(0.0f), time, u);
    applyMaterial(features, scene, light, s);
    LightEnd end;
    end.point = s.point;
    end.error = s.error;
    end.normal = s.normal;
    end.radiance = s.radiance;
    end.density = 0.0f;
    if (s.pdf > 0.0f) {
        end.density = rate * choice.weight * endDensity(light, center, s.wi, s.distance, s.normal, s.pdf);
    }
    bool isRound = light.kind == kLightSphere || light.kind == kLightEllipsoid;
    end.twoSided = !isRound && light.sides == kSidesBoth ? 1.0f : 0.0f;
    return end;
}

// ---- paths between the two ends ------------------------------------------------------------------------------------

struct ConnectionPair {
    RefractionPair angles;
    vec3 along; // unit, from the vertex to the centre
    vec3 aside; // unit, across it, towards the light's end; away from it where the light goes back
    vec3 axis;  // across both, as long as the sine of the angle between them
};

// Where light goes back to the side that it comes from, the sides are changed, and the angle to turn by is the
// supplement; see SphereRefraction.h.
RT_FN ConnectionPair connectionPair(RT_IN(SpecularCaster) sphere, RT_IN(SphereView) view, vec3 y) {
    ConnectionPair c;
    vec3 toY = y - view.center;
    float inverse = 1.0f / sqrt(max(dot(toY, toY), 1.0e-30f));
    vec3 w = toY * inverse;
    c.along = view.along;
    c.axis = cross(view.along, w);
    float sine = sqrt(dot(c.axis, c.axis));
    float side = sideAfter(sphere.crossings);
    c.aside = cross(c.axis, view.along) * (side / max(sine, 1.0e-12f));
    c.angles.inverseEta = sphere.inverseEta;
    c.angles.crossings = sphere.crossings;
    c.angles.nearX = view.near;
    c.angles.nearY = sphere.radius * inverse;
    float cosine = dot(view.along, w);
    c.angles.bend = vec2(side * cosine, sine);
    return c;
}

// Sum of the radius over both ends' distances, beyond which what is reflected inside might turn by more than half a
// circle where the index is the compiler's kMinIorInside.
const float kNearestInside = 1.8f;

// Whether both ends lie outside the sphere.
RT_FN bool isConnectable(RT_IN(ConnectionPair) c) {
    float together = c.angles.crossings == kReflectedInside ? kNearestInside : 2.0f;
    return c.angles.nearX < kNearestToSphere && c.angles.nearY < kNearestToSphere &&
           c.angles.nearX + c.angles.nearY < together;
}

// One path between the ends.
struct SpherePath {
    vec3 atX;       // unit direction at the vertex
    vec3 entry;     // unit normals, outward, where it meets the sphere: on the vertex's side,
    vec3 bounce;    // where it is reflected inside,
    vec3 leave;     // and on the light's
    float fraction; // of light that goes this way
    float spread;   // solid angle at the vertex over area of the light
    float share;    // of the choice among the paths
};

// Of the light that meets the sphere, what goes this way.
RT_FN float lightFraction(RT_IN(RefractionPair) p, RT_IN(Refraction) r) {
    return fractionAfter(p.crossings, fresnel(max(r.incident.x, 1.0e-12f), p.inverseEta).x);
}

// Solid angle at the vertex over area at the light, whose normal makes an angle of this cosine with the path.
RT_FN float pathSpread(RT_IN(RefractionPair) p, RT_IN(Refraction) r, float radius, float cosine) {
    Refraction at = r;
    at.turn.y = p.bend.y;
    return refractionDensity(p, at) * cosine / square(radius);
}

// The path of this kind that is refracted at this angle; its share is 0 where there is none. Without a branch, for
// loops over lanes.
RT_FN SpherePath pathAt(RT_IN(ConnectionPair) c, uint kind, bool exists, vec2 angle, float radius, vec3 center,
                        RT_IN(LightEnd) end, vec3 normal) {
    Refraction r = refractionAt(c.angles, angle);
    RefractedPlaces places = refractedPlaces(r, c.angles.crossings, kind, c.along, c.aside);
    SpherePath path;
    path.atX = places.atX;
    path.entry = places.entry;
    path.bounce = places.bounce;
    path.leave = places.leave;
    vec3 toEnd = end.point - (center + path.leave * radius);
    vec3 wy = toEnd * (1.0f / sqrt(max(dot(toEnd, toEnd), 1.0e-30f)));
    float facing = -dot(end.normal, wy);
    facing = max(facing, -facing * end.twoSided);
    path.fraction = lightFraction(c.angles, r);
    path.spread = pathSpread(c.angles, r, radius, facing);
    // The irradiance that it brings, weighed against scattering by the cosine.
    float receiver = isSurface(normal) ? max(dot(normal, path.atX), 0.0f) : 1.0f;
    float scattering = kInvPi * receiver * path.fraction * path.spread / end.density;
    float share = receiver * path.fraction * path.spread / (1.0f + square(scattering));
    bool isOutside = dot(wy, path.leave) > 0.0f && dot(places.atX, places.entry) < 0.0f;
    bool isValid = exists && isConnectable(c) && isOutside && end.density > 0.0f && share > 0.0f && share < kInfinity;
    path.share = isValid ? share : 0.0f;
    return path;
}

// One of three paths by their shares, of which one is above 0; its share becomes the probability of the choice.
RT_FN SpherePath pickPath(RT_IN(SpherePath) a, RT_IN(SpherePath) b, RT_IN(SpherePath) c, float u) {
    float sum = a.share + b.share + c.share;
    float target = u * sum;
    SpherePath path = a;
    if (target >= a.share) path = b;
    if (target >= a.share + b.share || !(path.share > 0.0f)) path = c.share > 0.0f ? c : path;
    if (!(path.share > 0.0f)) path = a.share > 0.0f ? a : b;
    path.share = path.share / max(sum, 1.0e-37f);
    return path;
}

// Points on the surface are moved off it by this fraction of the radius, which is more than the angle of a path is
// known to.
const float kConnectionMargin = 5.0e-5f;

// A path weighed against scattering at v, which the path before reached with this throughput.
RT_FN SpecularConnection weighConnection(Features features, RT_IN(RenderParams) params, RT_IN(SpecularCaster) sphere,
                                         vec3 center, RT_IN(SpherePath) path, RT_IN(LightEnd) end, RT_IN(Vertex) v,
                                         vec3 throughput) {
    SpecularConnection p = noConnection();
    if (!(path.share > 0.0f)) return p;
    vec4 f = evalScattering(features, v, path.atX);
    float connecting = end.density / path.spread;
    float scattering = f.w * path.fraction;
    if (params.lightSampling != kSampleMisBalance) scattering *= scattering / connecting;
    vec3 light = sphere.tint * end.radiance * (path.fraction / (path.share * (connecting + scattering)));
    p.radiance = throughput * vec3(f) * light;
    float strongest = maxComponent(p.radiance);
    if (!(strongest > 0.0f && strongest < kInfinity)) return p;
    vec3 error = vec3(32.0f * kEpsilon * (maxComponent(abs(center)) + sphere.radius) +
                      kConnectionMargin * sphere.radius + sphere.error);
    vec3 entry = center + path.entry * sphere.radius;
    vec3 bounce = center + path.bounce * sphere.radius;
    vec3 leave = center + path.leave * sphere.radius;
    p.begin = v.origin;
    p.entry[0] = offsetOrigin(entry, error, path.entry, path.entry);
    p.entry[1] = offsetOrigin(entry, error, path.entry, -path.entry);
    p.bounce = offsetOrigin(bounce, error, path.bounce, -path.bounce);
    p.leave[0] = offsetOrigin(leave, error, path.leave, -path.leave);
    p.leave[1] = offsetOrigin(leave, error, path.leave, path.leave);
    p.end = offsetOrigin(end.point, end.error, end.normal, leave - end.point);
    p.segments = kSegmentBeyond | kSegmentBefore;
    if (sphere.crossings != kReflectedOutside) p.segments |= kSegmentInside;
    if (sphere.crossings == kReflectedInside) p.segments |= kSegmentAgain;
    return p;
}

// The sample that places the point on the light. Whether there is one, which light, and which path is decided by the
// number that the mixture of lights and bsdf, which makes no connections, has for the same.
RT_FN vec2 connectionSample(RT_IN(Sampler) smp, RT_IN(Vertex) v) {
    return sample2D(smp, vertexDimension(v.index, kDimensionConnection));
}

// A connection from v, where a light has been chosen for next-event estimation.
RT_FN SpecularConnection connectLight(Features features, SceneRef scene, RT_IN(RenderParams) params, RT_IN(Sampler) smp,
                                      RT_IN(Vertex) v, RT_IN(VertexSamples) u, RT_INOUT(PathState) s) {
    s.chain.rate = 0.0f;
    if (params.connectedSpheres == 0u || !connects(features, v)) return noConnection();
    float total = totalWeight(scene, params, v.origin, s.ray.time);
    if (!(total > 0.0f)) return noConnection();
    float typical = loadGlobals(scene).maxCasterIrradiance;
    float chance = connectionChance(total, s.last.total, typical, s.throughput * v.bsdf.albedo);
    s.chain.rate = chance / total;
    if (!(u.roulette.y < chance)) return noConnection();
    float target = u.roulette.y / chance * total;
    ConnectionChoice choice = chooseConnection(scene, params, v.origin, s.ray.time, target);
    if (!(choice.weight > 0.0f)) return noConnection();
    RT_IN(SpecularCaster) sphere = loadSpecularCaster(scene, choice.sphere);
    if (!isInTime(params, sphere, v)) return noConnection();
    SphereView view = viewSphere(sphere, v.origin, s.ray.time);
    LightEnd end =
        sampleEnd(features, scene, params, choice, view.center, s.ray.time, s.chain.rate, connectionSample(smp, v));
    if (!(end.density > 0.0f)) return noConnection();
    ConnectionPair c = connectionPair(sphere, view, end.point);
    RefractionRoots roots = refractionRoots(c.angles, minTurn(c.angles));
    SpherePath paths[kRefractedPaths];
    for (uint kind = 0u; kind < kRefractedPaths; kind++) {
        vec2 angle = firstAngle(kind);
        for (uint k = 0u; k < kRootSteps; k++) angle = nextAngle(c.angles, kind, angle);
        paths[kind] = pathAt(c, kind, hasPath(roots, kind), angle, sphere.radius, view.center, end, v.shading);
    }
    SpherePath path = pickPath(paths[0], paths[1], paths[2], choice.u);
    return weighConnection(features, params, sphere, view.center, path, end, v, s.throughput);
}

// ---- segments ------------------------------------------------------------------------------------------------------

// The next segment of the connection that has to be free, up to tMax.
RT_FN Ray connectionRay(RT_IN(SpecularConnection) p, float time, RT_OUT(float) tMax) {
    bool isBeyond = (p.segments & kSegmentBeyond) != 0u;
    bool isBefore = (p.segments & kSegmentBefore) != 0u;
    bool isInside = (p.segments & kSegmentInside) != 0u;
    bool isBounced = (p.segments & kSegmentAgain) != 0u;
    vec3 from = isBeyond ? p.leave[1] : isBefore ? p.begin : isInside ? p.entry[1] : p.bounce;
    vec3 to = isBeyond ? p.end : isBefore ? p.entry[0] : isInside && isBounced ? p.bounce : p.leave[0];
    vec3 segment = to - from;
    float segmentLength = length(segment);
    Ray ray;
    ray.origin = from;
    ray.direction = segment / segmentLength;
    ray.time = time;
    tMax = segmentLength * (1.0f - kShadowMargin);
    return ray;
}

// What becomes of the connection when its next segment has been traced; the last one adds to `radiance`.
RT_FN void endSegment(Features features, SceneRef scene, bool isFree, RT_IN(Ray) ray, float tMax,
                      RT_INOUT(SpecularConnection) p, RT_INOUT(vec3) radiance) {
    if (!isFree) {
        p.segments = 0u;
        return;
    }
    p.radiance *= rayTransmittance(features, scene, ray, tMax);
    p.segments &= p.segments - 1u;
    if (p.segments == 0u) radiance += p.radiance;
}

RT_SHARED_END

#endif
