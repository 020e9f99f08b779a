// The session's thread: races.
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "Common/App/Interactive/SessionThread.h"
#include "Common/Core/Error.h"

namespace rt::app {
namespace {

constexpr double kPublishSeconds = 0.2, kSoftPublishSeconds = 1; // the latter where software draws

} // namespace

// Before anything else of a request is obeyed.
void SessionThread::applyToRace(Requests& requests) {
    if (race_ && requests.raceShown) {
        race_->show(*requests.raceShown);
        publishRace(true);
    }
    if (isRacing() && (requests.raceEnd || requests.command == Requests::Command::Stop)) {
        race_->end("stopped");
        requests.command.reset(); // the film rests already
        publishRace();
    } else if (isRaceShown_ && isRaceEndedBy(requests)) {
        leaveRace("the view or its settings have changed");
    }
    if (requests.raceEnd == Requests::RaceEnd::Leave) leaveRace("stopped");
}

bool SessionThread::isRaceEndedBy(const Requests& requests) const {
    const bool isOtherFilm = requests.request && needsAnotherFilm(request_, *requests.request);
    const bool isOtherCamera =
        requests.camera && requests.camera->first == sceneSerial_ && requests.camera->second != camera_;
    const bool isOtherEngine = requests.engine && *requests.engine != choice_;
    return isOtherFilm || isOtherCamera || isOtherEngine || requests.scene || requests.preview || requests.command ||
           requests.referenceSpp || requests.referenceFile;
}

void SessionThread::startRace(const RaceRequest& request) {
    const auto refuse = [this](const char* why) { state_.fail(std::make_exception_ptr(RenderError(why))); };
    if (!isReady()) return refuse("a race needs a scene, which is being prepared");
    if (isPreviewing()) return refuse("a race needs ray tracing, which is off");
    RaceCourse course;
    course.engine = choice_;
    // What an engine of kind `auto` has found to be the fastest is not measured by each entrant again.
    for (const auto& row : kGpuEngines)
        if (row.name == engine_->report().engine) course.engine.kind = row.value;
    course.request = loaded_.request;
    course.scene = loaded_.scene;
    course.camera = camera_;
    course.settings = sizedSettings(request_, *loaded_.scene);
    const ReferenceKey key = keyOf(subject(), course.settings);
    // A file is taken as it is; what was rendered gets better where a race needs that and its samples are kept.
    const bool fits = !film_.isStale() && film_.reference.fits() && film_.reference.film() == key;
    if (fits && (film_.reference.error() == 0 || !setup_.references.has(key))) {
        course.reference = film_.reference.shared();
        course.referenceError = film_.reference.error();
    }
    if (film_.reference.renderedSpp()) {
        film_.reference.giveUp();
        film_.beginAnew();
    }
    resumesAfterRace_ = isActive() || (resumesAfterRace_ && isRaceShown_);
    if (isActive()) setActivity(Activity::Paused);
    isRaceShown_ = true;
    race_.reset(); // its engines go before the next ones come
    race_ = std::make_unique<RaceRun>(setup_, mailbox_, std::move(course), request);
    publishRace();
}

void SessionThread::renderRace() {
    race_->step();
    keepRaceReference();
    // Not after each turn: what draws takes time from those who race.
    const double interval = setup_.drawnBySoftware ? kSoftPublishSeconds : kPublishSeconds;
    if (!isRacing() || !race_->isOnClock() || sinceRacePublished_.seconds() > interval) publishRace();
}

// Where the film is of the same view, its errors are known, too.
void SessionThread::keepRaceReference() {
    const std::optional<image::Film> made = race_->takeReferenceFilm();
    if (!made || film_.isStale()) return;
    const RenderSettings& settings = film_.run()->settings();
    if (keyOf(subject(), settings) != film_.reference.film() || made->desc().width != settings.width) return;
    film_.setReference(*made, "rendered");
}

// The film comes back, as it was, unless another is wanted.
void SessionThread::leaveRace(const std::string& why) {
    if (!isRaceShown_) return;
    race_->end(why);
    isRaceShown_ = false;
    publishRace();
    race_.reset();
    if (activity_ == Activity::Paused && std::exchange(resumesAfterRace_, false)) setActivity(Activity::Rendering);
    showFilm();
}

void SessionThread::publishRace(bool again) {
    sinceRacePublished_ = {};
    RaceState race = race_->state();
    race.isShown = isRaceShown_;
    std::optional<Picture> picture = isRaceShown_ ? race_->takePicture(again) : std::nullopt;
    state_.update([&](SessionState& state) { state.race = std::make_shared<const RaceState>(std::move(race)); });
    if (picture) film_.publisher.showOfRace(std::move(*picture), race_->reference());
}

} // namespace rt::app
