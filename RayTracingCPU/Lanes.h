// Records of sixteen paths, field by field: a path a lane. Loops over lanes that call what is in Common/Shared become vectors of
// lanes, if nothing in there has a branch that a compiler could not turn into a mask. (Copied as a whole, a record would be read
// in pieces larger than those in which it was written, and processors wait for that.) Included by one translation unit per
// instruction set; everything here has internal linkage.
#pragma once
#include "RayTracingCPU/SceneAccess.h"

#include "Common/Shared/Path/PathStep.h"

RT_SHARED_BEGIN

const uint kLanes = 16u;

struct alignas(64) FloatLanes {
    float at[kLanes];
};

struct alignas(64) UintLanes {
    uint at[kLanes];
};

struct Vec2Lanes {
    FloatLanes x, y;
};

struct Vec3Lanes {
    FloatLanes x, y, z;
};

RT_FN vec2 get(const Vec2Lanes& lanes, uint i) {
    return vec2(lanes.x.at[i], lanes.y.at[i]);
}
RT_FN vec3 get(const Vec3Lanes& lanes, uint i) {
    return vec3(lanes.x.at[i], lanes.y.at[i], lanes.z.at[i]);
}
RT_FN void set(Vec2Lanes& lanes, uint i, vec2 v) {
    lanes.x.at[i] = v.x;
    lanes.y.at[i] = v.y;
}
RT_FN void set(Vec3Lanes& lanes, uint i, vec3 v) {
    lanes.x.at[i] = v.x;
    lanes.y.at[i] = v.y;
    lanes.z.at[i] = v.z;
}

struct HitLanes {
    FloatLanes t, u, v;
    UintLanes kind, primitive, instance;
};

RT_FN void set(HitLanes& lanes, uint i, const Hit& hit) {
    lanes.t.at[i] = hit.t;
    lanes.kind.at[i] = hit.kind;
    lanes.primitive.at[i] = hit.primitive;
    lanes.instance.at[i] = hit.instance;
    lanes.u.at[i] = hit.u;
    lanes.v.at[i] = hit.v;
}

RT_FN Hit get(const HitLanes& lanes, uint i) {
    Hit hit;
    hit.t = lanes.t.at[i];
    hit.kind = lanes.kind.at[i];
    hit.primitive = lanes.primitive.at[i];
    hit.instance = lanes.instance.at[i];
    hit.u = lanes.u.at[i];
    hit.v = lanes.v.at[i];
    return hit;
}

// Of the material what scattering depends on.
struct VertexLanes {
    UintLanes index, inMedium, front, kind;
    FloatLanes parameter[kMaterialParameters];
    Vec3Lanes normal, shading, wo, albedo, position, error, origin;
    Vec2Lanes light, bsdf, choice, select; // the numbers, which set() leaves alone
};

RT_FN void set(VertexLanes& lanes, uint i, const Vertex& v) {
    lanes.index.at[i] = v.index;
    lanes.inMedium.at[i] = v.inMedium;
    lanes.front.at[i] = v.front;
    lanes.kind.at[i] = v.material.kind;
    for (uint k = 0u; k < kMaterialParameters; ++k) lanes.parameter[k].at[i] = v.material.parameter[k];
    set(lanes.normal, i, v.normal);
    set(lanes.shading, i, v.shading);
    set(lanes.wo, i, v.wo);
    set(lanes.albedo, i, v.albedo);
    set(lanes.position, i, v.position);
    set(lanes.error, i, v.error);
    set(lanes.origin, i, v.origin);
}

RT_FN void setNumbers(VertexLanes& lanes, uint i, const VertexNumbers& numbers) {
    set(lanes.light, i, numbers.light);
    set(lanes.bsdf, i, numbers.bsdf);
    set(lanes.choice, i, numbers.choice);
    set(lanes.select, i, numbers.select);
}

RT_FN Vertex get(const VertexLanes& lanes, uint i) {
    Vertex v;
    v.index = lanes.index.at[i];
    v.inMedium = lanes.inMedium.at[i];
    v.front = lanes.front.at[i];
    v.material = blackMaterial();
    v.material.kind = lanes.kind.at[i];
    for (uint k = 0u; k < kMaterialParameters; ++k) v.material.parameter[k] = lanes.parameter[k].at[i];
    v.normal = get(lanes.normal, i);
    v.shading = get(lanes.shading, i);
    v.wo = get(lanes.wo, i);
    v.albedo = get(lanes.albedo, i);
    v.position = get(lanes.position, i);
    v.error = get(lanes.error, i);
    v.origin = get(lanes.origin, i);
    v.numbers.light = get(lanes.light, i);
    v.numbers.bsdf = get(lanes.bsdf, i);
    v.numbers.choice = get(lanes.choice, i);
    v.numbers.select = get(lanes.select, i);
    return v;
}

