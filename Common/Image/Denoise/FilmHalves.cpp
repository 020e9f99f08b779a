#include "Common/Image/Denoise/FilmHalves.h"

#include "Common/Image/FilmRows.h"

namespace rt::image {
namespace {

bool hasSamples(const Film& film, std::uint32_t tile, std::uint32_t half) {
    for (std::uint32_t r = half; r < film.desc().replicates; r += 2)
        if (film.samples(tile, r) > 0) return true;
    return false;
}

} // namespace

std::string whyNoHalves(const Film& film) {
    if (film.desc().replicates < 2)
        return "cannot be denoised: replicates is 1, but two halves of independent samples are needed; render with "
               "--denoise, or --replicates 2 or more";
    if (film.totalSamples() == 0) return "cannot be denoised: it has no samples";
    for (std::uint32_t tile = 0; tile < film.tileCount(); ++tile)
        if (hasSamples(film, tile, 0) != hasSamples(film, tile, 1))
            return "cannot be denoised: one half of its samples lacks a part of the picture; render for longer";
    return {};
}

DenoiseInput filmHalves(const Film& film, std::size_t threads) {
    DenoiseInput input;
    input.halfA = toImage(halfRows(film, 0), threads);
    input.halfB = toImage(halfRows(film, 1), threads);
    input.samplesOfHalf = std::uint64_t{film.minReplicateSamples()} * (film.desc().replicates / 2);
    return input;
}

} // namespace rt::image
