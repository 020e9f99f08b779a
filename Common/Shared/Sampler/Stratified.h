// Jittered strata: in a round of strataX * strataY samples one in each cell of a grid, in an order of the dimension's own.
#ifndef RT_SHARED_STRATIFIED_H
#define RT_SHARED_STRATIFIED_H
#include "Common/Shared/Sampler/PixelSampler.h"

RT_SHARED_BEGIN

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

RT_FN uvec2 stratifiedWords(RT_IN(Sampler) s, uint dimension) {
    uint cells = s.strataX * s.strataY;
    uint round = s.index / cells;
    uint cell = permute(s.index % cells, cells, hash3(uvec3(s.key, round, dimension)).z);
    uvec3 h = hash3(uvec3(s.key, s.index, dimension));
    // In integers, which are the same on every device.
    return uvec2(cell % s.strataX * (0xffffffffu / s.strataX) + h.x / s.strataX,
                 cell / s.strataX * (0xffffffffu / s.strataY) + h.y / s.strataY);
}

RT_SHARED_END

#endif
