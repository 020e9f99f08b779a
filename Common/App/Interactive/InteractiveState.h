// What a window asks of its session, and what it gets to see.
#pragma once
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Interactive/ErrorCurve.h"
#include "Common/App/Interactive/Race.h"
#include "Common/App/Interactive/RunHistory.h"
#include "Common/App/Interactive/ViewImage.h"
#include "Common/App/Options/Options.h"
#include "Common/App/Session/FileFingerprint.h"
#include "Common/App/Session/ReferenceCache.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/App/Session/Statistics.h"
#include "Common/Render/Engine.h"
#include "Common/Render/Names.h"
#include "Common/Render/Settings.h"
#include "Common/Scene/Moment.h"

namespace rt::app {

// Which engine on what; a change makes another one.
struct EngineChoice {
    GpuEngineKind kind = GpuEngineKind::Auto; // of ray-tracing-gpu
    std::string device;                       // of ray-tracing-gpu, as --device takes it
    Policy policy = Policy::Par;
    std::uint32_t threads = 0;
    bool operator==(const EngineChoice&) const = default;
};
// A device that serves ray-tracing-gpu.
struct EngineDevice {
    std::string name;
    std::string request;                // as --device takes it: the name, or the index where names are alike
    std::vector<GpuEngineKind> engines; // that it has
    bool isSoftware = false;            // a driver that works on the processor
};
using EngineMaker = std::function<std::unique_ptr<Engine>(const EngineChoice&)>;

// What is to be rendered and how; a change starts the film anew.
struct RenderRequest {
    RenderSettings settings; // width and height follow from size and scene
    SizeRequest size;
    bool oneSidedLights = true;
    bool halves = false;    // two halves of the samples that know nothing of each other, for a denoiser
    bool accumulate = true; // false: every frame is an image of its own, with other random numbers
    // Per pixel. Accumulated: a frame is shown when it has so many more samples, or after half a second; frames of an
    // old sum may have more. 0: as many as there is time for between two frames.
    std::uint32_t samplesPerFrame = 25;
    bool loop = false; // begin again when done, with the next seed
    // Budgets: what is reached first ends the film, of which only its samples must be bounded.
    std::optional<double> timeLimit;   // seconds of sampling
    std::optional<double> targetError; // estimated relMSE
    bool operator==(const RenderRequest&) const = default;
};
// Whether the film of one is of no use for the other.
bool needsAnotherFilm(const RenderRequest& before, RenderRequest after);
// Whether at most the number of samples and what ends the film before differ: one film may do for both.
bool differsInBudgetsAlone(const RenderRequest& before, RenderRequest after);

enum class Activity { Preparing, Rendering, Paused, Stopped, Finished, Failed };

// What is shown of the whole image.
struct Picture {
    std::shared_ptr<const image::Image> image;     // linear
    std::shared_ptr<const image::Image> radiance;  // the same, but for views of something else
    bool isDisplay = false;                        // no exposure and no tone curve belong to it
    bool isPreview = false;                        // by rasterisation
    bool isOfRace = false;                         // of SessionState::race, whose state tells whose
    bool isDenoised = false;                       // the image is not the radiance, but that with less noise
    bool isLive = false;                           // of which a better one is to come
    std::shared_ptr<const image::Image> subject{}; // that views of errors are of: the radiance, denoised, or of a half
    std::shared_ptr<const image::Image> values{};  // that a view of something else shows
    std::optional<Legend> legend{};                // of the image's colours, where they stand for something else
    std::uint64_t serial = 0;                      // grows with each new picture
    std::uint64_t spp = 0; // of every pixel, adaptive ones in the mean; 0: partly a draft of lower resolution
    // With ViewRequest::inspect, where known: variance of each pixel's mean, and its samples in one channel.
    std::shared_ptr<const image::Image> variance, samples;
    std::optional<scene::CameraDesc> camera{}; // that it was made with; empty: that of a race
    std::uint64_t sceneEdits = 0;              // that its scene had, as SessionState counts
};

// The last render that ended.
struct LastRun {
    Seconds seconds;
    double accelBuild = 0;
    double pipeline = 0;
    std::uint64_t spp = 0;
};

// What an error is about: the window shows it there.
enum class ErrorSource { Other, Scene, Engine, Reference, Save, Camera };
struct ErrorMessage {
    std::string text;
    ErrorSource source = ErrorSource::Other;
};

// All that the window shows of the session, copied at one moment.
struct SessionState {
    Activity activity = Activity::Preparing;
    std::string stage;       // what keeps the user waiting; empty: nothing
    double stageSeconds = 0; // how long it has
    static constexpr std::size_t kMaxErrors = 16;
    std::vector<ErrorMessage> errors{}; // of requests that failed; the last ones of `errorSerial`, the latest last
    std::uint64_t errorSerial = 0;
    std::string message; // what was last written
    std::uint64_t messageSerial = 0;
    std::exception_ptr fatal; // nothing can be rendered: no engine, or no scene ever

