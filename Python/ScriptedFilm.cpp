#include "Python/ScriptedFilm.h"

#include <algorithm>
#include <utility>

#include "Common/App/Session/ImagePart.h"
#include "Common/App/Session/Outputs.h"
#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Core/Log.h"
#include "Common/Image/FilmRows.h"
#include "Common/Image/ImageRows.h"
#include "Python/Engines.h"

namespace rt::python {

ScriptedFilm::ScriptedFilm(const std::shared_ptr<Scene>& scene, app::Options options) : job_(std::move(options)) {
    setUpLog({"raytracing", job_.options().quiet, job_.options().verbose, job_.options().logFile});
    app::checkOutputs(job_.options());
    job_.take(scene->compiled(), scene->seconds());
    if (!job_.begin(makeEngine(job_.options()), cancel_)) throw Interrupted();
    width_ = job_.options().settings.width;
    height_ = job_.options().settings.height;
    checkpointFile_ = job_.options().checkpoint;
}

std::optional<app::StopReason> ScriptedFilm::advance(double seconds) {
    const std::scoped_lock lock(mutex_);
    if (ended_ && *ended_ != app::StopReason::Interrupted) return ended_;
    ended_ = job_.slice(seconds, cancel_);
    return ended_;
}

void ScriptedFilm::write() {
    const std::scoped_lock lock(mutex_);
    const std::atomic<bool> byNobody{false};
    job_.write(byNobody);
}

void ScriptedFilm::save(const std::string& checkpoint) {
    const std::scoped_lock lock(mutex_);
    const std::atomic<bool> byNobody{false};
    job_.save(checkpoint, byNobody);
}

std::string ScriptedFilm::statistics() {
    const std::scoped_lock lock(mutex_);
    return job_.statisticsJson();
}

app::ProgressState ScriptedFilm::progress() {
    const std::scoped_lock lock(mutex_);
    return job_.run().progress();
}

const image::Film& ScriptedFilm::film() {
    std::string lost;
    const image::Film& film = job_.run().keptFilm(lost);
    if (!lost.empty()) logWarning(lost);
    return film;
}

image::Image ScriptedFilm::image() {
    const std::scoped_lock lock(mutex_);
    const auto& region = job_.options().region;
    if (!region) return film().resolve();
    return image::toImage(app::withinRegion(image::meanRows(film()), region));
}

image::Image ScriptedFilm::aov(app::Aov aov) {
    const std::scoped_lock lock(mutex_);
    if (aov == app::Aov::Samples) return film().sampleCounts();
    if (aov == app::Aov::Denoised || aov == app::Aov::DenoisedError) return denoised(aov);
    if (aov != app::Aov::Variance) return feature(aov);
    if (!film().desc().secondMoments && film().desc().replicates < 2)
        throw InputError("the film has neither second moments nor replicates: its variance is not known");
    return film().varianceOfMean();
}

image::Image ScriptedFilm::denoised(app::Aov aov) {
    if (aov == app::Aov::DenoisedError && !job_.options().wants(aov))
        throw UsageError("--aov denoised-error: is to be asked for before the render");
    image::Denoised denoised = job_.denoiser().denoise(film());
    return std::move(aov == app::Aov::Denoised ? denoised.picture : denoised.error);
}

image::Image ScriptedFilm::feature(app::Aov aov) {
    const auto is = [aov](app::Aov other) { return aov == other; };
    app::AovRequest request{{is(app::Aov::Albedo), is(app::Aov::Normal), is(app::Aov::Depth)}};
    request.wide = {is(app::Aov::WideAlbedo), is(app::Aov::WideNormal), is(app::Aov::WideDepth)};
    request.emission = is(app::Aov::Emission);
    app::AovImages images = job_.engine().renderAovs(request, std::min(app::kAovSamples, job_.options().settings.spp));
    for (image::Image* image : {&images.albedo, &images.normal, &images.depth, &images.wide.albedo, &images.wide.normal,
                                &images.wide.depth, &images.emission})
        if (!image->data.empty()) return image::toImage(app::withinRegion(*image, job_.options().region));
    return {};
}

} // namespace rt::python
