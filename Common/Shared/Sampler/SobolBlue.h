// Sobol's sequence with errors that are blue noise over the image.
#ifndef RT_SHARED_SOBOL_BLUE_H
#define RT_SHARED_SOBOL_BLUE_H
#include "Common/Shared/Sampler/Sobol.h"

RT_SHARED_BEGIN

// Bits of x at even places.
RT_FN uint spreadBits(uint x) {
    x = (x | x << 8u) & 0x00ff00ffu;
    x = (x | x << 4u) & 0x0f0f0f0fu;
    x = (x | x << 2u) & 0x33333333u;
    return (x | x << 1u) & 0x55555555u;
}

// All pixels share one sequence, in the order of a Z curve, and the scrambling of its index, which is nested, shuffles
// quadrants at every level. What 2^k pixels of a square take together is stratified like the samples of one, so errors
// of neighbours cancel, and errors turn into blue noise (Ahmed & Wonka, "Screen-Space Blue-Noise Diffusion of Monte
// Carlo Sampling Error via Hierarchical Ordering of Pixels", 2020). A pixel takes 2^strataX samples in a row; those
// beyond are of another, independent round.
RT_FN Sampler sobolBlueSampler(RT_IN(RenderParams) params, uint pixel, uint replicate, uint index) {
    uint round = index >> params.strataX;
    uint order = spreadBits(pixel % params.width) | spreadBits(pixel / params.width) << 1u;
    Sampler s = pixelSampler(params, pixel, replicate, index);
    s.key = hash3(uvec3(0x9e3779b9u ^ round, params.seed, replicate)).z;
    s.base = (order - round) << params.strataX;
    return s;
}

RT_SHARED_END

#endif
