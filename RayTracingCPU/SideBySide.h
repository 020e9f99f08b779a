// Paths with next-event estimation. As many as there are lanes take their steps together, and as soon as one ends the next
// begins. Lights are chosen by contribution and sampled in lanes, and of what the choice from a tree waits for in memory, each
// path's arrives during the turns of the others. Included by one translation unit per instruction set; all it defines has
// internal linkage.
#pragma once
#include "RayTracingCPU/SceneAccess.h"

#include "RayTracingCPU/LightLanes.h"
#include "RayTracingCPU/NumberTable.h"
#include "RayTracingCPU/PathRays.h"

namespace rt::cpu {
namespace {

using namespace rt::shared;

// A path under way.
struct Flight {
    PathState path;
    Sampler smp;
    uint place = kNone; // among the samples of the tile; kNone: there is no path
};

// The samples of a tile, pixel by pixel.
class PathQueue {
  public:
    PathQueue(const KernelContext& context, const TileTask& task)
        : context_(context), task_(task), count_(task.width * task.height * task.count) {}

    // Begins the next path. False: none is left.
    template <uint kFeatures>
    bool begin(Flight& flight) {
        if (next_ == count_) return false;
        const uint inPixel = next_ % task_.count;
        if (inPixel == 0u) beginPixel();
        flight.place = next_++;
        flight.smp = first_;
        flight.smp.index += inPixel;
        const vec2 numbers = isTabulated_ ? numbers_.at(inPixel) : randomPair(flight.smp, kPairPixel);
        flight.path = startPath(kFeatures, context_.params, context_.camera, flight.smp, pixel_, numbers);
        return true;
    }

  private:
    void beginPixel() {
        const uint place = next_ / task_.count;
        pixel_ = uvec2(task_.x + place % task_.width, task_.y + place / task_.width);
        const uint index = pixel_.y * context_.params.width + pixel_.x;
        first_ = makeSampler(context_.params, index, task_.replicate, task_.first);
        isTabulated_ = isWorthTable(first_, task_.count);
        if (isTabulated_) fillPairs(numbers_, first_, kPairPixel);
    }

