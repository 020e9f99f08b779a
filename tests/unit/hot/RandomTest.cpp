#include <algorithm>
#include <bit>
#include <functional>
#include <string>

#include "Common/Shared/Base/Random.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using test::agrees;
using test::chiSquareP;
using test::kSignificance;
using test::Mean;

RenderParams paramsOf(uint kind, uint strataX = 16, uint strataY = 16, uint seed = 0) {
    RenderParams params{};
    params.samplerKind = kind;
    params.strataX = strataX;
    params.strataY = strataY;
    params.seed = seed;
    params.width = 64;
    return params;
}

constexpr uint kKinds[] = {kSamplerIndependent, kSamplerStratified, kSamplerSobol, kSamplerSobolBlue};

// ---- numbers -------------------------------------------------------------------------------------------------------

TEST(Uniform, IsTheGridWithoutOne) {
    for (uint k = 0; k < 1u << 24; ++k) {
        const float u = toUniform(k << 8);
        ASSERT_EQ(u, static_cast<float>(k) * 0x1p-24f);
        ASSERT_EQ(toUniform(k << 8 | 255u), u);
    }
    EXPECT_EQ(toUniform(0xffffffffu), 1 - 0x1p-24f);
}

TEST(Uniform, FineHas48BitsNearZero) {
    EXPECT_EQ(toFineUniform(0, 0), 0.0f);
    EXPECT_EQ(toFineUniform(0, 256), 0x1p-48f);
    EXPECT_EQ(toFineUniform(256, 0), 0x1p-24f);
    EXPECT_LT(toFineUniform(0xffffffffu, 0xffffffffu), 1.0f);
    Mean tiny; // P(u < 1e-7): the 24-bit grid would be 19 % off
    for (uint i = 0; i < 1u << 24; ++i) tiny.add(toFineUniform(hash1(i) & 0x3ffu, hash1(i ^ 0x80000000u)) < 1e-7f);
    EXPECT_TRUE(agrees(tiny, 1e-7 * 0x1p22, 1e-3));
}

TEST(Uniform, StretchReusesTheRest) {
    EXPECT_EQ(remapSample(0.25f, 0.25f, 0.75f), 0.0f);
    EXPECT_EQ(remapSample(0.5f, 0.25f, 0.75f), 0.5f);
    EXPECT_LT(remapSample(0.75f, 0.25f, 0.75f), 1.0f);
    EXPECT_EQ(remapSample(0.2f, 0.25f, 0.75f), 0.0f);
}

// ---- hashes --------------------------------------------------------------------------------------------------------

// One flipped input bit changes half of the output bits that matter. Products carry upwards only, so the highest input
// bits leave the lowest output bits alone; a uniform's upper half, its first 2^-16, must not notice.
TEST(Hash, Avalanche) {
    for (int word = 0; word < 3; ++word) {
        for (uint bit = 0; bit < 32; ++bit) {
            Mean flips;
            for (uint i = 0; i < 4096; ++i) {
                uvec3 in(hash1(3 * i), hash1(3 * i + 1), hash1(3 * i + 2)), changed = in;
                changed[word] ^= 1u << bit;
                const uvec3 d = hash3(in) ^ hash3(changed);
                flips.add((std::popcount(d.x >> 16) + std::popcount(d.y >> 16) + std::popcount(d.z >> 16)) / 3.0);
            }
            EXPECT_NEAR(flips.mean(), 8, 0.6) << "word " << word << " bit " << bit;
        }
    }
    for (uint bit = 0; bit < 32; ++bit) {
        Mean flips;
        for (uint i = 0; i < 1u << 15; ++i) {
            const uint in = i * 0x9e3779b9u;
            flips.add(std::popcount(hash1(in) ^ hash1(in ^ 1u << bit)));
        }
        EXPECT_NEAR(flips.mean(), 16, 0.1) << bit;
    }
}

// Serial independence of the raw words: neighbours in each argument, their low bytes, and collisions.
TEST(Hash, NeighboursAreIndependent) {
    const auto word = [](uint pixel, uint index, uint pair) {
        return sampleWords(makeSampler(paramsOf(kSamplerIndependent), pixel, 0, index), pair);
    };
    const std::pair<const char*, std::function<std::pair<uint, uint>(uint)>> series[] = {
        {"x and y", [&](uint i) { return std::pair(word(7, i, 5).x, word(7, i, 5).y); }},
        {"pixels", [&](uint i) { return std::pair(word(2 * i, 3, 5).x, word(2 * i + 1, 3, 5).x); }},
        {"samples", [&](uint i) { return std::pair(word(7, 2 * i, 5).x, word(7, 2 * i + 1, 5).x); }},
        {"dimensions", [&](uint i) { return std::pair(word(7, 3, 2 * i).x, word(7, 3, 2 * i + 1).y); }},
        {"low bytes", [&](uint i) { return std::pair(word(i, 3, 5).x << 24, word(i, 3, 5).y << 24); }},
    };
    for (const auto& [name, draw] : series) {
        std::vector<std::uint64_t> counts(64 * 64);
        for (uint i = 0; i < 1u << 19; ++i) {
            const auto [a, b] = draw(i);
            ++counts[(a >> 26) * 64 + (b >> 26)];
        }
        EXPECT_GT(chiSquareP(counts), kSignificance) << name;
    }
    std::vector<std::uint64_t> all;
    for (uint pixel = 0; pixel < 1u << 16; ++pixel)
        for (uint index = 0; index < 16; ++index) {
            const uvec2 w = word(pixel, index, 9);
            all.push_back(std::uint64_t{w.x} << 32 | w.y);
        }
    std::sort(all.begin(), all.end());
    EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
}

