// What sixteen paths hold between the stages of an iteration. Included by one translation unit per instruction set;
// everything here has internal linkage.
#pragma once
#include "Common/Accel/Simd/LowestBit.h"
#include "Common/Shared/Path/PathStep.h"
#include "RayTracingCPU/Lanes.h"
#include "RayTracingCPU/SceneAccess.h"

RT_SHARED_BEGIN

template <>
struct FieldsOf<Ray> : Fields<FieldList<&Ray::origin, &Ray::direction, &Ray::time>> {};

template <>
struct FieldsOf<Sampler> : Fields<FieldList<&Sampler::kind, &Sampler::key, &Sampler::index, &Sampler::base,
                                            &Sampler::strataX, &Sampler::strataY>> {};

template <>
struct FieldsOf<CameraSamples> : Fields<FieldList<&CameraSamples::pixel, &CameraSamples::lens, &CameraSamples::time>> {
};

template <>
struct FieldsOf<VertexSamples>
    : Fields<
          FieldList<&VertexSamples::light, &VertexSamples::bsdf, &VertexSamples::roulette, &VertexSamples::selection>> {
};

template <>
struct FieldsOf<Hit> : Fields<FieldList<&Hit::t, &Hit::kind, &Hit::primitive, &Hit::instance, &Hit::u, &Hit::v>> {};

template <>
struct FieldsOf<RareLobes>
    : Fields<
          FieldList<&RareLobes::stretch, &RareLobes::stretchedAlpha, &RareLobes::filmScale, &RareLobes::filmOffset>> {};

template <>
struct FieldsOf<RareValues>
    : Fields<FieldList<&RareValues::anisotropy, &RareValues::stretch, &RareValues::film, &RareValues::filmThickness,
                       &RareValues::filmIor, &RareValues::beyond, &RareValues::beyondColor, &RareValues::isBeyond>> {};

// Omitted: what only kernels with kFeatureCoatNormal or kRareFeatures keep, in PathLanes::coatNormals and rareLobes.
template <>
struct FieldsOf<PrincipledLobes>
    : Fields<FieldList<&PrincipledLobes::others, &PrincipledLobes::diffuse, &PrincipledLobes::f0, &PrincipledLobes::f90,
                       &PrincipledLobes::sheen, &PrincipledLobes::sheenExponent, &PrincipledLobes::alpha,
                       &PrincipledLobes::glass, &PrincipledLobes::eta, &PrincipledLobes::thin, &PrincipledLobes::coat,
                       &PrincipledLobes::coatAlpha, &PrincipledLobes::diffuseShare, &PrincipledLobes::specularShare,
                       &PrincipledLobes::coatShare, &PrincipledLobes::glassShare>,
             FieldList<&PrincipledLobes::coatNormal, &PrincipledLobes::rare>> {};

// Omitted: as above, in PathLanes::rareValues.
template <>
struct FieldsOf<PrincipledValues>
    : Fields<FieldList<&PrincipledValues::others, &PrincipledValues::metallic, &PrincipledValues::roughness,
                       &PrincipledValues::specular, &PrincipledValues::transmission, &PrincipledValues::clearcoat,
                       &PrincipledValues::clearcoatRoughness, &PrincipledValues::sheenRoughness,
                       &PrincipledValues::specularColor, &PrincipledValues::sheenColor, &PrincipledValues::ior,
                       &PrincipledValues::thin, &PrincipledValues::glass>,
             FieldList<&PrincipledValues::rare>> {};

// Omitted: what only kernels with principled materials keep, in PathLanes::lobes; of Vertex in PathLanes::values.
template <>
struct FieldsOf<Bsdf> : Fields<FieldList<&Bsdf::kind, &Bsdf::albedo, &Bsdf::parameter>, FieldList<&Bsdf::lobes>> {};

template <>
struct FieldsOf<Vertex>
    : Fields<FieldList<&Vertex::index, &Vertex::inMedium, &Vertex::front, &Vertex::bsdf, &Vertex::normal,
                       &Vertex::shading, &Vertex::wo, &Vertex::position, &Vertex::error, &Vertex::origin>,
             FieldList<&Vertex::values>> {};

template <>
struct FieldsOf<LightChoice> : Fields<FieldList<&LightChoice::light, &LightChoice::probability, &LightChoice::u>> {};

