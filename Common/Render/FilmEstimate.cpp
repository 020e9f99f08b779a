#include "Common/Render/FilmEstimate.h"

#include "Common/Image/FilmRows.h"
#include "Common/Image/Metrics.h"

namespace rt::app {

bool hasVariance(const image::Film& film) {
    if (film.desc().replicates >= 2) return film.minReplicateSamples() >= 1;
    return film.desc().secondMoments && film.minSamples() > image::Film::kBlock;
}

std::optional<image::RelMseEstimate> estimateRelMse(const image::Film& film, std::uint32_t dependentSide) {
    if (!hasVariance(film)) return std::nullopt;
    return image::estimateRelMse(image::meanRows(film), image::varianceRows(film), dependentSide);
}

FilmEstimate estimate(const image::Film& film, std::uint32_t dependentSide) {
    FilmEstimate result;
    result.meanRadiance = image::channelMeans(image::meanRows(film));
    if (hasVariance(film)) {
        result.standardError = image::standardErrors(image::varianceRows(film));
        for (double& error : *result.standardError) error *= dependentSide;
    }
    result.relmse = estimateRelMse(film, dependentSide);
    return result;
}

} // namespace rt::app
