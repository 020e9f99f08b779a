// Random numbers for all samples of a block at once. Included by one translation unit per instruction set; all it defines has
// internal linkage.
#pragma once
#include "Common/Image/Film.h"
#include "Common/Shared/Path/PathStep.h"

namespace rt::cpu {
namespace {

using namespace rt::shared;

// One dimension of the samples of a block.
struct PairTable {
    float x[image::Film::kBlock];
    float y[image::Film::kBlock];
    vec2 at(std::uint32_t lane) const { return vec2(x[lane], y[lane]); }
};

RT_CALL void fillPairs(PairTable& table, const Sampler& first, std::uint32_t dimension) {
    const uvec3 key = hash3(uvec3(first.key, kSobolKey, dimension));
    for (std::uint32_t lane = 0; lane < image::Film::kBlock; ++lane) {
        const uvec2 words = sobolPair(first.base + first.index + lane, key);
        table.x[lane] = toUniform(words.x);
        table.y[lane] = toUniform(words.y);
    }
}

// Whether a table of numbers is worth its while for the samples first.index .. first.index + count - 1.
RT_FN bool isWorthTable(const Sampler& first, std::uint32_t count) {
    return first.kind == kSamplerSobol && count >= 4;
}

// The samples of a pixel's block share the scrambling of every dimension and differ in their index alone, so one pass over the
// lanes of a vector makes a pair of numbers for all of them. A vertex is filled in when the first path gets there; the
// numbers are those of Random.h, bit for bit.
class NumberTable {
  public:
    // For samples first.index .. first.index + count - 1 of a kernel with these features.
    NumberTable(const Sampler& first, std::uint32_t count, std::uint32_t features)
        : first_(first),
          tabulated_(isWorthTable(first, count)),
          needsLight_(has(features, kFeatureLights | kFeatureTargets)),
          needsSelect_(has(features, kFeatureManyLights)) {}

    vec2 pixelNumbers(const Sampler& smp) {
        if (!tabulated_) return randomPair(smp, kPairPixel);
        if (smp.index == first_.index) fillPairs(pixel_, first_, kPairPixel);
        return pixel_.at(smp.index - first_.index);
    }

    VertexNumbers vertexNumbers(const Sampler& smp, std::uint32_t vertex) {
        if (!tabulated_ || vertex >= kVertices) return shared::vertexNumbers(smp, vertex);
        if (vertex == filled_) fillVertex(filled_++); // paths pass their vertices in order
        const std::uint32_t lane = smp.index - first_.index;
        const Vertex& v = vertices_[vertex];
        VertexNumbers numbers;
        numbers.light = needsLight_ ? v.light.at(lane) : vec2(0.0f);
        numbers.bsdf = v.bsdf.at(lane);
        numbers.choice = v.choice.at(lane);
        numbers.select = needsSelect_ ? v.select.at(lane) : vec2(0.0f);
        return numbers;
    }

  private:
    static constexpr std::uint32_t kVertices = 4; // many paths end before farther ones

    struct Vertex {
        PairTable light, bsdf, choice, select;
    };

    void fillVertex(std::uint32_t vertex) {
        if (needsLight_) fillPairs(vertices_[vertex].light, first_, vertexPair(vertex, kPairLight));
        fillPairs(vertices_[vertex].bsdf, first_, vertexPair(vertex, kPairBsdf));
        fillPairs(vertices_[vertex].choice, first_, vertexPair(vertex, kPairChoice));
        if (needsSelect_) fillPairs(vertices_[vertex].select, first_, vertexPair(vertex, kPairSelect));
    }

    const Sampler first_;
    const bool tabulated_;
    const bool needsLight_;    // whether kPairLight is read at all
    const bool needsSelect_;   // whether kPairSelect is
    std::uint32_t filled_ = 0; // vertices
    PairTable pixel_;
    Vertex vertices_[kVertices];
};

} // namespace
} // namespace rt::cpu
