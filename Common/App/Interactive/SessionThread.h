// What the session's thread does for one viewport: it alone has the engine, and strings together what was asked for,
// the film, its pictures, its reference and its files.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "Common/App/Interactive/Mailbox.h"
#include "Common/App/Interactive/PublishedState.h"
#include "Common/App/Interactive/RaceRun.h"
#include "Common/App/Interactive/SessionFilm.h"

namespace rt::app {

class SessionThread {
  public:
    SessionThread(const SessionSetup& setup, Mailbox& mailbox, PublishedState& state, SceneLoader& loader);

    // Does what was asked for, then a little of the work that there is. False: it was asked to quit, and has not done
    // that; end() is to come.
    bool step();
    EndFiles end(); // how it went with the files of the end
    bool hasWork() const { return isRetrying() || hasFilmWork(); }
    bool isRacing() const { return race_ && race_->isRunning(); }

  private:
    // What was asked for.
    void apply(Requests requests);
    void makeEngine(const EngineChoice& choice);
    void takeCamera(const std::optional<std::pair<std::uint64_t, scene::CameraDesc>>& camera);
    void adopt(LoadedScene loaded);
    bool adoptCamera(const LoadedScene& loaded);
    static std::unique_ptr<Engine> blurring(Engine& engine, const LoadedScene& loaded);
    void nameScene(const std::string& file);
    void obey(Requests::Command command);
    void switchPreview(bool on);
    void startReference(std::uint32_t spp);
    void readReferenceFile(const std::string& file);
    void findFocus(std::uint32_t x, std::uint32_t y);
    void setActivity(Activity activity);

    bool isReady() const { return engine_ && loaded_.scene; }
    bool isActive() const { return activity_ == Activity::Rendering; }
    bool isPreviewing() const { return previewIsWanted_ && engine_ && engine_->canPreview(); }
    bool isRetrying() const { return waitingEngine_ || waitingScene_; }
    bool hasFilmWork() const {
        if (!isReady() || isRaceShown_) return isReady() && isRacing();
        return isPreviewing() ? previewIsStale_ : isActive() || film_.isRefining() || film_.isFiltering();
    }

    FilmSubject subject() const { return {*engine_, *loaded_.scene, camera_, request_}; } // requires isReady()
    void renderFilm();
    void showFilm();
    void renderPreview();
    void finish(StopReason reason);
    bool record(); // now, or when nothing is held any more; whether it was now
    void recordWaiting();

    // Races.
    void applyToRace(Requests& requests);
    bool isRaceEndedBy(const Requests& requests) const;
    void startRace(const RaceRequest& request);
    void renderRace();
    void leaveRace(const std::string& why);
    void publishRace(bool again = false);
    void keepRaceReference();

    // Files.
    void writeWaiting();
    void write(const SaveRequest& request);
    std::vector<std::string> writeFiles(const SaveRequest& request, StopReason reason);
    void writeEnd(StopReason reason);

    const SessionSetup& setup_;
    Mailbox& mailbox_;
    PublishedState& state_;
    SceneLoader& loader_;

    EngineChoice choice_;
    std::unique_ptr<Engine> made_;     // as chosen
    std::unique_ptr<Engine> blurring_; // by that one, while a shutter is open; null: none is
    Engine* engine_ = nullptr;         // that renders the film; null: there is none yet
    LoadedScene loaded_;               // the engine's scene
    // Were given up for something else that was wanted, and are tried again after it.
    std::optional<EngineChoice> waitingEngine_;
    std::optional<LoadedScene> waitingScene_;
    std::uint64_t sceneSerial_ = 0;
    scene::CameraDesc camera_;
    RenderRequest request_;
    Activity activity_ = Activity::Preparing;

    bool isHeld_ = false, waitsForRecord_ = false; // as InteractiveSession::hold() says

    SessionFilm film_;
    std::uint32_t previewWidth_ = 0; // 0: the picture's
    bool previewIsWanted_, previewIsStale_ = true;

    std::unique_ptr<RaceRun> race_; // the present one, or the last that is still shown
    bool isRaceShown_ = false;
    bool resumesAfterRace_ = false; // the film was being rendered when it began
    Stopwatch sinceRacePublished_;

    std::vector<SaveRequest> waiting_; // to be written
    std::optional<SaveRequest> atEnd_; // of the first render
    bool endIsWritten_ = false;
    EndFiles endFiles_;
};

} // namespace rt::app
