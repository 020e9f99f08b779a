// Drives a race on the session's thread, a little at a time: engines, the reference, turns, looks at the pictures.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Interactive/InteractiveState.h"
#include "Common/App/Interactive/Mailbox.h"
#include "Common/App/Interactive/OtherRacer.h"
#include "Common/App/Interactive/Race.h"
#include "Common/Render/FilmRun.h"

namespace rt::app {

// What is raced on.
struct RaceCourse {
    EngineChoice engine; // of this program
    SceneRequest request;
    std::shared_ptr<const scene::CompiledScene> scene;
    scene::CameraDesc camera;
    RenderSettings settings;                       // size, depth, Russian roulette, forced features
    std::shared_ptr<const image::Image> reference; // of this view; null: one is to be rendered
    double referenceError = 0;                     // its own relMSE; 0: not known
};

// Each entrant of this program has an engine of its own, all of one scene, so that a turn costs no more than its time:
// no film is moved, no kernel chosen anew.
class RaceRun {
  public:
    RaceRun(const SessionSetup& setup, const Mailbox& mailbox, RaceCourse course, const RaceRequest& request);

    // Some tenths of a second of it. What an entrant fails by is told of its lane, and the others go on.
    void step();
    bool isOnClock() const { return phase_ == RaceState::Phase::Running; }
    bool isRunning() const { return phase_ != RaceState::Phase::Over; }
    void end(const std::string& why);                                  // frees what only a race under way needs
    void show(std::optional<std::size_t> entrant) { wish_ = entrant; } // none: who leads

    RaceState state() const;
    // Of the entrant that is shown; none where that has not changed since the last call, unless asked for `again`.
    std::optional<Picture> takePicture(bool again);
    const image::Image* reference() const { return course_.reference.get(); }
    // What has been rendered for the race; once.
    std::optional<image::Film> takeReferenceFilm();

  private:
    using Phase = RaceState::Phase;
    struct Racer {
        std::unique_ptr<Engine> engine;
        std::optional<FilmRun> run;
        std::optional<OtherRacer> other;
        std::shared_ptr<const image::Image> image; // null: none yet
        std::uint64_t spp = 0, serial = 0;         // of the image; grows with each
        bool isPrepared = false;
    };

    template <class Work>
    void attempt(std::size_t entrant, const Work& work);
    void prepare();
    void prepare(std::size_t entrant);
    void renderReference();
    bool hasEnoughSamples() const;
    void begin();
    void turn();
    bool lookAtDue();
    void look(std::size_t entrant);
    void followOthers();
    void follow(std::size_t entrant);
    void take(std::size_t entrant, std::shared_ptr<const image::Image> image, double spp, double seconds);
    void closeIfOver();
    void freeEngines();

    RenderSettings settingsOf(std::size_t entrant) const;
    ReferenceKey key() const;
    std::size_t shown() const;

    const SessionSetup& setup_;
    const Mailbox& mailbox_;
    RaceCourse course_;
    Race race_;
    std::vector<Racer> racers_;
    Phase phase_ = Phase::Preparing;
    std::string stage_, ending_;
    Engine* referenceEngine_ = nullptr; // one of the racers'
    std::optional<FilmRun> referenceRun_;
    std::optional<image::Film> referenceFilm_;
    std::optional<std::size_t> wish_;
    std::optional<std::pair<std::size_t, std::uint64_t>> taken_; // entrant and serial of the last picture
};

} // namespace rt::app
