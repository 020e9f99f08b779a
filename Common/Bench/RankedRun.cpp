#include "Common/Bench/RankedRun.h"

#include <chrono>
#include <sstream>
#include <thread>

#include <nlohmann/json.hpp>

#include "Common/App/OtherProgram.h"
#include "Common/App/Platform.h"
#include "Common/Core/Error.h"
#include "Common/Core/OwnFolder.h"
#include "Common/Core/Paths.h"
#include "Common/Image/ImageIo.h"

namespace rt::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kLook{20}; // between two looks at the launcher

// False: stopped, whereupon it was ended.
bool runToEnd(const fs::path& program, const std::vector<std::string>& arguments, const fs::path& log,
              const std::atomic<bool>& stop) {
    app::ChildProcess child(program, arguments, log);
    while (!child.exitCode()) {
        if (stop) return false;
        std::this_thread::sleep_for(kLook);
    }
    if (*child.exitCode() != 0) throw RenderError(program.filename().string() + ": " + app::lastLine(app::textOf(log)));
    return true;
}

// "mpirun (Open MPI) 5.0.7", "Version: 4.0.2" of MPICH's. What a library of theirs has to say may come before.
std::string versionLine(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t begin = line.find_first_not_of(' ');
        if (line.find(") ") != std::string::npos || line.find("Version:") != std::string::npos)
            return line.substr(begin);
    }
    return app::lastLine(text);
}

} // namespace

RankLauncher findRankLauncher() {
    const fs::path mpirun = findProgram("mpirun");
    if (mpirun.empty()) return {{}, {}, "there is no mpirun"};
    return rankLauncherAt(mpirun);
}

RankLauncher rankLauncherAt(const fs::path& mpirun) {
    RankLauncher launcher{mpirun, {}, ""};
    const OwnFolder folder;
    try {
        const std::atomic<bool> never{false};
        runToEnd(mpirun, {"--version"}, folder / "version", never);
    } catch (const RenderError& error) {
        return {{}, {}, error.what()};
    }
    const std::string text = app::textOf(folder / "version");
    // What Open MPI takes in both its series, 4 and 5: 5 ignores the variables of 4 that say the same. It is known by
    // where it wants to hear of faults, as it calls itself OpenRTE, too.
    if (text.find("open-mpi.org") != std::string::npos)
        launcher.settings = {"--bind-to", "none", "--map-by", ":OVERSUBSCRIBE"};
    launcher.version = versionLine(text);
    return launcher;
}

std::vector<std::string> rankArguments(const RankLauncher& launcher, const fs::path& program, const Config& config,
                                       std::uint32_t spp, std::uint32_t seed, const fs::path& picture,
                                       const fs::path& statistics) {
    std::vector<std::string> list = {"-n", std::to_string(config.ranks)};
    list.insert(list.end(), launcher.settings.begin(), launcher.settings.end());
    list.insert(list.end(), {program.string(), "--no-config", "--quiet", "--scene", config.scene});
    if (!config.camera.empty()) list.insert(list.end(), {"--camera", config.camera});
    app::RenderSettings settings = config.settings;
    settings.spp = spp;
    settings.seed = seed;
    const std::vector<std::string> flags = app::flagsFor(settings, picture, statistics);
    list.insert(list.end(), flags.begin(), flags.end());
    if (settings.features) list.insert(list.end(), {"--features", "all"});
    if (isGpuEngine(config.engine)) {
        list.insert(list.end(), {"--engine", config.engine});
    } else {
        list.insert(list.end(), {"--policy", config.engine == "single" ? "seq" : "par"});
        if (config.threads > 0) list.insert(list.end(), {"--threads", std::to_string(config.threads)});
    }
    return list;
}

Run toRun(const std::string& statistics) {
    const nlohmann::json json = nlohmann::json::parse(statistics);
    const nlohmann::json &seconds = json.at("seconds"), &rays = json.at("rays");
    Snapshot snapshot;
    snapshot.spp = json.at("spp_done");
    snapshot.seconds = seconds.at("render");
    snapshot.deviceSeconds = seconds.at("render_device");
    snapshot.rays = {rays.at("camera"), rays.at("scattered"), rays.at("shadow"), rays.at("edge"), rays.at("reuse")};
    Run run;
    for (const nlohmann::json& rank : json.at("ranks")) {
        snapshot.samples += rank.at("samples").get<std::uint64_t>();
        run.report.threads += rank.at("threads").get<std::uint32_t>();
    }
    run.report.engine = json.at("engine");
    run.report.device = json.at("device");
    run.report.kernel = json.at("kernel");
    run.report.lightSampling = json.at("light_shapes");
    run.report.accelBuildSeconds = seconds.at("accel_build");
    run.report.pipelineSeconds = seconds.at("pipeline");
    run.report.nonfiniteSamples = json.at("nonfinite_samples");
    run.snapshots.push_back(std::move(snapshot));
    return run;
}

Run measureRanks(const RankLauncher& launcher, const Config& config, const Ladder& ladder, std::uint32_t seed,
                 const std::atomic<bool>& stop) {
    if (launcher.mpirun.empty()) throw RenderError("ranks: " + launcher.missing);
    const OwnFolder folder;
    const fs::path picture = folder / "picture.pfm", statistics = folder / "statistics.json";
    Run all;
    for (const std::uint32_t spp : ladder.spp) {
        if (!all.snapshots.empty()) {
            const Snapshot& last = all.snapshots.back();
            if (last.seconds / static_cast<double>(last.spp) * spp > ladder.maxSeconds) break;
        }
        const auto arguments = rankArguments(
            launcher, app::programFile(isGpuEngine(config.engine) ? "ray-tracing-gpu" : "ray-tracing-cpu"), config, spp,
            seed, picture, statistics);
        if (!runToEnd(launcher.mpirun, arguments, folder / "messages", stop)) break;
        Run run = toRun(app::textOf(statistics));
        run.snapshots.back().image = image::readImage(picture);
        all.report = run.report;
        all.snapshots.push_back(std::move(run.snapshots.back()));
    }
    return all;
}

} // namespace rt::bench