TEST(Hash, SeedsPixelsAndReplicatesDiffer) {
    for (const uint kind : kKinds) {
        const vec2 u = sample2D(makeSampler(paramsOf(kind), 5, 0, 3), 11);
        EXPECT_EQ(u, sample2D(makeSampler(paramsOf(kind), 5, 0, 3), 11));
        EXPECT_NE(u, sample2D(makeSampler(paramsOf(kind, 16, 16, 1), 5, 0, 3), 11));
        EXPECT_NE(u, sample2D(makeSampler(paramsOf(kind), 6, 0, 3), 11));
        EXPECT_NE(u, sample2D(makeSampler(paramsOf(kind), 5, 1, 3), 11));
        EXPECT_NE(u, sample2D(makeSampler(paramsOf(kind), 5, 0, 4), 11));
        EXPECT_NE(u, sample2D(makeSampler(paramsOf(kind), 5, 0, 3), 12));
    }
}

// ---- Sobol ---------------------------------------------------------------------------------------------------------

// Every elementary box 2^-j x 2^(j-m) holds exactly one of any 2^m consecutive, aligned points.
void expectNet(const std::function<uvec2(uint)>& point, uint m, uint first, const std::string& what) {
    for (uint j = 0; j <= m; ++j) {
        std::vector<bool> taken(1u << m);
        for (uint i = 0; i < 1u << m; ++i) {
            const uvec2 p = point(first + i);
            const uint column = j == 0 ? 0 : p.x >> (32 - j), row = j == m ? 0 : p.y >> (32 - (m - j));
            const uint box = column << (m - j) | row;
            ASSERT_FALSE(taken[box]) << what << ", box " << j;
            taken[box] = true;
        }
    }
}

TEST(Sobol, EveryScrambleIsANet) {
    for (const uint m : {4u, 8u, 12u}) {
        for (uint seed = 0; seed < 64; ++seed) {
            const Sampler s = makeSampler(paramsOf(kSamplerSobol, 1, 1, seed), 77, 0, 0);
            const auto point = [&](uint i) {
                Sampler at = s;
                at.index = i;
                return sampleWords(at, seed + 3);
            };
            expectNet(point, m, 0, "start");
            if (seed < 8) expectNet(point, m, 5u << m, "later");
        }
    }
}

TEST(Sobol, OnePointIsUniformOverScrambles) {
    std::vector<std::uint64_t> counts(32 * 32);
    for (uint seed = 0; seed < 1u << 17; ++seed) {
        const vec2 u = sample2D(makeSampler(paramsOf(kSamplerSobol), seed, 0, 6), 4);
        ++counts[static_cast<int>(u.x * 32) * 32 + static_cast<int>(u.y * 32)];
    }
    EXPECT_GT(chiSquareP(counts), kSignificance);
}

// Scrambled digits: in each pair of cells of the finest level tested, which of the two points comes first is a fair
// coin, and different coins are independent.
TEST(Sobol, OwenScrambleFlipsEveryDigitFairly) {
    std::vector<std::uint64_t> counts(256);
    for (uint seed = 0; seed < 1u << 16; ++seed) ++counts[owenScramble(0x5a000000u, hash1(seed)) >> 24];
    EXPECT_GT(chiSquareP(counts), kSignificance);
    for (uint digit = 0; digit < 16; ++digit) {
        std::vector<std::uint64_t> flips(4);
        for (uint seed = 0; seed < 1u << 14; ++seed) {
            const uint bit = 31 - digit;
            const uint a = owenScramble(0x33333333u, hash1(seed)),
                       b = owenScramble(0x33333333u ^ 1u << bit, hash1(seed));
            ASSERT_EQ((a ^ b) >> bit, 1u); // nested: higher digits agree, this one differs
            ++flips[2 * (a >> bit & 1u) + ((digit < 31 ? a >> (bit - 1) ^ b >> (bit - 1) : 0u) & 1u)];
        }
        EXPECT_GT(chiSquareP(flips), kSignificance) << digit;
    }
}

