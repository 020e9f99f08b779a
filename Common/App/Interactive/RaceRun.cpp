#include "Common/App/Interactive/RaceRun.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "Common/App/Interactive/FilmPlan.h"
#include "Common/App/Interactive/FilmReference.h"
#include "Common/Core/Error.h"
#include "Common/Core/Interruption.h"
#include "Common/Image/Metrics.h"
#include "Common/Render/PictureDenoiser.h"
#include "Common/Render/RenderParams.h"

namespace rt::app {
namespace {

constexpr std::uint32_t kEndlessSpp = 1u << 30; // of a film that ends by time
constexpr double kTurnShare = 0.25;             // of the time that an entrant has had, its next turn takes,
constexpr double kMinTurn = 0.02, kMaxTurn = 0.25;
constexpr double kWarmUpSeconds = 0.1;                // not counted: what drivers compile late, caches
constexpr double kMinRateSeconds = 0.2;               // of sampling, after which a rate is known
constexpr auto kWait = std::chrono::milliseconds(20); // between two looks at the other program

} // namespace

RaceRun::RaceRun(const SessionSetup& setup, const Mailbox& mailbox, RaceCourse course, const RaceRequest& request)
    : setup_(setup),
      mailbox_(mailbox),
      course_(std::move(course)),
      race_(request, setup.options.program == kGpuProgram),
      racers_(request.entrants.size()),
      stage_("Preparing the race") {}

// As the benchmark renders them: seed 0, two halves where a filter needs them.
RenderSettings RaceRun::settingsOf(std::size_t entrant) const {
    const RaceEntrant& wanted = race_.lanes()[entrant].entrant;
    RenderSettings settings = course_.settings;
    const auto take = [](const char*, const char*, const char*, const auto&, auto& mine, const auto& theirs) {
        mine = theirs;
    };
    forEachMethod(take, settings, wanted.settings);
    settings.seed = 0;
    settings.spp = kEndlessSpp;
    settings.sppIsKnown = false;
    settings.secondMoments = false;
    settings.replicates = wanted.isDenoised ? kHalves : 1;
    settleReplicates(settings);
    return settings;
}

ReferenceKey RaceRun::key() const {
    return {course_.scene->hash, course_.camera, course_.settings.width, course_.settings.height,
            course_.settings.maxDepth};
}

void RaceRun::step() {
    switch (phase_) {
        case Phase::Preparing:
            return prepare();
        case Phase::Reference:
            return renderReference();
        case Phase::Running:
            followOthers();
            if (!lookAtDue()) turn();
            return closeIfOver();
        case Phase::Over:
            return;
    }
}

template <class Work>
void RaceRun::attempt(std::size_t entrant, const Work& work) {
    try {
        work();
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception& error) { // of an engine, of the other program, or want of memory
        race_.drop(entrant, messageOf(error));
        racers_[entrant].other.reset();
    }
}

// ---- before the clock ----------------------------------------------------------------------------------------------

void RaceRun::prepare() {
    for (std::size_t i = 0; i < racers_.size(); ++i) {
        const RaceLane& lane = race_.lanes()[i];
        if (racers_[i].isPrepared || lane.isOut || lane.entrant.isOther) continue;
        if (const std::string stage = "Preparing " + lane.name; stage_ != stage) { // which is seen before it takes long
            stage_ = stage;
            return;
        }
        return attempt(i, [&] { prepare(i); });
    }
    stage_.clear();
    for (const Racer& racer : racers_)
        if (racer.engine && referenceEngine_ == nullptr) referenceEngine_ = racer.engine.get();
    if (referenceEngine_ == nullptr) return end("no entrant can be rendered");
    course_.reference ? begin() : void(phase_ = Phase::Reference);
}

void RaceRun::prepare(std::size_t entrant) {
    Racer& racer = racers_[entrant];
    if (!racer.engine) racer.engine = setup_.makeEngine(course_.engine);
    if (!racer.engine->setScene(course_.scene, &mailbox_.cancelled(Cancel::Build))) return; // the next step goes on
    FilmRun warmUp(*racer.engine, course_.camera, settingsOf(entrant));
    warmUp.slice(kWarmUpSeconds, mailbox_.cancelled(Cancel::Slice));
    const EngineReport report = racer.engine->report();
    RaceLane& lane = race_.lane(entrant);
    lane.engine = report.engine;
    lane.device = report.device;
    lane.isSoftware = report.isSoftware;
    racer.isPrepared = true;
}

// On top of what there is of an earlier render.
void RaceRun::renderReference() {
    try {
        if (!referenceRun_) {
            image::Film kept = setup_.references.load(key()).value_or(image::Film());
            referenceRun_.emplace(*referenceEngine_, course_.camera, referenceSettings(key(), kEndlessSpp),
                                  std::move(kept));
        }
        referenceRun_->slice(FilmRun::kSliceSeconds, mailbox_.cancelled(Cancel::Slice));
        if (!referenceRun_->status().finished && !hasEnoughSamples()) return;
        const image::Film& film = referenceEngine_->film();
        if (film.minReplicateSamples() == 0) return; // it cannot tell its own error yet
        setup_.references.save(key(), film);
        RenderedReference made = referenceOf(film);
        course_.reference = std::make_shared<const image::Image>(std::move(made.image));
        course_.referenceError = made.error;
        referenceFilm_ = film;
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception& error) {
        return end("no reference: " + messageOf(error));
    }
    begin();
}

// As many as it takes in its time at the present rate.
bool RaceRun::hasEnoughSamples() const {
    const FilmRun& run = *referenceRun_;
    if (run.seconds() < kMinRateSeconds) return false;
    const auto fresh = static_cast<double>(run.status().samplesDone - run.samplesRestored());
    return static_cast<double>(run.status().samplesDone) * run.seconds() >=
           fresh * kReferenceShare * race_.secondsEach();
}

void RaceRun::begin() {
    referenceRun_.reset();
    phase_ = Phase::Running;
    for (std::size_t i = 0; i < racers_.size(); ++i)
        attempt(i, [&] {
            if (!racers_[i].engine || race_.lanes()[i].isOut) return;
            racers_[i].run.emplace(*racers_[i].engine, course_.camera, settingsOf(i));
            racers_[i].run->watch();
        });
}

// ---- on the clock --------------------------------------------------------------------------------------------------

void RaceRun::turn() {
    const std::optional<std::size_t> next = race_.next();
    if (!next) {
        if (!race_.isOver() && !mailbox_.cancelled(Cancel::Slice)) std::this_thread::sleep_for(kWait);
        return;
    }
    attempt(*next, [&] {
        FilmRun& run = *racers_[*next].run;
        const double seconds = std::clamp(kTurnShare * run.seconds(), kMinTurn, kMaxTurn);
        const auto ended = run.slice(std::min(seconds, race_.secondsLeft(*next)), mailbox_.cancelled(Cancel::Slice));
        race_.spend(*next, run.seconds());
        if (ended == StopReason::Spp) race_.spend(*next, std::max(run.seconds(), race_.secondsEach()));
    });
}

// One of the pictures that are to be looked at. Whether there was one.
bool RaceRun::lookAtDue() {
    for (std::size_t i = 0; i < racers_.size(); ++i) {
        if (!racers_[i].run || !race_.isLookDue(i)) continue;
        attempt(i, [&] { look(i); });
        return true;
    }
    return false;
}

void RaceRun::look(std::size_t entrant) {
    const Racer& racer = racers_[entrant];
    Snapshot snapshot = racer.engine->snapshot();
    if (snapshot.minSamples() == 0) return race_.look(entrant, std::nullopt);
    double seconds = racer.run->seconds();
    if (race_.lanes()[entrant].entrant.isDenoised) {
        // Made anew, since it keeps the features, whose time counts.
        const std::atomic<bool>& cancel = mailbox_.cancelled(Cancel::Slice);
        auto filtered = racer.engine->makeDenoiser()->denoise({DenoiseQuality::Final}, cancel);
        if (!filtered && cancel) return;                         // it is still due
        if (!filtered) return race_.look(entrant, std::nullopt); // one of the halves lacks samples in some pixel
        snapshot.radiance = std::move(filtered->images.picture);
        seconds += filtered->seconds;
    }
    const double spp = static_cast<double>(racer.run->status().samplesDone) / static_cast<double>(racer.run->pixels());
    take(entrant, std::make_shared<const image::Image>(std::move(snapshot.radiance)), spp, seconds);
}

// The reference's own error, which it adds to every measured one, is taken off.
void RaceRun::take(std::size_t entrant, std::shared_ptr<const image::Image> image, double spp, double seconds) {
    const double relmse = image::compare(*image, *course_.reference).relmse - course_.referenceError;
    Racer& racer = racers_[entrant];
    racer.image = std::move(image);
    racer.spp = static_cast<std::uint64_t>(spp);
    ++racer.serial;
    race_.look(entrant, ErrorPoint{seconds, spp, relmse});
}

void RaceRun::followOthers() {
    for (std::size_t i = 0; i < racers_.size(); ++i)
        if (race_.lanes()[i].entrant.isOther && !race_.lanes()[i].isOut) attempt(i, [&] { follow(i); });
}

void RaceRun::follow(std::size_t entrant) {
    std::optional<OtherRacer>& other = racers_[entrant].other;
    if (!other) { // one after the other, where there are several: they have one device
        for (const Racer& racer : racers_)
            if (racer.other) return;
        if (course_.request.edits > 0) throw RenderError("the scene has been edited: save it and open the file first");
        OtherJob job;
        job.program = setup_.options.program == kGpuProgram ? kCpuProgram : kGpuProgram;
        job.scene = course_.request;
        job.compiled = course_.scene;
        job.camera = course_.camera;
        job.settings = settingsOf(entrant);
        other.emplace(job, race_.secondsEach(), setup_.programs);
        return;
    }
    if (const auto news = other->look()) {
        race_.spend(entrant, news->seconds);
        const bool isWhole = news->film.minSamples() > 0;
        const double spp = static_cast<double>(news->film.totalSamples()) /
                           (static_cast<double>(course_.settings.width) * course_.settings.height);
        isWhole ? take(entrant, std::make_shared<const image::Image>(news->film.resolve()), spp, news->seconds)
                : race_.look(entrant, std::nullopt);
    }
    if (!other->hasEnded()) return;
    const OtherRacer::Device device = other->device();
    RaceLane& lane = race_.lane(entrant);
    lane.engine = device.engine;
    lane.device = device.name;
    lane.isSoftware = device.isSoftware;
    other.reset();
    race_.finish(entrant);
}

void RaceRun::closeIfOver() {
    if (!race_.isOver()) return;
    phase_ = Phase::Over;
    freeEngines();
}

void RaceRun::end(const std::string& why) {
    if (!isRunning()) return;
    ending_ = why;
    race_.end();
    phase_ = Phase::Over;
    freeEngines();
}

void RaceRun::freeEngines() {
    referenceRun_.reset();
    referenceEngine_ = nullptr;
    for (Racer& racer : racers_) {
        racer.run.reset();
        racer.engine.reset();
        racer.other.reset();
    }
}

// ---- what is seen --------------------------------------------------------------------------------------------------

std::size_t RaceRun::shown() const {
    if (wish_ && *wish_ < racers_.size()) return *wish_;
    if (const auto standing = standingOf(race_.lanes())) return standing->leader;
    const auto first = std::find_if(racers_.begin(), racers_.end(), [](const Racer& r) { return r.image != nullptr; });
    return first == racers_.end() ? 0 : static_cast<std::size_t>(first - racers_.begin());
}

RaceState RaceRun::state() const {
    RaceState state;
    state.phase = phase_;
    state.stage = stage_;
    state.work = {course_.request, course_.scene->title, course_.camera, course_.settings, course_.engine.threads};
    state.lanes = race_.lanes();
    state.seconds = race_.secondsEach();
    state.referenceSeconds = referenceRun_ ? referenceRun_->seconds() : 0;
    state.referenceWanted = kReferenceShare * race_.secondsEach();
    state.referenceError = course_.referenceError;
    state.ending = ending_;
    state.shown = shown();
    return state;
}

std::optional<Picture> RaceRun::takePicture(bool again) {
    const std::size_t entrant = shown();
    const Racer& racer = racers_[entrant];
    const std::pair now(entrant, racer.serial);
    if (!racer.image || (std::exchange(taken_, now) == now && !again)) return std::nullopt;
    Picture picture;
    picture.image = picture.radiance = picture.subject = racer.image;
    picture.isDenoised = race_.lanes()[entrant].entrant.isDenoised;
    picture.spp = racer.spp;
    return picture;
}

std::optional<image::Film> RaceRun::takeReferenceFilm() {
    return std::exchange(referenceFilm_, std::nullopt);
}

} // namespace rt::app
