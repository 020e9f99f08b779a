// A render that a window watches and steers. The engine lives on a worker thread; the window posts what it wants and reads
// what there is, and neither waits for the other.
#pragma once
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "Common/App/Interactive/InteractiveState.h"
#include "Common/App/Interactive/RunHistory.h"
#include "Common/App/Session/RenderLoop.h"
#include "Common/App/Session/SceneLoader.h"
#include "Common/App/Session/Stopwatch.h"

namespace rt::app {

class InteractiveSession {
  public:
    struct Setup {
        Options options; // what the window does not change
        EngineMaker makeEngine;
        EngineChoice engine;
        RenderRequest request;
        SceneRequest scene;
        std::string fallbackScene;        // opened where the first cannot be had; empty: that is fatal
        std::optional<SaveRequest> atEnd; // as writeAtEnd()
        bool preview = false;             // is shown from the beginning
        double sliceSeconds = 0.03;       // of one call of the engine, at most
        bool drawnBySoftware = false;     // each picture costs the processor's threads, so that fewer are shown
        RunHistory* history = nullptr;    // gets the runs that end; may be none
        std::function<void()> onChange;   // called on other threads when there is something new to show
    };
    explicit InteractiveSession(Setup setup);
    ~InteractiveSession(); // as close()
    InteractiveSession(const InteractiveSession&) = delete;
    InteractiveSession& operator=(const InteractiveSession&) = delete;

    // Requests. None of them waits; the last of a kind counts.
    void open(const std::string& source);
    void change(const RenderRequest& request);
    void choose(const EngineChoice& engine);
    void moveCamera(const scene::CameraDesc& camera,
                    std::uint64_t sceneSerial); // ignored if the scene is another by now
    void render();                              // from the beginning when ended, else goes on
    void pause();
    void stop();
    void reset();                   // begins anew
    void save(SaveRequest request); // where a picture is yet to come, once it is there
    void view(const ViewRequest& view);
    // Shows the preview instead of the film, where the engine has one; rays rest meanwhile, and the film goes on afterwards
    // unless something that concerns it has changed.
    void preview(bool on);
    // The image that errors are taken against: rendered with the present scene, camera and size, or read from a linear image
    // file of the present size. Stop gives a render up, and what was the reference before stays.
    void renderReference(std::uint32_t spp);
    void loadReference(const std::string& file);
    // Finds the focus distance for what is seen in a pixel: the state tells.
    void pickFocus(std::uint32_t x, std::uint32_t y);

    // What is to be written once, when the first render ends by itself or by stop(), or in close() before that.
    void writeAtEnd(const SaveRequest& request);
    // How the window has answered so far, for the statistics.
    void tell(const WindowFigures& figures);

    // Ends the render and the worker, within 100 ms but for what the engine is building. Returns what of writeAtEnd() could
    // not be written, one line each. Nothing but state() may be called any more.
    std::vector<std::string> close();

    SessionState state() const;

  private:
    enum class Command { Render, Pause, Stop, Reset };
    struct Requests {
        bool quit = false;
        std::optional<EngineChoice> engine;
        std::optional<RenderRequest> request;
        std::optional<LoadedScene> scene;
        std::optional<std::pair<std::uint64_t, scene::CameraDesc>> camera;
        std::optional<Command> command;
        std::vector<SaveRequest> saves;
        std::optional<ViewRequest> view;
        std::optional<bool> preview;
        std::optional<std::uint32_t> referenceSpp;
        std::optional<std::string> referenceFile;
        std::optional<std::array<std::uint32_t, 2>> focus;
        bool anyButCamera() const {
            return quit || engine || request || scene || command || !saves.empty() || view || preview || referenceSpp ||
                   referenceFile || focus;
        }
        bool any() const { return camera || anyButCamera(); }
        bool movesCameraAlone() const { return camera && !anyButCamera(); }
        bool changesWhatIsSeen() const { return engine || request || scene || camera || preview; }
    };

    template <class Change>
    void post(bool interrupt, Change change);
    void update(const std::function<void(SessionState&)>& change);
    void setStage(const std::string& stage);