// Omitted: what the choice of a light reads, and the texture of its emission.
template <>
struct FieldsOf<Light> : Fields<FieldList<&Light::kind, &Light::position, &Light::edgeU, &Light::edgeV, &Light::normal,
                                          &Light::radius, &Light::area, &Light::emission, &Light::sides>,
                                FieldList<&Light::material, &Light::triangle, &Light::selection, &Light::cdf>> {};

template <>
struct FieldsOf<LightSample>
    : Fields<FieldList<&LightSample::wi, &LightSample::distance, &LightSample::pdf, &LightSample::radiance,
                       &LightSample::point, &LightSample::error, &LightSample::normal, &LightSample::uv>> {};

template <>
struct FieldsOf<DirectLight>
    : Fields<FieldList<&DirectLight::radiance, &DirectLight::direction, &DirectLight::distance>> {};

template <>
struct FieldsOf<BsdfSample> : Fields<FieldList<&BsdfSample::wi, &BsdfSample::weight, &BsdfSample::pdf,
                                               &BsdfSample::delta, &BsdfSample::transmitted>> {};

// One record, so that compilers see that its parts do not overlap. Lanes that are not in use are computed like the
// others, from whatever they hold.
struct PathLanes {
    RecordLanes<Sampler> samplers;
    RecordLanes<Hit> hits; // of the paths' rays
    RecordLanes<Vertex> vertices;
    RecordLanes<PrincipledValues> values;
    RecordLanes<PrincipledLobes> lobes; // of their bsdfs
    Vec3Lanes coatNormals;              // of these
    RecordLanes<RareLobes> rareLobes;
    RecordLanes<RareValues> rareValues;
    RecordLanes<VertexSamples> u;
    Vec3Lanes throughput;
    FloatLanes time;
    Vec2Lanes selection; // samples that choose a light
    Vec2Lanes position;  // and that place a point on it
    RecordLanes<LightChoice> choices;
    FloatLanes total;          // of LightContext
    RecordLanes<Light> lights; // that were chosen
    RecordLanes<LightSample> lightSamples;
    UintLanes isSampled; // 1: the light's sample is there
    RecordLanes<DirectLight> direct;
    Vec3Lanes diffuse; // directions of sampleLambertian(), and their densities
    FloatLanes diffusePdf;
    RecordLanes<BsdfSample> principled; // samples of principled materials
    FloatLanes aimedShare;              // of first vertices that are shared; 0: of others
    RecordLanes<BsdfSample> aimed;      // their samples
};

// The vertex in a lane, with all of its bsdf.
template <Features kFeatures>
RT_FN Vertex vertexIn(const PathLanes& lanes, uint i) {
    Vertex v = get(lanes.vertices, i);
    if (has(kFeatures, kFeaturePrincipled)) read(lanes.lobes, i, v.bsdf.lobes);
    if (has(kFeatures, kFeatureCoatNormal)) v.bsdf.lobes.coatNormal = get(lanes.coatNormals, i);
    if (has(kFeatures, kRareFeatures)) read(lanes.rareLobes, i, v.bsdf.lobes.rare);
    return v;
}

// What sampleLambertian() has sampled.
RT_FN BsdfSample diffuseSample(const PathLanes& lanes, uint i) {
    BsdfSample b = absorbed();
    b.wi = get(lanes.diffuse, i);
    b.weight = get(lanesOf<&Bsdf::albedo>(lanesOf<&Vertex::bsdf>(lanes.vertices)), i);
    b.pdf = lanes.diffusePdf.at[i];
    return b;
}

// A vertex as shadeHit() leaves it.
template <Features kFeatures>
RT_FN void keepVertex(PathLanes& lanes, uint i, const Vertex& v) {
    set(lanes.vertices, i, v);
    if (!isPrincipled(kFeatures, v.bsdf)) return;
    set(lanes.values, i, v.values);
    if (has(kFeatures, kFeatureCoatNormal)) set(lanes.coatNormals, i, v.bsdf.lobes.coatNormal);
    if (has(kFeatures, kRareFeatures)) set(lanes.rareValues, i, v.values.rare);
}

// Calls work(i) for each lane of `set`, a bit a lane.
template <class Work>
RT_FN void eachLane(uint set, const Work& work) {
    for (uint rest = set; rest != 0u; rest &= rest - 1u) work(accel::lowestBit(rest));
}

RT_SHARED_END
