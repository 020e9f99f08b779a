// Counter-based random numbers: (pixel, sample, dimension, seed) -> number, the same on both engines and for any
// scheduling. A path's decisions have fixed dimensions; features decide which are evaluated, never which number a
// decision gets. All uniforms lie on the grid k 2^-24 in [0, 1 - 2^-24] unless a function says otherwise.
#ifndef RT_SHARED_RANDOM_H
#define RT_SHARED_RANDOM_H
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

// ---- dimensions ----------------------------------------------------------------------------------------------------
// A sample dimension is a 2D point of the unit square. Dimensions of the camera come first, then kDimensionsPerVertex
// for each vertex of the path.
const uint kDimensionPixel = 0u; // position in the pixel
const uint kDimensionLens = 1u;  // position on the lens
const uint kDimensionTime = 2u;  // x: time in the shutter interval
const uint kCameraDimensions = 4u;
const uint kDimensionLight = 0u;     // choice of the light, stretched, and position on it
const uint kDimensionBsdf = 1u;      // lobe or direction of the scattered ray
const uint kDimensionRoulette = 2u;  // x: survival of the roulette, y: technique of the mixture or connection
const uint kDimensionSelection = 3u; // choice of the light where there are too many to stretch kDimensionLight
const uint kDimensionMedium = 4u;    // x: free flight in medium 0; medium m uses dimension kDimensionMedium + (m << 16)
const uint kDimensionConnection = 5u; // place on a light behind a sphere
const uint kDimensionSide = 6u;       // x: side of a surface on which the path goes on, y: its colour channel
const uint kDimensionsPerVertex = 8u;

RT_FN uint vertexDimension(uint vertex, uint dimension) {
    return kCameraDimensions + vertex * kDimensionsPerVertex + dimension;
}

// ---- hashing -------------------------------------------------------------------------------------------------------

