#include "Common/App/Session/FilmEstimate.h"

#include "Common/Image/Metrics.h"

namespace rt::app {

bool hasVariance(const image::Film& film) {
    if (film.desc().replicates >= 2) return film.minReplicateSamples() >= 1;
    return film.desc().secondMoments && film.minSamples() > image::Film::kBlock;
}

FilmEstimate estimate(const image::Film& film) {
    FilmEstimate result;
    const image::Image mean = film.resolve();
    result.meanRadiance = image::channelMeans(mean);
    if (!hasVariance(film)) return result;
    const image::Image variance = film.varianceOfMean();
    result.standardError = image::standardErrors(variance);
    result.relmse = image::estimateRelMse(mean, variance);
    return result;
}

} // namespace rt::app
