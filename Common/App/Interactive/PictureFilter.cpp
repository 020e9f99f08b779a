#include "Common/App/Interactive/PictureFilter.h"

#include <exception>
#include <utility>

#include "Common/App/Interactive/FilmPlan.h"

namespace rt::app {
namespace {

constexpr double kFinalAfter = 0.15;     // seconds of a film's age: a camera that moves has a new one before that
constexpr double kFinalShare = 0.2;      // of the session's time, at most, that goes into final pictures
constexpr double kFinalGrowth = 1.25;    // of samples, from one to the next
constexpr double kMaxLiveSeconds = 0.15; // that a live picture may take
constexpr double kLearning = 0.5;
constexpr std::uint32_t kEarlyAovSamples = 2; // of features, for a film of fewer samples than their files have

} // namespace

void PictureFilter::begin(Engine& engine) {
    end();
    if (!hasFailed_) denoiser_ = engine.makeDenoiser();
    if (denoiser_) isQuick_ = denoiser_->isQuick();
    sinceBegin_ = {};
}

void PictureFilter::end() {
    denoiser_.reset();
    last_.reset();
    refusedSamples_.reset();
    samples_ = 0;
    hasDetails_ = hasMadeFinal_ = false;
}

void PictureFilter::forget() {
    end();
    hasFailed_ = false;
}

PictureFilter::Pointer PictureFilter::filterDraft(const FilmRun& draft) {
    static const std::atomic<bool> isNever{false};
    begin(draft.engine());
    if (denoiser_ && isQuick_ && hasWhatLiveNeeds(draft)) make(draft, DenoiseQuality::Live, false, isNever);
    Pointer made = last_;
    end();
    return made;
}

bool PictureFilter::hasWhatLiveNeeds(const FilmRun& film) const {
    return film.settings().replicates >= kHalves || (film.settings().spp < kHalves && !denoiser_->needsHalves());
}

bool PictureFilter::canFilter(const FilmRun& film) const {
    const std::uint64_t samples = film.status().samplesDone;
    return denoiser_ && hasWhatLiveNeeds(film) && samples > 0 && refusedSamples_ != samples;
}

PictureFilter::Pointer PictureFilter::update(const FilmRun& film, Haste haste, bool wantsDetails) {
    hasMadeFinal_ = false;
    if (!canFilter(film)) return last_;
    if (isFinalDue(film, haste, wantsDetails))
        make(film, DenoiseQuality::Final, wantsDetails, cancel_);
    else if (isLiveQuick(film) && !isFinal() && film.status().samplesDone != samples_)
        make(film, DenoiseQuality::Live, false, cancel_);
    return last_;
}

bool PictureFilter::canImprove(const FilmRun& film, bool wantsDetails) const {
    if (!canFilter(film) || film.settings().replicates < kHalves) return false;
    return !isFinal() || film.status().samplesDone != samples_ || (wantsDetails && !hasDetails_);
}

bool PictureFilter::isLiveQuick(const FilmRun& film) const {
    return isQuick_ && static_cast<double>(film.pixels()) * liveSecondsPerPixel_ <= kMaxLiveSeconds;
}

// A live picture comes first. A film that converges is filtered again when that is worth it, and keeps its last final
// picture in between: live ones would be worse.
bool PictureFilter::isFinalDue(const FilmRun& film, Haste haste, bool wantsDetails) const {
    if (haste == Haste::AtOnce || !canImprove(film, wantsDetails)) return false;
    if (haste == Haste::AtRest || !isQuick_) return haste == Haste::AtRest;
    if (!last_ && isLiveQuick(film)) return false;
    if (!isFinal() || (wantsDetails && !hasDetails_)) return sinceBegin_.seconds() >= kFinalAfter;
    return static_cast<double>(film.status().samplesDone) >= kFinalGrowth * static_cast<double>(samples_) &&
           sinceFinal_.seconds() >= last_->seconds / kFinalShare;
}

void PictureFilter::make(const FilmRun& film, DenoiseQuality quality, bool wantsDetails,
                         const std::atomic<bool>& cancel) {
    const std::uint64_t samples = film.status().samplesDone;
    // Of few samples the noise of features is none of the picture's worries, and someone waits.
    const bool isEarly = samples < film.pixels() * kAovSamples && !film.status().finished;
    const DenoiseRequest request{quality, wantsDetails,
                                 quality == DenoiseQuality::Live ? 1
                                 : isEarly                       ? kEarlyAovSamples
                                                                 : kAovSamples};
    try {
        std::optional<DenoisedPicture> made = denoiser_->denoise(request, cancel);
        if (!made) {
            if (!cancel) refusedSamples_ = samples;
            return;
        }
        if (quality == DenoiseQuality::Live)
            liveSecondsPerPixel_ =
                (1 - kLearning) * liveSecondsPerPixel_ + kLearning * made->seconds / static_cast<double>(film.pixels());
        hasMadeFinal_ = quality == DenoiseQuality::Final;
        hasDetails_ = wantsDetails;
        samples_ = samples;
        last_ = std::make_shared<const DenoisedPicture>(std::move(*made));
        if (hasMadeFinal_) sinceFinal_ = {};
    } catch (...) { // the render itself is well, or says itself what ails it
        state_.fail(std::current_exception());
        hasFailed_ = true;
        end();
    }
}

} // namespace rt::app