// ---- strata --------------------------------------------------------------------------------------------------------

TEST(Permute, IsABijection) {
    for (uint n = 1; n < 300; ++n) {
        std::vector<bool> seen(n);
        for (uint i = 0; i < n; ++i) {
            const uint p = permute(i, n, hash1(n));
            ASSERT_LT(p, n);
            ASSERT_FALSE(seen[p]);
            seen[p] = true;
        }
    }
    std::vector<std::uint64_t> counts(48);
    for (uint key = 0; key < 1u << 16; ++key) ++counts[permute(5, 48, hash1(key))];
    EXPECT_GT(chiSquareP(counts), kSignificance);
}

// Any number of samples: a prefix has at most one sample in a cell, a round has exactly one, and each point is uniform.
TEST(Stratified, CoversEveryCellOnce) {
    for (const auto& [x, y] : {std::pair{1u, 1u}, {3u, 4u}, {16u, 16u}, {25u, 40u}}) {
        for (uint round = 0; round < 3; ++round) {
            std::vector<bool> seen(x * y);
            for (uint i = 0; i < x * y; ++i) {
                const vec2 u = sample2D(makeSampler(paramsOf(kSamplerStratified, x, y), 9, 0, round * x * y + i), 4);
                ASSERT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
                // In the middle of the grid's cell, because a cell's edge need not be on the grid.
                const uint cell = uint((double(u.y) + 0x1p-25) * y) * x + uint((double(u.x) + 0x1p-25) * x);
                ASSERT_FALSE(seen[cell]) << x << 'x' << y;
                seen[cell] = true;
            }
        }
    }
    for (const uint index : {0u, 5u, 300u}) {
        std::vector<std::uint64_t> counts(32 * 32);
        for (uint pixel = 0; pixel < 1u << 16; ++pixel) {
            const vec2 u = sample2D(makeSampler(paramsOf(kSamplerStratified, 12, 20), pixel, 0, index), 4);
            ++counts[static_cast<int>(u.x * 32) * 32 + static_cast<int>(u.y * 32)];
        }
        EXPECT_GT(chiSquareP(counts), kSignificance) << index;
    }
}

// ---- all kinds -----------------------------------------------------------------------------------------------------

// Pairs of different dimensions and of neighbouring pixels must be independent whatever the stratification inside a
// pair.
TEST(Samplers, PairsAreIndependentOfEachOther) {
    for (const uint kind : kKinds) {
        std::vector<std::uint64_t> dimensions(32 * 32), pixels(32 * 32);
        for (uint pixel = 0; pixel < 1u << 12; ++pixel) {
            for (uint i = 0; i < 16; ++i) {
                const Sampler s = makeSampler(paramsOf(kind, 4, 4), pixel, 0, i);
                const uint light = vertexDimension(0, kDimensionLight), bsdf = vertexDimension(0, kDimensionBsdf);
                const vec2 a = sample2D(s, light), b = sample2D(s, bsdf);
                const vec2 c = sample2D(makeSampler(paramsOf(kind, 4, 4), pixel + 1, 0, i), light);
                ++dimensions[static_cast<int>(a.x * 32) * 32 + static_cast<int>(b.x * 32)];
                ++pixels[static_cast<int>(a.x * 32) * 32 + static_cast<int>(c.x * 32)];
            }
        }
        EXPECT_GT(chiSquareP(dimensions), kSignificance) << kind;
        if (kind != kSamplerSobolBlue) { // whose pixels share a sequence
            EXPECT_GT(chiSquareP(pixels), kSignificance) << kind;
        }
    }
}

// An edge across the pixel covers exactly its share, at every position: no frozen or lopsided jitter.
TEST(Samplers, CoverageOfAnEdge) {
    for (const uint kind : kKinds) {
        for (int step = 1; step < 16; ++step) {
            const float edge = static_cast<float>(step) / 16.0f + 0.01f;
            Mean coverage; // over replicates, whose means are independent
            for (uint replicate = 0; replicate < 32; ++replicate) {
                double inside = 0;
                for (uint i = 0; i < 256; ++i)
                    inside += sample2D(makeSampler(paramsOf(kind), 12, replicate, i), kDimensionPixel).x < edge;
                coverage.add(inside / 256);
            }
            EXPECT_TRUE(agrees(coverage, edge, 1e-4)) << kind << ' ' << edge;
        }
    }
}

