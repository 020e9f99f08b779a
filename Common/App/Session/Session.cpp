#include "Common/App/Session/Session.h"

#include <cstdint>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "Common/App/Options/OptionValues.h"
#include "Common/App/Platform.h"
#include "Common/App/Ranks/LocalRank.h"
#include "Common/App/Ranks/Message.h"
#include "Common/App/Ranks/RankedEngine.h"
#include "Common/App/Ranks/Ranks.h"
#include "Common/App/Session/Frames.h"
#include "Common/App/Session/Interrupt.h"
#include "Common/App/Session/Outputs.h"
#include "Common/App/Session/RenderJob.h"
#include "Common/App/Session/SceneOutput.h"
#include "Common/App/Session/SceneSource.h"
#include "Common/App/Session/Statistics.h"
#include "Common/Core/Log.h"
#include "Common/Core/ReadFile.h"
#include "Common/Render/FilmRun.h"
#include "Common/Render/Progress.h"

namespace rt::app {
namespace {

std::string describeEnd(const Statistics& statistics) {
    const StopReason reason = statistics.stoppedBy;
    std::string text = reason == StopReason::Interrupted   ? "interrupted"
                       : reason == StopReason::TimeLimit   ? "time limit reached"
                       : reason == StopReason::TargetError ? "target error reached"
                                                           : "done";
    if (statistics.error) text += ", relMSE " + std::to_string(statistics.error->relmse);
    return text;
}

// One render without a window, stage by stage.
class HeadlessRender {
  public:
    explicit HeadlessRender(Options options, Communicator* ranks = nullptr) : job_(std::move(options)), ranks_(ranks) {}

    ExitCode run(const EngineFactory& makeEngine) {
        interrupt_.finishFirst([this] { checkOutputs(job_.options()); }); // before hours are spent
        job_.load();
        std::unique_ptr<Engine> engine = makeEngine();
        if (ranks_ != nullptr) engine = makeRankedEngine(std::move(engine), *ranks_);
        interrupt_.defer(); // from here on there may be something to save
        if (!job_.begin(std::move(engine), interrupt_.requested())) return ExitCode::Interrupted;
        try {
            sample();
        } catch (const std::exception&) { // of the engine, or want of memory
            job_.write(interrupt_.requested());
            throw;
        }
        job_.write(interrupt_.requested());
        const bool isInterrupted = job_.statistics().stoppedBy == StopReason::Interrupted;
        return isInterrupted ? ExitCode::Interrupted : ExitCode::Done;
    }

    // Writes nothing, and ends when rank 0 says so.
    void follow(const EngineFactory& makeEngine) {
        interrupt_.defer(); // rank 0 gets the same signal
        job_.load();
        const std::unique_ptr<Engine> engine = makeEngine();
        engine->setScene(job_.scene(), nullptr);
        engine->resetForLeases(job_.scene()->camera, job_.options().settings);
        LocalRank rank(*engine, *job_.scene(), job_.options().settings);
        connect(rank, *ranks_);
    }

  private:
    void sample();

    RenderJob job_;
    Communicator* ranks_; // null: this process renders alone
    Interrupt interrupt_;
};

void HeadlessRender::sample() {
    const Options& options = job_.options();
    const auto style = options.quiet               ? Progress::Style::Silent
                       : standardErrorIsTerminal() ? Progress::Style::Terminal
                                                   : Progress::Style::Lines;
    Progress progress(std::cerr, style, options.progressEvery.value_or(Progress::kLineSeconds));
    while (!job_.slice(FilmRun::kSliceSeconds, interrupt_.requested())) progress.update(job_.run().progress());
    progress.finish(job_.run().progress(), describeEnd(job_.statistics()));
}

void exportScene(const Options& options) {
    if (!isSceneOutput(options.exportFile)) refuseValue("--export-scene", options.exportFile, kSceneOutputs);
    const ReadsBelow confined(options.assetsBelow, options.scene);
    scene::SceneDesc scene = loadScene(options.scene, options.moment);
    if (!options.camera.empty()) scene.camera = cameraOf(options.camera, scene);
    for (const std::string& notice : scene.notices) logWarning(scene.id + ": " + notice);
    for (const std::string& notice : writeScene(options.exportFile, scene)) logWarning(scene.id + ": " + notice);
}

// One after the other; of several ranks each has its share. An interrupted one ends the sequence.
ExitCode renderFrames(const Options& options, const EngineFactory& makeEngine, const Communicator* ranks) {
    const auto rank = static_cast<std::uint32_t>(ranks == nullptr ? 0 : ranks->rank());
    const auto step = static_cast<std::uint32_t>(ranks == nullptr ? 1 : ranks->size());
    for (std::uint32_t frame = options.frames->first + rank; frame <= options.frames->last; frame += step) {
        Options one = optionsOfFrame(options, frame);
        if (rank > 0) one.quiet = true;
        const std::string name = "frame " + std::to_string(frame);
        if (isRendered(one)) {
            logInfo(name + ": is there");
            continue;
        }
        logInfo(name + ": " + one.outputs.front());
        const ExitCode code = HeadlessRender(one).run(makeEngine);
        if (code != ExitCode::Done) return code;
        removeCheckpoint(one);
    }
    return ExitCode::Done;
}

// Until all other ranks have rendered their frames. Throws what has kept one from it.
void waitForFrames(Communicator& ranks) {
    for (int missing = ranks.size() - 1; missing > 0;) {
        auto received = ranks.receive();
        if (!received) {
            std::this_thread::sleep_for(kPollInterval);
            continue;
        }
        const Message message = toMessage(std::move(received->message));
        if (message.kind == MessageKind::Rendered) --missing;
        if (message.kind == MessageKind::Failure)
            throw Error(static_cast<ExitCode>(message.fields.at("code").get<int>()),
                        "rank " + std::to_string(received->from) + ": " + message.fields.at("what").get<std::string>());
    }
}

} // namespace

ExitCode runSession(Options options, const EngineFactory& makeEngine, Communicator* ranks) {
    if (ranks != nullptr && options.command != Command::Render)
        throw UsageError("mpirun: only to render; start one program for --list-scenes and --export-scene");
    if (ranks != nullptr && options.shutter.isOpen() && !options.frames)
        throw UsageError("mpirun: not with --shutter, but for --frames, of which each rank renders its own");
    switch (options.command) {
        case Command::ListScenes:
            std::cout << listScenes(options.json);
            return ExitCode::Done;
        case Command::ExportScene:
            exportScene(options);
            return ExitCode::Done;
        case Command::ListDevices:
            throw std::logic_error("devices are listed by the program that knows them");
        case Command::Render:
            break;
    }
    if (!options.frames) return HeadlessRender(std::move(options), ranks).run(makeEngine);
    const ExitCode code = renderFrames(options, makeEngine, ranks);
    if (ranks != nullptr && code == ExitCode::Done) waitForFrames(*ranks);
    return code;
}

bool followSession(Options options, const EngineFactory& makeEngine, Communicator& ranks) {
    if (options.frames) {
        renderFrames(options, makeEngine, &ranks);
        ranks.send(0, toBytes({MessageKind::Rendered, nullptr, {}}));
        return false;
    }
    if (options.shutter.isOpen()) return false; // which rank 0 refuses
    options.reference.clear();
    HeadlessRender(std::move(options), &ranks).follow(makeEngine);
    return true;
}

} // namespace rt::app
