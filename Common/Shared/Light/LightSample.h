// What sampling a light gives, and the ways in which that happens.
#ifndef RT_SHARED_LIGHT_SAMPLE_H
#define RT_SHARED_LIGHT_SAMPLE_H
#include "Common/Shared/Base/Features.h"
#include "Common/Shared/Base/Sampling.h"
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

struct LightSample {
    vec3 wi;        // unit, from the shading point to the light
    float distance; // along wi; kInfinity: to the sky
    float pdf;      // per steradian, given this light; 0: the light cannot contribute, nothing else is defined
    vec3 radiance;  // emitted towards the shading point, without the emission's texture
    vec3 point;     // on the light
    vec3 error;     // bound of the rounding error of `point`, per axis
    vec3 normal;    // unit geometric normal at `point`, front side of a flat light, outward of a round one
    vec2 uv;        // quad: along edgeU and edgeV; triangle: weights of vertices 1 and 2
};

RT_FN LightSample noLightSample() {
    LightSample s;
    s.wi = vec3(0.0f);
    s.distance = 0.0f;
    s.pdf = 0.0f;
    s.radiance = vec3(0.0f);
    s.point = vec3(0.0f);
    s.error = vec3(0.0f);
    s.normal = vec3(0.0f);
    s.uv = vec2(0.0f);
    return s;
}

// Strategies by which a light's shape is sampled from a shading point.
const uint kStrategySolidAngle = 0u; // uniform in solid angle, or a quad: weighted by the cosines at its corners
const uint kStrategyArea = 1u;       // uniform in area
const uint kStrategyStrip = 2u;      // a thin quad as a line light: by solid angle along the long edge, uniform across
const uint kStrategyInside = 3u;     // the point is inside a sphere or an ellipsoid, which fills all directions
const uint kStrategyProjected = 4u;  // a sphere: uniform in projected solid angle; flat lights: isFlatProjected()
const uint kStrategyVisibleCap = 5u; // what of a sphere is above the horizon, nearly uniform in projected solid angle

// Below it a float direction cannot resolve a light; a point uniform in area can.
const float kTinySolidAngle = 1.0e-8f;

RT_FN bool isSurface(vec3 normal) {
    return dot(normal, normal) > 0.0f;
}

// Ratio of extent to distance below which directions are too coarse for projected samplers.
const float kTinyExtent = 1.0e-3f;

// Whether a shape that is to be sampled by `method` gets its projected sampler, if it is not too small for that.
RT_FN bool wantsProjected(Features features, uint method, vec3 normal) {
    return has(features, kMethodProjected) && method == kShapeProjected && isSurface(normal);
}

// Uniform over all directions for a point in a medium, by the cosine for a point on a surface.
RT_FN vec4 sampleInside(vec3 normal, vec2 u) {
    if (!isSurface(normal)) return vec4(sampleSphere(u), 0.25f * kInvPi);
    vec3 local = sampleCosineHemisphere(u);
    return vec4(toWorld(makeFrame(normal), local), local.z * kInvPi);
}

RT_SHARED_END

#endif
