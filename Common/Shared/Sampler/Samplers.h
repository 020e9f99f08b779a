// The table of samplers, and what all have in common. From a row follow the constant kSampler<Name>, the flag's values,
// windows, statistics, checkpoints, the benchmark's axis, and the tests that hold for every sampler.
//
// SAMPLER(Name, number, begin, words, name on the command line, title in windows, what it does): its header defines
//     Sampler begin(params, pixel, replicate, index)    of a sample; or pixelSampler
//     uvec2 words(sampler, dimension)                   as sampleWords
// The first is the default; numbers go into checkpoints.
#ifndef RT_SHARED_SAMPLERS_H
#define RT_SHARED_SAMPLERS_H
#include "Common/Shared/Sampler/Independent.h"
#include "Common/Shared/Sampler/SobolBlue.h"
#include "Common/Shared/Sampler/Stratified.h"

// clang-format off
#define RT_SAMPLERS(SAMPLER) \
    SAMPLER(Sobol, 2u, pixelSampler, sobolWords, "sobol", "Sobol (Owen-scrambled)", "well spread in many dimensions") \
    SAMPLER(SobolBlue, 3u, sobolBlueSampler, sobolWords, "sobol-blue", "Sobol, blue noise", \
            "one sequence for all pixels, so that noise is finer") \
    SAMPLER(Stratified, 1u, pixelSampler, stratifiedWords, "stratified", "Stratified", "one in each cell of a grid") \
    SAMPLER(Independent, 0u, pixelSampler, independentWords, "independent", "Independent (random)", "each on its own")
// clang-format on

RT_SHARED_BEGIN

#define RT_SAMPLER(Name, number, begin, words, name, title, help) const uint kSampler##Name = number;
RT_SAMPLERS(RT_SAMPLER)
#undef RT_SAMPLER

RT_FN Sampler makeSampler(RT_IN(RenderParams) params, uint pixel, uint replicate, uint index) {
#define RT_BEGIN(Name, number, begin, words, name, title, help) \
    if (params.samplerKind == number) return begin(params, pixel, replicate, index);
    RT_SAMPLERS(RT_BEGIN)
#undef RT_BEGIN
    return pixelSampler(params, pixel, replicate, index);
}

// The two words of a dimension; each is uniform over all words, and the point is stratified over the samples of the
// pixel as the sampler says.
RT_CALL uvec2 sampleWords(RT_IN(Sampler) s, uint dimension) {
#define RT_WORDS(Name, number, begin, words, name, title, help) \
    if (s.kind == number) return words(s, dimension);
    RT_SAMPLERS(RT_WORDS)
#undef RT_WORDS
    return uvec2(0u, 0u);
}

RT_FN vec2 sample2D(RT_IN(Sampler) s, uint dimension) {
    return toUniform2(sampleWords(s, dimension));
}

// First coordinate of a dimension, in [0,1), fine near 0.
RT_FN float sampleFine(RT_IN(Sampler) s, uint dimension) {
    uint high = sampleWords(s, dimension).x;
    return toFineUniform(high, hash3(uvec3(s.key ^ 0x9e3779b9u, s.base + s.index, dimension)).x);
}

RT_SHARED_END

#endif