    // On the worker thread.
    void work();
    Requests take();
    void apply(Requests requests);
    void makeEngine(const EngineChoice& choice);
    void adopt(LoadedScene loaded);
    void obey(Command command);
    void fail(const std::exception_ptr& failure, bool fatal);
    bool isReady() const { return engine_ && scene_; }
    bool isActive() const { return activity_ == Activity::Rendering; }
    bool isPreviewing() const { return previewIsWanted_ && engine_ && engine_->canPreview(); }
    bool hasWork() const { return isReady() && (isPreviewing() ? previewIsStale_ : isActive()); }
    void setActivity(Activity activity);
    RenderSettings sizedSettings() const;
    void switchPreview(bool on);
    void renderPreview();
    void writePreview(const SaveRequest& request);
    bool cameraMovesOn() const;
    void startFilm();
    void beginFilm(RenderSettings settings);
    void learnSpeed(std::uint64_t samples, double seconds);
    void renderDraft(const RenderSettings& settings);
    void renderFirstPass();
    void renderSlice();
    std::uint32_t samplesOfFrame(const RenderSettings& settings) const;
    double pictureInterval() const;
    bool isFrameDue() const;
    Cost shownCost() const { return engine_->knowsCost(view_.cost) ? view_.cost : Cost::Rays; }
    void finish(StopReason reason);
    void publish();
    Options optionsOf(const SaveRequest& request) const;
    bool hasFirstSamples() const;
    void writeWaiting();
    void write(const SaveRequest& request);
    std::vector<std::string> writeFiles(const SaveRequest& request, StopReason reason);
    void writeEnd(StopReason reason);
    WindowFigures windowFigures() const;
    void noteAnswer();
    // What a reference must agree in with a film that is compared with it.
    struct FilmKey {
        std::uint64_t sceneHash = 0;
        scene::CameraDesc camera;
        std::uint32_t width = 0, height = 0, maxDepth = 0;
        bool operator==(const FilmKey&) const = default;
    };
    FilmKey filmKey() const;
    bool referenceFits() const;
    void adoptReference(image::Image image, const std::string& name);
    void readReferenceFile(const std::string& file);
    void followError(const image::Image& picture, bool last);
    void findFocus(std::uint32_t x, std::uint32_t y);
    RunRecord makeRecord() const;
    std::shared_ptr<const ViewImage> shownView(const Picture& picture);

    Setup setup_;

    mutable std::mutex mutex_; // guards what follows
    std::condition_variable wake_;
    Requests requests_;
    SceneRequest wantedScene_;
    bool oneSidedLights_ = true;
    SessionState state_;
    Stopwatch stageWatch_;
    std::optional<SaveRequest> atEnd_;
    bool endIsWritten_ = false;
    WindowFigures window_;
    std::optional<Stopwatch> unanswered_; // since a change that the worker has not seen
    std::atomic<bool> cancelRender_{false};
    std::atomic<bool> cancelBuild_{false};

    // Of the worker alone.
    std::vector<std::string> endFailures_;
    std::optional<Stopwatch> unshown_; // since a change of which there is no picture yet
    EngineChoice choice_;
    std::unique_ptr<Engine> engine_;
    std::shared_ptr<const scene::CompiledScene> scene_;
    std::string source_; // of the scene
    std::uint64_t sceneSerial_ = 0;
    scene::CameraDesc camera_;
    RenderRequest request_;
    RenderSettings settings_; // of the film
    Activity activity_ = Activity::Preparing;
    bool filmIsStale_ = true;
    bool filmIsNew_ = true;   // for this scene and engine
    std::uint32_t round_ = 0; // films since the last change: added to the seed
    RenderStatus status_;
    double renderSeconds_ = 0;
    double loadSeconds_ = 0;
    double samplesPerSecond_ = 2e5; // for the size of drafts; a cautious guess at first
    image::Image draft_;
    std::optional<RenderSettings> postponedFilm_; // not begun, since the camera moved on when its draft was shown
    std::vector<SaveRequest> waiting_;            // to be written
    bool previewIsWanted_ = false;
    bool previewIsStale_ = true;
    Preview preview_;
    ViewRequest view_;
    std::shared_ptr<const ViewImage> featureView_; // of the film, for modes that samples do not change
    bool featureIsFull_ = false;                   // in the film's resolution
    std::optional<std::uint32_t> referenceSpp_;    // of the reference that is being rendered
    std::shared_ptr<const image::Image> reference_;
    std::string referenceName_;
    FilmKey referenceKey_;
    std::vector<ErrorPoint> curve_;
    Stopwatch sinceStart_;
    Stopwatch sincePublished_;
    double publishSeconds_ = 0;
    std::uint64_t publishedSamples_ = 0; // of the film, when it was shown last

    SceneLoader loader_; // last: its thread posts to the worker's members
    std::thread worker_;
};

} // namespace rt::app
