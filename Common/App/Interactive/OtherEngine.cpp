#include "Common/App/Interactive/OtherEngine.h"

#include <chrono>
#include <cstdlib>
#include <iomanip>
#include <limits>
#include <sstream>

#include <nlohmann/json.hpp>

#include "Common/App/Interactive/CameraController.h"
#include "Common/App/Interactive/FilmFiles.h"
#include "Common/App/OtherProgram.h"
#include "Common/App/Platform.h"
#include "Common/Core/Error.h"
#include "Common/Core/OwnFolder.h"
#include "Common/Image/ImageIo.h"
#include "Common/Image/Metrics.h"
#include "Common/Render/Names.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;
using Phase = OtherState::Phase;

constexpr auto kLook = std::chrono::milliseconds(50); // between two looks at the program
constexpr const char* kProgressSeconds = "0.25";      // between two lines of its progress

// What the program tells of its run, on top of what the work is. Throws RenderError, and what a JSON library throws.
RunRecord recordOf(const OtherJob& job, const std::string& statistics) {
    const nlohmann::json json = nlohmann::json::parse(statistics);
    RunRecord record = recordOfWork(*job.compiled, job.scene.oneSidedLights, job.camera, job.settings);
    if (json.at("scene_hash") != record.sceneHash)
        throw RenderError(job.scene.source + ": has changed since it was loaded here; load it again");
    record.time = utcNow();
    record.app = json.at("app");
    record.engine = json.at("engine");
    record.device = json.at("device");
    record.isSoftware = json.at("device_is_software");
    record.threads = json.at("threads");
    record.spp = json.at("spp_done");
    const nlohmann::json& seconds = json.at("seconds");
    record.loadSeconds = seconds.at("load");
    record.buildSeconds = seconds.at("accel_build");
    record.pipelineSeconds = seconds.at("pipeline");
    record.renderSeconds = seconds.at("render");
    record.samplesPerSecond = json.at("samples_per_second");
    record.raysPerSecond = json.at("rays").at("per_second");
    if (const nlohmann::json& estimated = json.at("estimated_relmse"); estimated.is_number()) record.relmse = estimated;
    return record;
}

} // namespace

std::vector<std::string> argumentsFor(const OtherJob& job, const fs::path& picture, const fs::path& statistics) {
    std::vector<std::string> list = {"--headless",     "--no-config", "--progress-every",
                                     kProgressSeconds, "--scene",     job.scene.source};
    if (!job.scene.assetsBelow.empty()) list.insert(list.end(), {"--assets-below", job.scene.assetsBelow});
    if (const scene::Moment& moment = job.scene.moment; moment != scene::Moment()) {
        std::ostringstream time;
        time << std::setprecision(std::numeric_limits<double>::max_digits10) << moment.time;
        list.insert(list.end(), {"--time", time.str()});
        if (!moment.animation.empty()) list.insert(list.end(), {"--animation", moment.animation});
    }
    list.insert(list.end(), {"--camera", CameraController::toText(job.camera), "--one-sided-lights",
                             nameOf(kOnOff, job.scene.oneSidedLights)});
    const std::vector<std::string> settings = flagsFor(job.settings, picture, statistics);
    list.insert(list.end(), settings.begin(), settings.end());
    return list;
}

std::uint64_t progressIn(const std::string& messages) {
    std::istringstream lines(messages.substr(0, messages.rfind('\n') + 1));
    std::uint64_t spp = 0;
    for (std::string line; std::getline(lines, line);) {
        const std::size_t slash = line.find('/');
        const bool isProgress = slash != std::string::npos && slash > 0 && line.find(" spp ") != std::string::npos &&
                                line.find_first_not_of("0123456789") == slash;
        if (isProgress) spp = std::strtoull(line.c_str(), nullptr, 10);
    }
    return spp;
}

void OtherEngine::close() {
    cancel();
    if (thread_.joinable()) thread_.join();
}

OtherState OtherEngine::state() const {
    const std::scoped_lock lock(mutex_);
    return state_;
}

void OtherEngine::update(const std::function<void(OtherState&)>& change) {
    {
        const std::scoped_lock lock(mutex_);
        change(state_);
    }
    if (onChange_) onChange_();
}

void OtherEngine::start(const OtherJob& job) {
    if (isRunning()) return;
    if (thread_.joinable()) thread_.join(); // of the job before, which is done
    cancel_ = false;
    update([&](OtherState& state) {
        const std::uint64_t serial = state.serial;
        state = {};
        state.serial = serial;
        state.phase = Phase::Running;
        state.program = job.program;
        state.sppWanted = job.settings.spp;
    });
    thread_ = std::thread([this, job] {
        try {
            work(job);
        } catch (const std::exception& error) {
            update([&](OtherState& state) {
                state.phase = Phase::Failed;
                state.error = messageOf(error);
            });
        }
    });
}

void OtherEngine::work(const OtherJob& job) {
    const OwnFolder own;
    const fs::path picture = own / "picture.pfm", statistics = own / "statistics.json", log = own / "messages.txt";
    ChildProcess child(programFile(job.program, folder), argumentsFor(job, picture, statistics), log);
    std::optional<int> code;
    while (!(code = child.exitCode()) && !cancel_) {
        std::this_thread::sleep_for(kLook);
        if (const std::uint64_t spp = progressIn(textOf(log)); spp != state().spp)
            update([spp](OtherState& state) { state.spp = spp; });
    }
    if (!code) {
        child.end();
        return update([](OtherState& state) { state.phase = Phase::Cancelled; });
    }
    checkEnd(job.program, *code, log);
    finish(job, picture, statistics);
}

void OtherEngine::finish(const OtherJob& job, const fs::path& picture, const fs::path& statistics) {
    RunRecord record;
    try {
        record = recordOf(job, textOf(statistics));
    } catch (const nlohmann::json::exception& error) {
        throw RenderError(job.program + ": its statistics cannot be read: " + error.what());
    }
    const auto image = std::make_shared<const image::Image>(image::readImage(picture));
    if (job.reference) {
        record.relmse = image::compare(*image, *job.reference).relmse;
        record.hasReference = true;
        record.referenceError = job.referenceError;
    }
    history_.append(record);
    update([&](OtherState& state) {
        state.phase = Phase::Done;
        state.spp = record.spp;
        state.image = image;
        state.record = record;
        ++state.serial;
    });
}

} // namespace rt::app