// Root mean square errors of a smooth integral with 256 samples: strata and Sobol must pay.
TEST(Samplers, StratificationPays) {
    double errors[4] = {};
    for (const uint kind : kKinds) {
        double squares = 0;
        for (uint pixel = 0; pixel < 128; ++pixel) {
            double sum = 0;
            for (uint i = 0; i < 256; ++i) {
                const vec2 u = sample2D(makeSampler(paramsOf(kind), pixel, 0, i), 6);
                sum += std::exp(double(u.x) + double(u.y));
            }
            squares += std::pow(sum / 256 / std::pow(std::exp(1.0) - 1, 2) - 1, 2);
        }
        errors[kind] = std::sqrt(squares / 128);
    }
    EXPECT_LT(errors[kSamplerStratified] * 5, errors[kSamplerIndependent]);
    EXPECT_LT(errors[kSamplerSobol] * 2, errors[kSamplerStratified]);
}

// Errors of an image whose pixels are one smooth integral, at 16 samples.
std::vector<double> errorImage(uint kind, uint seed) {
    constexpr uint kSide = 64;
    std::vector<double> errors;
    for (uint pixel = 0; pixel < kSide * kSide; ++pixel) {
        double sum = 0;
        for (uint i = 0; i < 16; ++i) {
            const vec2 u = sample2D(makeSampler(paramsOf(kind, 4, 4, seed), pixel, 0, i), 6);
            sum += std::exp(double(u.x) + double(u.y));
        }
        errors.push_back(sum / 16 / std::pow(std::exp(1.0) - 1, 2) - 1);
    }
    return errors;
}

// Neighbours' errors cancel: means of 4 x 4 pixels, wherever they begin, have less than half of the root mean square of
// independent pixels, and single pixels are as good as ever.
TEST(Samplers, ErrorsAreBlueNoise) {
    const auto rms = [](uint kind, uint block) {
        Mean squares;
        for (uint seed = 0; seed < 32; ++seed) {
            const std::vector<double> errors = errorImage(kind, seed);
            for (uint y = 2; y + block <= 64; y += block) // 2: not aligned to the quadrants
                for (uint x = 2; x + block <= 64; x += block) {
                    double sum = 0;
                    for (uint k = 0; k < block * block; ++k) sum += errors[(y + k / block) * 64 + x + k % block];
                    squares.add(std::pow(sum / (block * block), 2));
                }
        }
        return std::sqrt(squares.mean());
    };
    EXPECT_LT(rms(kSamplerSobolBlue, 1), 1.2 * rms(kSamplerSobol, 1)); // of 32 scramblings, each worth some 30 %
    EXPECT_LT(rms(kSamplerSobolBlue, 4) * 2, rms(kSamplerSobol, 4));
}

// A quadrant's pixels together are a net: 64 samples of 4 pixels have one in each of 64 strips, and 16 of one pixel in
// each of 16.
TEST(Samplers, BlueNoiseSharesOneSequence) {
    for (const uint pixels : {1u, 4u}) {
        std::vector<int> x(16 * pixels), y(16 * pixels);
        for (uint p = 0; p < pixels; ++p)
            for (uint i = 0; i < 16; ++i) {
                const uint pixel = (10 + p / 2) * 64 + 20 + p % 2;
                const uvec2 w = sampleWords(makeSampler(paramsOf(kSamplerSobolBlue, 4, 4), pixel, 0, i), 6);
                ++x[static_cast<std::size_t>((std::uint64_t{w.x} * 16 * pixels) >> 32)];
                ++y[static_cast<std::size_t>((std::uint64_t{w.y} * 16 * pixels) >> 32)];
            }
        for (uint k = 0; k < 16 * pixels; ++k) EXPECT_TRUE(x[k] == 1 && y[k] == 1) << pixels << " " << k;
    }
}

// More samples than the image's sequence has for a pixel go on in rounds of their own, in which no number comes again.
TEST(Samplers, BlueNoiseGoesOnInRounds) {
    std::set<std::pair<uint, uint>> seen;
    Mean mean;
    for (uint i = 0; i < 4096; ++i) {
        const uvec2 w = sampleWords(makeSampler(paramsOf(kSamplerSobolBlue, 4, 4), 77, 0, i), 6);
        EXPECT_TRUE(seen.insert({w.x, w.y}).second) << i;
        mean.add(double(w.x) / 0x1p32);
    }
    EXPECT_TRUE(agrees(mean, 0.5));
}

// Vertices never share a dimension, with each other or with the camera.
TEST(Samplers, DimensionsDoNotOverlap) {
    EXPECT_GE(vertexDimension(0, 0), kCameraDimensions);
    EXPECT_LT(kDimensionTime, kCameraDimensions);
    EXPECT_LT(kDimensionMedium, kDimensionsPerVertex);
    EXPECT_EQ(vertexDimension(4, 0), vertexDimension(3, kDimensionsPerVertex));
    EXPECT_LT(vertexDimension(4096, kDimensionsPerVertex), 1u << 16); // media use the upper half of the word
}

} // namespace
} // namespace rt::shared
