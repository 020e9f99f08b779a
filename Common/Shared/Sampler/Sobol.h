// Owen-scrambled points of Sobol's (0,2)-sequence, scrambled anew for each pixel and dimension.
#ifndef RT_SHARED_SOBOL_H
#define RT_SHARED_SOBOL_H
#include "Common/Shared/Sampler/PixelSampler.h"

RT_SHARED_BEGIN

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

const uint kSobolKey = 0x50b01u; // keeps the scrambling apart from independent numbers

// Words of a dimension of sample `index` in Sobol's sequence (Sampler::base + Sampler::index). Without a branch, for
// loops over samples.
RT_FN uvec2 sobolSample(uint key, uint index, uint dimension) {
    return sobolWords(index, hash3(uvec3(key, kSobolKey, dimension)));
}

RT_FN uvec2 sobolWords(RT_IN(Sampler) s, uint dimension) {
    return sobolSample(s.key, s.base + s.index, dimension);
}

RT_SHARED_END

#endif
