#include "Common/App/Interactive/PicturePublisher.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "Common/App/Interactive/Draft.h"
#include "Common/Image/FilmRows.h"
#include "Common/Render/FilmEstimate.h"
#include "Common/Render/RenderParams.h"

namespace rt::app {
namespace {

constexpr double kShowShare = 0.2;    // of the session's time, at most, goes into pictures
constexpr double kPictureShare = 0.1; // of a film's age passes between two pictures:
constexpr double kMinInterval = 0.04; // they cost the render a little, and differ the less the older it is
constexpr double kMaxInterval = 0.25;
constexpr double kEarlySeconds = 2;       // after which a film's pictures have the number of samples that is asked for
constexpr double kLongFrameSeconds = 0.5; // after which a frame is shown while it is being rendered
// Drawing one picture by software takes as long as 30 ms of rendering on one core: few pictures of a film, and soon
// only one a second, when they differ less.
constexpr double kSoftShare = 0.6, kMinSoftInterval = 0.3, kMaxSoftInterval = 1;
constexpr double kMinSlice = 0.02;       // of one call of the engine, at whose end its threads wait for each other
constexpr double kFeatureSeconds = 0.15; // that a view of albedo, depth, cost may take
constexpr double kFirstHitsPerPath = 6;  // that take as long as tracing a path, at least
constexpr double kRefineSeconds = 0.04;  // that a few rows of such a view may take at a time
constexpr double kRestSeconds = 0.3;     // after which a camera rests
constexpr std::uint32_t kMaxPreviewSide = 4096; // pixels that every device draws; larger images are enlarged

// Seconds from one picture of a film of that age to the next, at least.
double minInterval(double age) {
    return std::clamp(kPictureShare * age, kMinInterval, kMaxInterval);
}

bool showsFeatures(ViewMode mode) {
    return aovsFor(mode).any() || mode == ViewMode::Heat;
}

std::uint32_t samplesInFiles(const FilmRun& film) {
    return std::min(kAovSamples, film.settings().spp);
}

void copyRows(const image::Image& rows, std::uint32_t first, image::Image& all) {
    if (!rows.data.empty()) std::copy(rows.data.begin(), rows.data.end(), all.pixel(0, first));
}

void put(const std::shared_ptr<const ViewImage>& view, Picture& picture) {
    picture.image = {view, &view->image};
    picture.legend = view->legend;
    picture.values = {view, &view->values};
    picture.isDisplay = true;
}

void put(Picture picture, SessionState& state) {
    picture.serial = state.picture.serial + 1;
    picture.sceneEdits = state.sceneEdits;
    state.picture = std::move(picture);
}

} // namespace

void PicturePublisher::awaitPicture(const std::optional<Stopwatch>& changed) {
    if (!awaited_) awaited_ = changed;
}

void PicturePublisher::recordLatency() {
    if (!awaited_) return;
    const double seconds = awaited_->seconds();
    awaited_.reset();
    state_.update([seconds](SessionState& state) { state.slowestAnswer = std::max(state.slowestAnswer, seconds); });
}

bool PicturePublisher::setView(const ViewRequest& view) {
    if (view == view_) return false;
    view_ = view;
    discardViews();
    return true;
}

void PicturePublisher::discardViews() {
    featureView_ = nullptr;
    featureIsFull_ = false;
    features_ = {};
    fineRows_ = 0;
}

void PicturePublisher::begin(Engine& engine) {
    shownSamples_ = 0;
    sinceBegin_ = {};
    denoised_ = nullptr;
    told_ = {};
    rawEstimate_.reset();
    denoisedError_.reset();
    filter_.begin(engine);
}

void PicturePublisher::showDraft(const FilmRun& draft, const RenderSettings& film) {
    Picture picture;
    picture.camera = draft.camera();
    const PictureFilter::Pointer denoised = isFiltered() ? filter_.filterDraft(draft) : nullptr;
    picture.isDenoised = picture.isLive = isDraftDenoised_ = denoised != nullptr;
    draft_ = denoised ? denoised->images.picture : draft.engine().snapshot().radiance;
    picture.image = picture.radiance = picture.subject =
        std::make_shared<image::Image>(enlarge(draft_, film.width, film.height));
    if (showsFeatures(view_.mode)) {
        AovImages features;
        ViewImage view = featureView(draft.engine(), 1, features);
        if (!view.image.data.empty()) {
            view.image = enlarge(view.image, film.width, film.height);
            featureView_ = std::make_shared<ViewImage>(std::move(view));
            put(featureView_, picture);
        }
    }
    state_.update([&](SessionState& state) { put(std::move(picture), state); });
    recordLatency();
}

void PicturePublisher::show(const FilmRun& film, FilmReference& reference, const RenderSpeed& speed, Haste haste) {
    if (film.status().samplesDone == 0 && !hasDraft()) return;
    const Stopwatch watch;
    Engine& engine = film.engine();
    const ViewPointer viewBefore = featureView_;
    Snapshot snapshot = engine.snapshot();
    auto radiance = std::make_shared<image::Image>(std::move(snapshot.radiance));
    Picture picture;
    picture.camera = film.camera();
    picture.spp = snapshot.minSamples();
    if (picture.spp > 0 && isAdaptive(film.settings())) picture.spp = film.status().samplesDone / film.pixels();
    if (picture.spp == 0 && hasDraft()) showDraftAround(snapshot.tileSamples, *radiance, picture);
    if (picture.spp > 0) reference.follow(film, *radiance);
    picture.image = picture.radiance = std::move(radiance);
    if (picture.spp > 0) denoise(film, haste, picture);
    picture.subject = picture.image;
    if (const ViewPointer view = viewOf(film, picture, reference, speed)) put(view, picture);
    if (view_.inspect) {
        picture.samples = std::make_shared<image::Image>(engine.film().sampleCounts());
        if (hasVariance(engine.film()))
            picture.variance = std::make_shared<image::Image>(engine.film().varianceOfMean());
    }
    const double seconds = watch.seconds();
    publish(film, reference, std::move(picture));
    // A view that was made now does not come again, and final denoised pictures have a share of their own.
    if (featureView_ == viewBefore && !filter_.hasMadeFinal()) showSeconds_ = seconds;
    shownSamples_ = film.status().samplesDone;
    sinceShown_ = {};
}

bool PicturePublisher::isFiltered() const {
    return view_.denoise && !showsFeatures(view_.mode) && view_.mode != ViewMode::Noise;
}

// A denoised draft is better to look at than a few tiles of noise in it.
void PicturePublisher::showDraftAround(std::span<const std::uint64_t> tileSamples, image::Image& radiance,
                                       Picture& picture) {
    picture.isDenoised = picture.isLive = isDraftDenoised_ && view_.denoise;
    if (picture.isDenoised)
        radiance = enlarge(draft_, radiance.width, radiance.height);
    else
        fillFromDraft(radiance, tileSamples, draft_);
}

// In place of the radiance, also a half of it.
void PicturePublisher::denoise(const FilmRun& film, Haste haste, Picture& picture) {
    denoised_ = isFiltered() ? filter_.update(film, haste, wantsDetails()) : view_.denoise ? filter_.last() : nullptr;
    picture.isDenoised = denoised_ != nullptr;
    picture.isLive = denoised_ && denoised_->quality == DenoiseQuality::Live;
    if (denoised_) picture.image = {denoised_, &denoised_->images.picture};
    if (view_.mode != ViewMode::HalfA && view_.mode != ViewMode::HalfB) return;
    const bool isA = view_.mode == ViewMode::HalfA;
    const image::Image* half = !denoised_ ? nullptr : isA ? &denoised_->images.halfA : &denoised_->images.halfB;
    if (half != nullptr && !half->data.empty())
        picture.image = {denoised_, half};
    else if (!view_.denoise && film.settings().replicates % kHalves == 0)
        picture.image = std::make_shared<image::Image>(toImage(halfRows(film.engine().film(), isA ? 0 : 1)));
}

// The errors of the raw picture and of the denoised one: against the reference, or estimated when that is of use.
void PicturePublisher::publish(const FilmRun& film, const FilmReference& reference, Picture picture) {
    const EngineReport report = film.report();
    const bool isFinal = denoised_ && denoised_->quality == DenoiseQuality::Final;
    const Told now{denoised_, reference.fits() ? reference.shared() : nullptr};
    const bool isNew = std::exchange(told_, now) != now;
    std::optional<double> relmse = rawEstimate_, denoised = denoisedError_;
    if (isNew) denoised.reset();
    if (isNew && denoised_ && picture.spp > 0) {
        if (const auto measured = reference.compare(denoised_->images.picture))
            denoised = measured->relmse;
        else if (isFinal)
            denoised = denoised_->images.relmse.value;
    }
    if (!reference.curve().empty()) {
        relmse = reference.curve().back().relmse;
    } else if (film.status().finished || (isNew && isFinal)) {
        const auto estimated = estimateRelMse(film.engine().film(), dependentSide(report.features));
        relmse = estimated ? std::optional(estimated->value) : std::nullopt;
    } else if (isNew) {
        relmse.reset();
    }
    rawEstimate_ = relmse;
    denoisedError_ = denoised;
    state_.update([&](SessionState& state) {
        put(std::move(picture), state);
        state.status = film.status();
        state.renderSeconds = state.seconds.render = film.seconds();
        state.report = report;
        state.relmse = relmse;
        state.denoisedRelmse = denoised;
        state.denoiseSeconds = denoised_ ? denoised_->seconds : 0;
        state.curve = reference.curve();
    });
    recordLatency();
}

ViewImage PicturePublisher::featureView(Engine& engine, std::uint32_t spp, AovImages& features) const {
    if (view_.mode != ViewMode::Heat) {
        features = engine.renderAovs(aovsFor(view_.mode), spp);
        return showFeatures(view_.mode, features);
    }
    const Cost cost = engine.knowsCost(view_.cost) ? view_.cost : Cost::Rays;
    return showCost(cost, engine.renderCost(cost, spp), view_.scale);
}

std::uint32_t PicturePublisher::featureRows() const {
    return std::max({features_.albedo.height, features_.normal.height, features_.depth.height});
}

void PicturePublisher::refine(const FilmRun& film) {
    AovRequest request = aovsFor(view_.mode);
    request.firstRow = fineRows_;
    request.rows = std::min(rowsAtATime_, featureRows() - fineRows_);
    const Stopwatch watch;
    const AovImages rows = film.engine().renderAovs(request, samplesInFiles(film));
    const double fitting = request.rows * kRefineSeconds / std::max(watch.seconds(), 1e-6);
    rowsAtATime_ = static_cast<std::uint32_t>(std::clamp(fitting, 1.0, 2.0 * request.rows));
    copyRows(rows.albedo, fineRows_, features_.albedo);
    copyRows(rows.normal, fineRows_, features_.normal);
    copyRows(rows.depth, fineRows_, features_.depth);
    fineRows_ += request.rows;
    if (!isRefining()) featureView_ = std::make_shared<ViewImage>(showFeatures(view_.mode, features_));
}

// None where it is the radiance that is to be shown.
PicturePublisher::ViewPointer PicturePublisher::viewOf(const FilmRun& film, const Picture& picture,
                                                       const FilmReference& reference, const RenderSpeed& speed) {
    if (showsFeatures(view_.mode)) {
        // In full resolution once the camera rests.
        if (featureView_ && (featureIsFull_ || sinceBegin_.seconds() < kRestSeconds)) return featureView_;
        const bool isCost = view_.mode == ViewMode::Heat;
        const std::uint32_t spp = speed.sppIn(isCost ? kFeatureSeconds : kFirstHitsPerPath * kFeatureSeconds,
                                              film.settings(), isCost ? kAovSamples : samplesInFiles(film));
        ViewImage view = featureView(film.engine(), spp, features_);
        fineRows_ = spp < samplesInFiles(film) ? 0 : featureRows();
        rowsAtATime_ = 1;
        if (view.image.data.empty()) return nullptr;
        featureIsFull_ = true;
        return featureView_ = std::make_shared<ViewImage>(std::move(view));
    }
    if (view_.mode == ViewMode::Noise && hasVariance(film.engine().film()))
        return std::make_shared<ViewImage>(showNoise(film.engine().film(), view_.scale));
    if (view_.mode == ViewMode::Error && reference.fits() && picture.spp > 0)
        return std::make_shared<ViewImage>(showError(*picture.subject, reference.image(), view_.scale));
    const bool hasDetails = denoised_ && !denoised_->images.error.data.empty();
    if (view_.mode == ViewMode::DenoisedError && hasDetails)
        return std::make_shared<ViewImage>(showDenoisedError(denoised_->images, view_.scale));
    if (view_.mode == ViewMode::Bandwidth && hasDetails)
        return std::make_shared<ViewImage>(showBandwidth(denoised_->images));
    return nullptr;
}

// Seconds from one picture of a film to the next, at most.
double PicturePublisher::interval(const RenderRequest& request) const {
    if (!request.accumulate) return kLongFrameSeconds;
    const double age = sinceBegin_.seconds();
    if (drawnBySoftware_ && shownSamples_ > 0) // the first picture does not wait
        return std::clamp(kSoftShare * age, kMinSoftInterval, kMaxSoftInterval);
    if (request.samplesPerFrame > 0 && age >= kEarlySeconds) return kLongFrameSeconds;
    return minInterval(age);
}

double PicturePublisher::secondsUntilDue(const RenderRequest& request) const {
    return std::max(interval(request) - sinceShown_.seconds(), kMinSlice);
}

bool PicturePublisher::isDue(const FilmRun& film, const RenderRequest& request) const {
    const double seconds = sinceShown_.seconds();
    if (seconds <= showSeconds_ / kShowShare) return false;
    if (seconds > interval(request)) return true;
    if (!request.accumulate || drawnBySoftware_) return false;
    return seconds > minInterval(sinceBegin_.seconds()) &&
           film.status().samplesDone - shownSamples_ >= request.samplesPerFrame * film.pixels();
}

// What no device draws is enlarged.
Preview drawPreview(Engine& engine, const scene::CameraDesc& camera, const RenderSettings& size, std::uint32_t width) {
    const double ratio = static_cast<double>(size.height) / size.width;
    const std::uint32_t height = std::max(1u, static_cast<std::uint32_t>(std::lround(ratio * width)));
    const double scale = std::min(1.0, static_cast<double>(kMaxPreviewSide) / std::max(width, height));
    const auto scaled = [scale](std::uint32_t side) { return std::max(1u, static_cast<std::uint32_t>(side * scale)); };
    Preview preview = engine.renderPreview(camera, scaled(width), scaled(height));
    if (scale < 1) {
        preview.picture = enlarge(preview.picture, width, height);
        preview.depth = enlarge(preview.depth, width, height);
    }
    return preview;
}

void PicturePublisher::showPreview(Engine& engine, const scene::CameraDesc& camera, const RenderSettings& size,
                                   std::uint32_t width) {
    preview_ = drawPreview(engine, camera, size, width);
    Picture picture;
    picture.camera = camera;
    picture.image = picture.radiance = picture.subject = std::make_shared<image::Image>(preview_.picture);
    picture.isPreview = true;
    const EngineReport report = engine.report();
    state_.update([&](SessionState& state) {
        put(std::move(picture), state);
        state.report = report;
    });
    recordLatency();
}

void PicturePublisher::showOfRace(Picture picture, const image::Image* reference) {
    picture.isOfRace = true;
    if (view_.mode == ViewMode::Error && reference != nullptr)
        put(std::make_shared<ViewImage>(showError(*picture.subject, *reference, view_.scale)), picture);
    state_.update([&](SessionState& state) { put(std::move(picture), state); });
}

std::optional<double> focusDistance(const image::Image& depth, std::uint32_t x, std::uint32_t y, double verticalFov) {
    if (x >= depth.width || y >= depth.height || !(*depth.pixel(x, y) > 0)) return std::nullopt;
    const double half = std::tan(0.5 * verticalFov * 0.017453292519943295);
    const double up = half * ((y + 0.5) / depth.height * 2 - 1);
    const double right = half * ((x + 0.5) / depth.width * 2 - 1) * depth.width / depth.height;
    return *depth.pixel(x, y) / std::sqrt(1 + up * up + right * right);
}

} // namespace rt::app
