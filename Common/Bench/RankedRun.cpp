#include "Common/Bench/RankedRun.h"

#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include <nlohmann/json.hpp>

#include "Common/App/Options/Names.h"
#include "Common/App/Platform.h"
#include "Common/Core/Error.h"
#include "Common/Core/OwnFolder.h"
#include "Common/Core/Paths.h"
#include "Common/Image/ImageIo.h"

namespace rt::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kLook{20}; // between two looks at the launcher

std::string textOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

std::string lastLine(const std::string& text) {
    std::istringstream lines(text);
    std::string last;
    for (std::string line; std::getline(lines, line);)
        if (!line.empty()) last = line;
    return last;
}

// False: stopped, whereupon it was ended.
bool runToEnd(const fs::path& program, const std::vector<std::string>& arguments, const fs::path& log,
              const std::atomic<bool>& stop) {
    app::ChildProcess child(program, arguments, log);
    while (!child.exitCode()) {
        if (stop) return false;
        std::this_thread::sleep_for(kLook);
    }
    if (*child.exitCode() != 0) throw RenderError(program.filename().string() + ": " + lastLine(textOf(log)));
    return true;
}

fs::path programOf(const Config& config) {
    const fs::path own = executablePath();
    fs::path program = own.parent_path() / (isGpuEngine(config.engine) ? "ray-tracing-gpu" : "ray-tracing-cpu");
    program += own.extension();
    return program;
}

} // namespace

RankLauncher findRankLauncher() {
    RankLauncher launcher;
    launcher.mpirun = findProgram("mpirun");
    launcher.missing = "there is no mpirun";
    if (launcher.mpirun.empty()) return launcher;
    const OwnFolder folder;
    const std::atomic<bool> never{false};
    runToEnd(launcher.mpirun, {"--version"}, folder / "version", never);
    if (textOf(folder / "version").find("Open MPI") != std::string::npos)
        launcher.settings = {"--bind-to", "none", "--oversubscribe"};
    return launcher;
}

std::vector<std::string> rankArguments(const RankLauncher& launcher, const fs::path& program, const Config& config,
                                       std::uint32_t spp, std::uint32_t seed, const fs::path& picture,
                                       const fs::path& statistics) {
    const app::RenderSettings& s = config.settings;
    std::vector<std::string> list = {"-n", std::to_string(config.ranks)};
    list.insert(list.end(), launcher.settings.begin(), launcher.settings.end());
    list.push_back(program.string());
    const auto add = [&list](const std::string& flag, const std::string& value) {
        list.push_back(flag);
        list.push_back(value);
    };
    list.insert(list.end(), {"--no-config", "--quiet"});
    add("--scene", config.scene);
    add("--width", std::to_string(s.width));
    add("--height", std::to_string(s.height));
    add("--spp", std::to_string(spp));
    add("--max-depth", std::to_string(s.maxDepth));
    add("--seed", std::to_string(seed));
    app::forEachMethod([&add](const char* key, const char*, const char*, const auto& table,
                              const auto& value) { add(app::flagOf(key), app::nameOf(table, value)); },
                       s);
    add("--russian-roulette", app::nameOf(app::kOnOff, s.russianRoulette));
    if (s.features) add("--features", "all");
    if (isGpuEngine(config.engine)) {
        add("--engine", config.engine);
    } else {
        add("--policy", config.engine == "single" ? "seq" : "par");
        if (config.threads > 0) add("--threads", std::to_string(config.threads));
    }
    add("--output", picture.string());
    add("--stats", statistics.string());
    return list;
}

Run toRun(const std::string& statistics) {
    const nlohmann::json json = nlohmann::json::parse(statistics);
    const nlohmann::json &seconds = json.at("seconds"), &rays = json.at("rays");
    Snapshot snapshot;
    snapshot.spp = json.at("spp_done");
    snapshot.seconds = seconds.at("render");
    snapshot.deviceSeconds = seconds.at("render_device");
    snapshot.rays = {rays.at("camera"), rays.at("scattered"), rays.at("shadow")};
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
        const auto arguments = rankArguments(launcher, programOf(config), config, spp, seed, picture, statistics);
        if (!runToEnd(launcher.mpirun, arguments, folder / "messages", stop)) break;
        Run run = toRun(textOf(statistics));
        run.snapshots.back().image = image::readImage(picture);
        all.report = run.report;
        all.snapshots.push_back(std::move(run.snapshots.back()));
    }
    return all;
}

} // namespace rt::bench