struct ChoiceLanes {
    UintLanes light;
    FloatLanes probability, u;
    FloatLanes total; // of LightContext
};

RT_FN void set(ChoiceLanes& lanes, uint i, const LightChoice& choice, float total) {
    lanes.light.at[i] = choice.light;
    lanes.probability.at[i] = choice.probability;
    lanes.u.at[i] = choice.u;
    lanes.total.at[i] = total;
}

// Quads and spheres, without what only textures need.
struct LightLanes {
    UintLanes kind, sides;
    Vec3Lanes position, edgeU, edgeV, normal, emission;
    FloatLanes radius, area;
};

RT_FN void set(LightLanes& lanes, uint i, const Light& light) {
    lanes.kind.at[i] = light.kind;
    set(lanes.position, i, light.position);
    set(lanes.edgeU, i, light.edgeU);
    set(lanes.edgeV, i, light.edgeV);
    set(lanes.normal, i, light.normal);
    lanes.radius.at[i] = light.radius;
    lanes.area.at[i] = light.area;
    set(lanes.emission, i, light.emission);
    lanes.sides.at[i] = light.sides;
}

// As one of `kind`, which it may not be.
RT_FN Light getAs(uint kind, const LightLanes& lanes, uint i) {
    Light light{};
    light.kind = kind;
    light.position = get(lanes.position, i);
    light.edgeU = get(lanes.edgeU, i);
    light.edgeV = get(lanes.edgeV, i);
    light.normal = get(lanes.normal, i);
    light.radius = lanes.radius.at[i];
    light.area = lanes.area.at[i];
    light.emission = get(lanes.emission, i);
    light.sides = lanes.sides.at[i];
    return light;
}

struct LightSampleLanes {
    Vec3Lanes wi, radiance, point, error, normal;
    Vec2Lanes uv;
    FloatLanes distance, pdf;
};

RT_FN void set(LightSampleLanes& lanes, uint i, const LightSample& s) {
    set(lanes.wi, i, s.wi);
    lanes.distance.at[i] = s.distance;
    lanes.pdf.at[i] = s.pdf;
    set(lanes.radiance, i, s.radiance);
    set(lanes.point, i, s.point);
    set(lanes.error, i, s.error);
    set(lanes.normal, i, s.normal);
    set(lanes.uv, i, s.uv);
}

RT_FN LightSample get(const LightSampleLanes& lanes, uint i) {
    LightSample s;
    s.wi = get(lanes.wi, i);
    s.distance = lanes.distance.at[i];
    s.pdf = lanes.pdf.at[i];
    s.radiance = get(lanes.radiance, i);
    s.point = get(lanes.point, i);
    s.error = get(lanes.error, i);
    s.normal = get(lanes.normal, i);
    s.uv = get(lanes.uv, i);
    return s;
}

struct DirectLightLanes {
    Vec3Lanes radiance, direction;
    FloatLanes distance;
};

RT_FN void set(DirectLightLanes& lanes, uint i, const DirectLight& direct) {
    set(lanes.radiance, i, direct.radiance);
    set(lanes.direction, i, direct.direction);
    lanes.distance.at[i] = direct.distance;
}

RT_FN DirectLight get(const DirectLightLanes& lanes, uint i) {
    DirectLight direct;
    direct.radiance = get(lanes.radiance, i);
    direct.direction = get(lanes.direction, i);
    direct.distance = lanes.distance.at[i];
    return direct;
}

// What the paths hold between the stages of a turn. One record, so that compilers see that its parts do not overlap. Lanes that
// are not in use are computed like the others, from whatever they hold.
struct PathLanes {
    HitLanes hits; // of the paths' rays
    VertexLanes vertices;
    Vec3Lanes throughput;
    FloatLanes time;
    ChoiceLanes choices;
    LightLanes lights; // that were chosen
    LightSampleLanes samples;
    UintLanes sampled; // 1: the sample is there
    DirectLightLanes direct;
    Vec3Lanes diffuse; // directions of sampleLambertian(), and their densities
    FloatLanes diffusePdf;
};

RT_SHARED_END
