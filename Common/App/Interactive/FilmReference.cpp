#include "Common/App/Interactive/FilmReference.h"

#include <utility>

namespace rt::app {

RenderedReference referenceOf(const image::Film& film) {
    RenderedReference made{film.resolve()};
    if (film.minReplicateSamples() > 0) made.error = image::referenceRelMse(made.image, film.varianceOfMean());
    return made;
}

void FilmReference::begin(const ReferenceKey& film) {
    filmKey_ = film;
    curve_.clear();
}

void FilmReference::set(image::Image image, double error) {
    image_ = std::make_shared<const image::Image>(std::move(image));
    error_ = error;
    key_ = filmKey_;
    curve_.clear();
}

std::optional<image::ErrorFigures> FilmReference::compare(const image::Image& picture) const {
    if (!fits()) return std::nullopt;
    return image::compare(picture, *image_);
}

void FilmReference::follow(const FilmRun& film, const image::Image& picture) {
    if (!fits()) return;
    const double seconds = film.seconds();
    const double last = curve_.empty() ? 0 : curve_.back().seconds;
    if (seconds <= last || (!film.status().finished && seconds < 1.1 * last)) return;
    const double spp = static_cast<double>(film.status().samplesDone) / static_cast<double>(film.pixels());
    curve_.push_back({seconds, spp, image::compare(picture, *image_).relmse});
}

} // namespace rt::app