// Three words to three words. Jarzynski & Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020: pcg3d.
RT_FN uvec3 hash3(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v = v ^ (v >> 16u);
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// A bijection of 32-bit words with full avalanche (the constants are those found by Wellons' search for low bias).
RT_FN uint hash1(uint x) {
    x ^= x >> 16u;
    x *= 0x21f0aaadu;
    x ^= x >> 15u;
    x *= 0xd35a2d97u;
    x ^= x >> 15u;
    return x;
}

RT_FN float toUniform(uint x) {
    return float(x >> 8u) * 5.9604644775390625e-8f;
}

// In [0,1) with 48 random bits, fine near 0: for free flights through thin media.
RT_FN float toFineUniform(uint high, uint low) {
    return min(float(high >> 8u) * 5.9604644775390625e-8f + float(low >> 8u) * 3.5527136788005009e-15f,
               0.999999940395355f);
}

// ---- Owen-scrambled Sobol ------------------------------------------------------------------------------------------

// Nested uniform scrambling of a word whose most significant digit is bit 0. Laine & Karras, "Stratified Sampling for
// Stochastic Transparency", 2011, with the constants that Vegdahl found to scramble well for all seeds.
RT_FN uint laineKarras(uint x, uint seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

RT_FN uint owenScramble(uint x, uint seed) {
    return bitfieldReverse(laineKarras(bitfieldReverse(x), seed));
}

// The second coordinate of Sobol's sequence, bit-reversed: multiplication by Pascal's triangle modulo 2, which is a
// Kronecker power of [[1,1],[0,1]] and so takes one step per bit of the bit index.
RT_FN uint sobolSecondReversed(uint index) {
    uint x = index;
    x ^= (x & 0xaaaaaaaau) >> 1u;
    x ^= (x & 0xccccccccu) >> 2u;
    x ^= (x & 0xf0f0f0f0u) >> 4u;
    x ^= (x & 0xff00ff00u) >> 8u;
    x ^= (x & 0xffff0000u) >> 16u;
    return x;
}

// Two words of the (0,2)-sequence: point `index`, order and both coordinates scrambled by the words of `key`.
RT_FN uvec2 sobolWords(uint index, uvec3 key) {
    uint shuffled = owenScramble(index, key.z);
    return uvec2(bitfieldReverse(laineKarras(shuffled, key.x)),
                 bitfieldReverse(laineKarras(sobolSecondReversed(shuffled), key.y)));
}

// ---- jittered strata -----------------------------------------------------------------------------------------------

// Element i of a pseudo-random permutation of [0, n), n >= 1. Kensler, "Correlated Multi-Jittered Sampling", Pixar
// 2013, with cycle walking over a hash that is a bijection of the words below the next power of two.
RT_FN uint permute(uint i, uint n, uint key) {
    uint w = n - 1u;
    w |= w >> 1u;
    w |= w >> 2u;
    w |= w >> 4u;
    w |= w >> 8u;
    w |= w >> 16u;
    do {
        i ^= key;
        i *= 0xe170893du;
        i ^= key >> 16u;
        i ^= (i & w) >> 4u;
        i ^= key >> 8u;
        i *= 0x0929eb3fu;
        i ^= key >> 23u;
        i ^= (i & w) >> 1u;
        i *= 1u | key >> 27u;
        i *= 0x6935fa69u;
        i ^= (i & w) >> 11u;
        i *= 0x74dcb303u;
        i ^= (i & w) >> 2u;
        i *= 0x9e501cc3u;
        i ^= (i & w) >> 2u;
        i *= 0xc860a3dfu;
        i &= w;
        i ^= i >> 5u;
    } while (i >= n);
    return (i + key) % n;
}

const uint kSobolKey = 0x50b01u; // keeps the scrambling apart from independent numbers

// ---- the sampler ---------------------------------------------------------------------------------------------------

struct Sampler {
    uint kind;  // kSamplerIndependent, kSamplerStratified, kSamplerSobol
    uint key;   // of the pixel, the seed and the replicate
    uint index; // of the sample in the pixel
    uint base;  // of the pixel's samples in Sobol's sequence
    uint strataX;
    uint strataY;
};

// Bits of x at even places.
RT_FN uint spreadBits(uint x) {
    x = (x | x << 8u) & 0x00ff00ffu;
    x = (x | x << 4u) & 0x0f0f0f0fu;
    x = (x | x << 2u) & 0x33333333u;
    return (x | x << 1u) & 0x55555555u;
}

// kSamplerSobolBlue: all pixels share one sequence, in the order of a Z curve, and the scrambling of its index, which
// is nested, shuffles quadrants at every level. What 2^k pixels of a square take together is stratified like the
// samples of one, so errors of neighbours cancel, and errors turn into blue noise (Ahmed & Wonka, "Screen-Space
// Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels", 2020). A pixel takes
// 2^strataX samples in a row; those beyond are of another, independent round.
RT_FN Sampler makeSampler(RT_IN(RenderParams) params, uint pixel, uint replicate, uint index) {
    Sampler s;
    s.kind = params.samplerKind;
    s.key = hash3(uvec3(pixel, params.seed, replicate)).x;
    s.index = index;
    s.base = 0u;
    if (params.samplerKind == kSamplerSobolBlue) {
        uint round = index >> params.strataX;
        uint order = spreadBits(pixel % params.width) | spreadBits(pixel / params.width) << 1u;
        s.kind = kSamplerSobol;
        s.key = hash3(uvec3(0x9e3779b9u ^ round, params.seed, replicate)).z;
        s.base = (order - round) << params.strataX;
    }
    s.strataX = params.strataX;
    s.strataY = params.strataY;
    return s;
}

// Words of a dimension of sample `index` in Sobol's sequence (Sampler::base + Sampler::index). Without a branch, for
// loops over samples.
RT_FN uvec2 sobolSample(uint key, uint index, uint dimension) {
    return sobolWords(index, hash3(uvec3(key, kSobolKey, dimension)));
}

// The two words of a dimension; each is uniform over all words, and the point is stratified over the samples of the
// pixel as the kind of sampler says.
RT_CALL uvec2 sampleWords(RT_IN(Sampler) s, uint dimension) {
    if (s.kind == kSamplerIndependent) {
        uvec3 h = hash3(uvec3(s.key, s.index, dimension));
        return uvec2(h.x, h.y);
    }
    if (s.kind == kSamplerSobol) return sobolSample(s.key, s.base + s.index, dimension);
    uint cells = s.strataX * s.strataY;
    uint round = s.index / cells;
    uint cell = permute(s.index % cells, cells, hash3(uvec3(s.key, round, dimension)).z);
    uvec3 h = hash3(uvec3(s.key, s.index, dimension));
    // In integers, which are the same on every device.
    return uvec2(cell % s.strataX * (0xffffffffu / s.strataX) + h.x / s.strataX,
                 cell / s.strataX * (0xffffffffu / s.strataY) + h.y / s.strataY);
}

RT_FN vec2 toUniform2(uvec2 words) {
    return vec2(toUniform(words.x), toUniform(words.y));
}

RT_FN vec2 sample2D(RT_IN(Sampler) s, uint dimension) {
    return toUniform2(sampleWords(s, dimension));
}

// First coordinate of a dimension, in [0,1), fine near 0.
RT_FN float sampleFine(RT_IN(Sampler) s, uint dimension) {
    uint high = sampleWords(s, dimension).x;
    return toFineUniform(high, hash3(uvec3(s.key ^ 0x9e3779b9u, s.base + s.index, dimension)).x);
}

// u, known to lie in [low, high) of a distribution function, stretched to [0,1): reuses a number after a choice.
RT_FN float remapSample(float u, float low, float high) {
    return clamp((u - low) / (high - low), 0.0f, 0.999999940395355f);
}

RT_SHARED_END

#endif