    const KernelContext& context_;
    const TileTask& task_;
    const uint count_;
    uint next_ = 0u;
    uvec2 pixel_{0u};
    Sampler first_{}; // of the pixel's samples
    bool isTabulated_ = false;
    PairTable numbers_; // of the pixel's samples, if isTabulated_
};

// Calls work(i) for each lane of `set`, a bit a lane.
template <class Work>
RT_FN void eachLane(uint set, const Work& work) {
    for (uint i = 0u; i < kLanes; ++i) {
        if ((set >> i & 1u) != 0u) work(i);
    }
}

// The numbers of all vertices.
template <uint kFeatures>
RT_CALL void drawNumbers(const Flight* flights, uint arrived, VertexLanes& vertices) {
    if (flights[0].smp.kind != kSamplerSobol) {
        eachLane(arrived,
                 [&](uint i) { setNumbers(vertices, i, vertexNumbers(flights[i].smp, vertices.index.at[i])); });
        return;
    }
    UintLanes keys;
    UintLanes indices;
    for (uint i = 0u; i < kLanes; ++i) {
        keys.at[i] = flights[i].smp.key;
        indices.at[i] = flights[i].smp.base + flights[i].smp.index;
    }
    const auto draw = [&](uint kind, Vec2Lanes& numbers) {
        for (uint i = 0u; i < kLanes; ++i) {
            const uvec3 key = hash3(uvec3(keys.at[i], kSobolKey, vertexPair(vertices.index.at[i], kind)));
            const uvec2 words = sobolPair(indices.at[i], key);
            set(numbers, i, vec2(toUniform(words.x), toUniform(words.y)));
        }
    };
    draw(kPairLight, vertices.light);
    draw(kPairBsdf, vertices.bsdf);
    draw(kPairChoice, vertices.choice);
    if (has(kFeatures, kFeatureManyLights)) draw(kPairSelect, vertices.select);
}

// Choices by power, or uniform.
template <uint kFeatures>
RT_CALL void chooseOneByOne(const CpuScene& scene, const Flight* flights, uint lit, PathLanes& lanes) {
    eachLane(lit, [&](uint i) {
        const Vertex v = get(lanes.vertices, i);
        LightContext context = flights[i].path.last;
        const vec2 u = selectionNumbers(kFeatures, scene.globals, flights[i].smp, v);
        LightChoice choice = chooseLight(kFeatures, scene, scene.globals.lightCount, u, context);
        choice.u = sampleNumbers(kFeatures, scene.globals, choice, v).x;
        set(lanes.choices, i, choice, context.total);
    });
}

// The choice among lights in a tree, which all paths go down level by level.
template <uint kFeatures>
RT_CALL void chooseFromTree(const CpuScene& scene, const Flight* flights, uint lit, PathLanes& lanes) {
    const VertexLanes& vertices = lanes.vertices;
    TreeDescent descents[kLanes];
    eachLane(lit, [&](uint i) {
        const Vertex v = get(vertices, i);
        descents[i] = beginDescent(selectionNumbers(kFeatures, scene.globals, flights[i].smp, v));
    });
    for (uint descending = lit; descending != 0u;) {
        eachLane(descending, [&](uint i) {
            TreeDescent& d = descents[i];
            descend(scene, get(vertices.origin, i), get(vertices.shading, i), d);
            if (d.child != kNone) expectLightChild(scene, d.child);
            if (!isAtNode(d)) descending &= ~(1u << i);
        });
    }
    eachLane(lit, [&](uint i) {
        const TreeChoice drawn = endDescent(descents[i]);
        set(lanes.choices, i, {drawn.light, drawn.probability, vertices.light.x.at[i]}, drawn.total);
    });
}

// Next-event estimation at the vertices `lit`: lanes.direct.
template <uint kFeatures>
RT_CALL void sampleLights(const CpuScene& scene, const RenderParams& params, Flight* flights, uint lit,
                          PathLanes& lanes) {
    if (params.lightSelection != kSelectContribution) {
        chooseOneByOne<kFeatures>(scene, flights, lit, lanes);
    } else if (usesLightTree(kFeatures, scene.globals.lightCount)) {
        chooseFromTree<kFeatures>(scene, flights, lit, lanes);
    } else {
        chooseByContribution(scene, lanes);
    }
    eachLane(lit, [&](uint i) {
        PathState& path = flights[i].path;
        path.last.total = lanes.choices.total.at[i];
        set(lanes.throughput, i, path.throughput);
        lanes.time.at[i] = path.ray.time;
        lanes.sampled.at[i] = 0u;
        const uint light = lanes.choices.light.at[i];
        if (light != kNone) set(lanes.lights, i, scene.lights[light]);
    });
    if (has(kFeatures, kFeatureQuadLights) && params.quadLight == kShapeAuto) sampleQuads(lanes);
    if (has(kFeatures, kFeatureSphereLights) && params.sphereLight == kShapeAuto) {
        sampleSpheres<kFeatures & kFeatureMotion>(lanes);
    }
    eachLane(lit, [&](uint i) {
        const uint chosen = lanes.choices.light.at[i];
        if (chosen == kNone) {
            lanes.samples.pdf.at[i] = 0.0f;
            return;
        }
        const Light& light = scene.lights[chosen];
        if (lanes.sampled.at[i] == 0u) {
            const Vertex v = get(lanes.vertices, i);
            const vec2 u = sampleNumbers(lanes, i);
            set(lanes.samples, i, sampleChosenLight(kFeatures, scene, params, light, v, lanes.time.at[i], u));
        } else if (has(kFeatures, kTexturedFeatures) && light.material != kNone) {
            LightSample sampled = get(lanes.samples, i);
            applyEmissionTexture(kFeatures, scene, light, sampled);
            set(lanes.samples.radiance, i, sampled.radiance);
        }
    });
    weighSamples<kFeatures>(params, lanes);
}

// Where all vertices would scatter if they were Lambertian.
RT_CALL void sampleDiffuse(PathLanes& lanes) {
    for (uint i = 0u; i < kLanes; ++i) {
        const vec3 albedo = get(lanes.vertices.albedo, i);
        const BsdfSample b = sampleLambertian(albedo, get(lanes.vertices.shading, i), get(lanes.vertices.bsdf, i));
        set(lanes.diffuse, i, b.wi);
        lanes.diffusePdf.at[i] = b.pdf;
    }
}

template <uint kFeatures>
RT_FN BsdfSample sampleScattering(const PathLanes& lanes, uint i, const Vertex& v) {
    const bool inMedium = has(kFeatures, kFeatureVolumes) && v.inMedium != 0u;
    if (inMedium || !isLambertian(kFeatures, v.material)) return sampleScattering(kFeatures, v, v.numbers.bsdf);
    BsdfSample b = absorbed();
    b.wi = get(lanes.diffuse, i);
    b.weight = v.albedo;
    b.pdf = lanes.diffusePdf.at[i];
    return b;
}

// The radiances of a tile's samples in the order of PathQueue. False: cancelled.
template <uint kFeatures>
RT_CALL bool traceSideBySide(const KernelContext& context, const TileTask& task, vec3* radiances,
                             KernelCounters& counters) {
    const CpuScene& scene = *context.scene;
    const RenderParams& params = context.params;
    PathQueue queue(context, task);
    Flight flights[kLanes]{};
    PathLanes lanes{};
    const auto end = [&](Flight& f) {
        radiances[f.place] = f.path.radiance;
        counters.scattered += f.path.vertex - 1u;
        f.place = kNone;
    };
    for (;;) {
        if (task.cancel != nullptr && task.cancel->load(std::memory_order_relaxed)) return false;
        uint arrived = 0u; // at a vertex, a bit a lane
        uint lit = 0u;     // of these, where lights are sampled
        for (uint i = 0u; i < kLanes; ++i) {
            Flight& f = flights[i];
            for (;;) {
                if (f.place == kNone) {
                    if (!queue.begin<kFeatures>(f)) break;
                    set(lanes.hits, i, traceRay(scene, f.path.ray));
                }
                Vertex v;
                DirectLight none = noDirectLight();
                if (!pathVertex(v, kFeatures | kVertexOnly, scene, params, f.smp, {}, get(lanes.hits, i), f.path,
                                none)) {
                    end(f);
                    continue;
                }
                set(lanes.vertices, i, v);
                arrived |= 1u << i;
                lit |= uint(isLitByLights(kFeatures, v)) << i;
                break;
            }
        }
        if (arrived == 0u) return true;
        drawNumbers<kFeatures>(flights, arrived, lanes.vertices);
        sampleLights<kFeatures>(scene, params, flights, lit, lanes);
        sampleDiffuse(lanes);
        eachLane(arrived, [&](uint i) {
            Flight& f = flights[i];
            const Vertex v = get(lanes.vertices, i);
            const DirectLight direct = (lit >> i & 1u) != 0u ? get(lanes.direct, i) : noDirectLight();
            addUnshadowed(direct, f.path);
            if (follow(params, v, sampleScattering<kFeatures>(lanes, i, v), f.path)) {
                set(lanes.hits, i, traceOn<kFeatures>(scene, direct, f.path, counters));
            } else {
                traceShadow<kFeatures>(scene, direct, f.path, counters);
                end(f);
            }
        });
    }
}

} // namespace
} // namespace rt::cpu