    std::uint64_t sceneSerial = 0;             // grows with each scene; 0: none yet
    std::string source;                        // of the scene, as it was asked for
    scene::Moment moment;                      // likewise
    scene::Shutter shutter;                    // likewise, though edits are shown at one instant
    PoseScene poses;                           // as LoadedScene has it
    std::optional<FileFingerprint> sourceMark; // of that file, as it was read
    std::vector<FileFingerprint> modelMarks;   // of the files of models that it has taken in, as they were read
    std::uint64_t sceneLoads = 0;              // grows with each that was loaded, also anew
    std::uint64_t sceneReads = 0;              // grows with each that was read from its source
    std::uint64_t sceneEdits = 0;              // which of the edits it has, as SceneRequest counts; 0: none
    std::uint64_t scenePoses = 0;              // which of the moments that were wished it has, likewise
    std::uint64_t failedPose = 0;              // of those the last that could not be had
    scene::CameraDesc sceneCamera;             // that a view of the scene of this serial begins with
    std::string failedSource;                  // of the last scene that could not be had
    std::uint64_t sceneFailures = 0;           // grows with each of them
    std::shared_ptr<const scene::CompiledScene> scene;

    EngineChoice engine;              // in force
    std::uint64_t engineFailures = 0; // grows with each choice that could not be had: the engine before goes on
    RenderSettings settings;          // of the film
    Picture picture;
    RenderStatus status;
    double renderSeconds = 0;
    Seconds seconds;
    EngineReport report;
    std::optional<LastRun> lastRun;

    std::shared_ptr<const RaceState> race; // the present one or the last; null: there has been none

    std::string reference; // what it is; empty: there is none
    std::shared_ptr<const image::Image> referenceImage;
    double referenceError = 0;            // its own relMSE, estimated; 0: not known
    bool referenceFits = false;           // it is of this scene, camera, size and depth
    bool isReferenceRender = false;       // what is being rendered will be the reference
    std::optional<double> relmse;         // of the film, against the reference if that fits, else its own estimate
    std::optional<double> denoisedRelmse; // likewise of the denoised picture
    double denoiseSeconds = 0;            // that it took, which are none of rendering; 0: there is none
    std::vector<ErrorPoint> curve;        // of this film, against the reference
    bool canShowCost = false;             // the engine knows what a pixel costs in rays
    bool canShowTime = false;             // and in time
    bool canPreview = false;              // it can draw without ray tracing
    double focusDistance = 0;             // that makes sharp what was picked last
    std::uint64_t focusSerial = 0;        // grows with each pick that met something
    std::uint64_t historySerial = 0;      // grows when a run is added to the history
    double slowestAnswer = 0;             // seconds from a change of camera or settings to the first picture of it
};

enum class SavedPicture { Raw, Denoised, Both };
struct SaveRequest {
    std::vector<std::string> files{}; // the extension decides the format
    std::vector<Aov> aovs{};          // beside each of them
    std::string stats{};              // the statistics; "-": standard output, empty: none
    float exposure = 0;
    Tonemap tonemap = Tonemap::None;
    SavedPicture what = SavedPicture::Raw; // Both: the denoised one beside the raw one
    bool operator==(const SaveRequest&) const = default;
};

// How it went with the files of InteractiveSession::writeAtEnd(), if it was called.
struct EndFiles {
    bool hasFilm = true;                 // false: there was none that could be written
    std::vector<std::string> failures{}; // a line for each that is missing, or one where there was no film
};

// What a session begins with.
struct SessionSetup {
    Options options; // what the window does not change
    EngineMaker makeEngine;
    EngineChoice engine;
    RenderRequest request;
    SceneRequest scene;
    std::string fallbackScene;        // opened where the first cannot be had; empty: that is fatal
    std::optional<SaveRequest> atEnd; // as InteractiveSession::writeAtEnd()
    bool preview = false;             // is shown from the beginning
    double sliceSeconds = 0.03;       // of one call of the engine, at most
    bool drawnBySoftware = false;     // each picture costs the processor's threads, so that fewer are shown
    ReferenceCache references{{}};    // that were rendered; keeps none by itself
    RunHistory* history = nullptr;    // gets the runs that end; may be none
    std::filesystem::path programs{}; // where the other program is, in place of this one's folder: for tests
    std::function<void()> onChange;   // called on other threads when there is something new to show
};

} // namespace rt::app
