#include "Common/App/Session/DenoiseFilm.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "Common/App/Session/OpenImageDenoise.h"
#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Image/Denoise/FilmHalves.h"
#include "Common/Render/Stopwatch.h"

namespace rt::app {
namespace {

image::Image cropped(const image::Image& image, const Region& region) {
    image::Image part(region.width, region.height, image.channels);
    for (std::uint32_t y = 0; y < part.height; ++y)
        std::copy_n(image.pixel(region.x, region.y + y), std::size_t{part.width} * part.channels, part.pixel(0, y));
    return part;
}

image::DenoiseInput cropped(const image::DenoiseInput& input, const Options& options) {
    image::DenoiseInput part;
    part.samplesOfHalf = options.settings.spp / 2; // those outside have none
    for (const auto member : {&image::DenoiseInput::halfA, &image::DenoiseInput::halfB, &image::DenoiseInput::albedo,
                              &image::DenoiseInput::normal, &image::DenoiseInput::depth})
        part.*member = cropped(input.*member, *options.region);
    return part;
}

image::Image placed(const image::Image& part, const Region& region, std::uint32_t width, std::uint32_t height) {
    image::Image image(width, height, part.channels);
    for (std::uint32_t y = 0; y < part.height; ++y)
        std::copy_n(part.pixel(0, y), std::size_t{part.width} * part.channels, image.pixel(region.x, region.y + y));
    return image;
}

} // namespace

// Also where the render itself has fewer samples: they cost little, and noise in features is noise in the picture.
void FilmDenoiser::renderFeatures() {
    if (features_) return;
    AovRequest request{{true, true, true}};
    request.isAdaptive = !options_.denoisesByOidn; // which gets what files have
    features_ = engine_.renderAovs(request, kAovSamples);
}

image::Denoised FilmDenoiser::denoiseByLibrary(const image::Film& film) {
    const Stopwatch watch;
    renderFeatures();
    image::Image radiance = film.resolve(), albedo = features_->albedo, normal = features_->normal;
    if (options_.region)
        for (image::Image* image : {&radiance, &albedo, &normal}) *image = cropped(*image, *options_.region);
    const OpenImageDenoise library;
    image::Denoised images;
    images.picture = library.filter(std::move(radiance), std::move(albedo), std::move(normal));
    if (options_.region)
        images.picture = placed(images.picture, *options_.region, film.desc().width, film.desc().height);
    figures_ = {};
    figures_.seconds = watch.seconds();
    figures_.library = library.name();
    return images;
}

DenoisedPicture FilmDenoiser::filter(image::DenoiseInput& input) {
    const bool details = options_.wants(Aov::DenoisedError);
    if (!options_.region)
        if (auto made = engine_.denoiseWhole(input, details)) return std::move(*made);
    renderFeatures();
    // Lent, not copied: fresh memory takes longer than to fill it.
    std::tie(input.albedo, input.normal, input.depth) =
        std::tuple(std::move(features_->albedo), std::move(features_->normal), std::move(features_->depth));
    features_.reset();
    std::optional<image::DenoiseInput> part;
    if (options_.region) part = cropped(input, options_);
    DenoisedPicture result = engine_.denoiseHalves(part ? *part : input, details, options_.threads);
    features_.emplace();
    std::tie(features_->albedo, features_->normal, features_->depth) =
        std::tuple(std::move(input.albedo), std::move(input.normal), std::move(input.depth));
    return result;
}

image::Denoised FilmDenoiser::denoise(const image::Film& film) {
    if (const std::string why = image::whyNoHalves(film); !why.empty()) throw InputError("the film " + why);
    const Stopwatch watch;
    const Interruptible byNobody(nullptr); // of a render that was stopped, too, what there is is filtered
    if (options_.denoisesByOidn) return denoiseByLibrary(film);
    image::DenoiseInput input = image::filmHalves(film, options_.threads);
    DenoisedPicture filtered = filter(input);
    image::Denoised& images = filtered.images;
    if (options_.region)
        for (image::Image* image : {&images.picture, &images.halfA, &images.halfB, &images.error, &images.bandwidth})
            if (!image->data.empty()) *image = placed(*image, *options_.region, film.desc().width, film.desc().height);
    figures_ = {images.relmse, watch.seconds(), images.shares, filtered.device, filtered.passes};
    return std::move(images);
}

} // namespace rt::app
