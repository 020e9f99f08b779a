#include "Common/App/Interactive/SessionFilm.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "Common/Core/Hash.h"
#include "Common/Core/Interruption.h"
#include "Common/Render/RenderParams.h"

namespace rt::app {
namespace {

constexpr double kMaxFirstSeconds = 0.25; // of a draft or first pass when the next change waits already
constexpr double kPassSlice = 0.005;      // where the picture is shown as soon as it has its first samples

} // namespace

ReferenceKey keyOf(const FilmSubject& subject, const RenderSettings& film) {
    std::uint64_t hash = subject.scene.hash;
    if (const auto shutter = subject.engine.report().shutter) { // of one instant it is another picture
        const double interval[] = {shutter->open, shutter->close};
        hash = hashBytes(std::as_bytes(std::span(interval)), hash);
    }
    return {hash, subject.camera, film.width, film.height, film.maxDepth};
}

SessionFilm::SessionFilm(const SessionSetup& setup, const Mailbox& mailbox, PublishedState& state)
    : publisher(state, setup.drawnBySoftware, mailbox.cancelled(Cancel::Slice)),
      setup_(setup),
      mailbox_(mailbox),
      state_(state) {}

void SessionFilm::change() {
    isStale_ = true;
    round_ = 0;
    reference.giveUp();
}

void SessionFilm::discard() {
    isStale_ = true;
    publisher.forgetEngine();
    run_.reset();
}

void SessionFilm::beginNext() {
    isStale_ = true;
    ++round_;
}

bool SessionFilm::goOn(const FilmSubject& subject) {
    if (isStale_ || !subject.request.accumulate || reference.renderedSpp()) return false;
    RenderSettings wanted = settingsFor(subject);
    const std::uint32_t spp = std::exchange(wanted.spp, run_->settings().spp);
    // Whether the number is known matters to films that are made for it alone.
    const bool isKnown = std::exchange(wanted.sppIsKnown, run_->settings().sppIsKnown);
    if (!subject.request.halves && run_->settings().replicates == kHalves && wanted.replicates == 1) {
        wanted.replicates = kHalves; // that nobody asks for any more, and that do no harm
        wanted.secondMoments = run_->settings().secondMoments;
    }
    if (wanted != run_->settings() || !run_->canTake(spp)) return false;
    wanted.sppIsKnown = isKnown;
    if (isMadeForSpp(wanted) != isMadeForSpp(run_->settings())) return false;
    // The files of features have another number of samples then.
    if (std::min(spp, run_->settings().spp) < kAovSamples && spp != run_->settings().spp) publisher.discardViews();
    if (spp != run_->settings().spp) {
        run_->setSpp(spp);
        publisher.filterAnew(subject.engine);
    }
    // What is left of the time; where it was used up, as much again.
    std::optional<double> seconds = subject.request.timeLimit;
    if (seconds && run_->seconds() < *seconds) *seconds -= run_->seconds();
    run_->limit({.seconds = seconds, .targetError = subject.request.targetError});
    state_.update([&](SessionState& state) {
        state.settings = run_->settings();
        state.status = run_->status();
    });
    return true;
}

bool SessionFilm::hasHalves() const {
    return isStale_ || run_->settings().replicates % 2 == 0 || run_->settings().spp < kHalves;
}

bool SessionFilm::hasFirstSamples() const {
    return !isStale_ && run_->status().samplesDone >= firstPass(run_->settings());
}

void SessionFilm::beginPostponed(const FilmSubject& subject) {
    if (postponed_) begin(subject, *postponed_);
}

std::optional<StopReason> SessionFilm::slice(const FilmSubject& subject) {
    if (isStale_) start(subject);
    if (isStale_) return std::nullopt; // postponed
    const double seconds = run_->seconds();
    const std::uint64_t samples = run_->status().samplesDone;
    const double slice = std::min(setup_.sliceSeconds, publisher.secondsUntilDue(subject.request));
    const auto ended = run_->slice(slice, mailbox_.cancelled(Cancel::Slice));
    if (ended == StopReason::Interrupted) return std::nullopt; // somebody wants something
    if (run_->seconds() - seconds > 0.5 * slice)
        speed_.learn(run_->status().samplesDone - samples, run_->seconds() - seconds, 0.1);
    if (ended && !subject.request.accumulate) // slices of a short frame say too little
        speed_.learn(run_->status().samplesDone, run_->seconds());
    return ended;
}

void SessionFilm::show(Haste haste) {
    if (!isStale_) publisher.show(*run_, reference, speed_, haste);
}

void SessionFilm::showIfDue(const RenderRequest& request) {
    if (!isStale_ && publisher.isDue(*run_, request)) show(Haste::Converging);
}

void SessionFilm::refine() {
    publisher.refine(*run_);
    if (!publisher.isRefining()) show();
}

RenderSettings SessionFilm::settingsFor(const FilmSubject& subject) const {
    RenderSettings settings =
        filmSettings(subject.request, subject.scene, round_, setup_.options.wants(Aov::Variance), speed_);
    if (settings.adaptive && subject.engine.report().shutter) settings.adaptive = false; // poses are of all pixels
    return settings;
}

void SessionFilm::start(const FilmSubject& subject) {
    RenderSettings settings = settingsFor(subject);
    if (const auto spp = reference.renderedSpp()) settings = referenceSettings(keyOf(subject, settings), *spp);

    // Kernels may have to be compiled, a large film takes a while to be had.
    const auto before = run_ ? run_->settings() : postponed_;
    const bool isAnotherSize = before && (settings.width != before->width || settings.height != before->height);
    if (!before && setup_.options.program == kGpuProgram)
        state_.setStage("Compiling shaders");
    else if (!before || isAnotherSize)
        state_.setStage("Allocating memory");
    if (!before) publisher.forgetLatency();
    publisher.discardViews();
    state_.update([&](SessionState& state) { // the progress of the film before is not this one's
        state.settings = settings;
        state.status = {};
        state.status.samplesTotal = std::uint64_t{settings.width} * settings.height * settings.spp;
        state.renderSeconds = 0;
    });
    if (round_ == 0) renderDraft(subject, settings);
    if (publisher.hasDraft() && mailbox_.moveCameraAlone()) {
        state_.setStage("");
        postponed_ = settings;
        return;
    }
    begin(subject, settings);
    if (publisher.hasDraft() || !publisher.isAwaited()) return;
    renderFirst(*run_, kPassSlice, kMaxFirstSeconds);
    show();
}

// Something to look at at once, where the first samples of the whole image would take longer.
void SessionFilm::renderDraft(const FilmSubject& subject, const RenderSettings& settings) {
    publisher.discardDraft();
    auto small = draftSettings(settings, speed_, publisher.denoiseSecondsPerPixel());
    if (!small) return;
    small->seed += ++drafts_; // a denoiser with a history of them gains by noise that is another each time
    run_.reset();
    publisher.endFilter();
    FilmRun draft(subject.engine, subject.camera, *small);
    renderFirst(draft, setup_.sliceSeconds, std::numeric_limits<double>::infinity());
    if (draft.status().finished) publisher.showDraft(draft, settings);
}

// The first samples of all pixels, or what of them `patience` suffices for, in seconds. The next change does not
// interrupt them soon: a camera in motion would never show anything.
void SessionFilm::renderFirst(FilmRun& run, double sliceSeconds, double patience) {
    const auto isTimeLeft = [&] {
        return run.seconds() < (mailbox_.cancelled(Cancel::Slice) ? kMaxFirstSeconds : patience);
    };
    const std::uint64_t wanted = firstPass(run.settings());
    while (!run.slice(sliceSeconds, mailbox_.cancelled(Cancel::FirstPicture)) && isTimeLeft())
        if (run.status().samplesDone >= wanted) break;
    if (run.status().samplesDone > 0) speed_.learn(run.status().samplesDone, run.seconds());
}

// Throws Interrupted where the film is given up before it is there.
void SessionFilm::begin(const FilmSubject& subject, RenderSettings settings) {
    postponed_.reset();
    const Interruptible interruptible(mailbox_.cancelled(Cancel::FirstPicture));
    const ReferenceKey view = keyOf(subject, settings);
    if (reference.renderedSpp()) { // on top of what there is
        image::Film kept = setup_.references.load(view).value_or(image::Film());
        if (kept.totalSamples() > 0)
            settings.spp = std::max(settings.spp, static_cast<std::uint32_t>(kept.maxSamples()));
        run_.emplace(subject.engine, subject.camera, settings, std::move(kept));
    } else {
        run_.emplace(subject.engine, subject.camera, settings);
        run_->limit({.seconds = subject.request.timeLimit, .targetError = subject.request.targetError});
    }
    isStale_ = false;
    run_->watch();
    publisher.begin(subject.engine);
    reference.begin(view);
    findReference();
    const EngineReport report = subject.engine.report();
    state_.update([&](SessionState& state) {
        state.stage.clear();
        state.settings = settings;
        state.status = run_->status();
        state.renderSeconds = 0;
        state.report = report;
        state.isReferenceRender = reference.renderedSpp().has_value();
        state.referenceFits = reference.fits();
        state.relmse.reset();
        state.denoisedRelmse.reset();
        state.curve.clear();
    });
}

// One that was rendered earlier, by whichever program, where there is none for the film's view.
void SessionFilm::findReference() {
    if (reference.renderedSpp() || reference.fits() || !setup_.references.has(reference.film())) return;
    if (const auto film = setup_.references.load(reference.film()); film && film->minSamples() > 0)
        setReference(*film, "found");
}

void SessionFilm::setReference(const image::Film& film, const std::string& how) {
    RenderedReference made = referenceOf(film);
    reference.set(std::move(made.image), made.error);
    publishReference(how + ", " + std::to_string(film.minSamples()) + " spp");
}

void SessionFilm::publishReference(const std::string& name) {
    state_.update([&](SessionState& state) {
        state.reference = name;
        state.referenceImage = reference.shared();
        state.referenceError = reference.error();
        state.referenceFits = reference.fits();
    });
}

} // namespace rt::app
