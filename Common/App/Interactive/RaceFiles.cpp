#include "Common/App/Interactive/RaceFiles.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>
#include <system_error>

#include <nlohmann/json.hpp>

#include "Common/App/Interactive/CameraController.h"
#include "Common/App/Interactive/RunHistory.h"
#include "Common/Render/Names.h"

namespace rt::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSteps = 5;             // of the suite's time, each twice the one before
constexpr double kMinStep = 1e-3;     // seconds, that a suite may have
constexpr double kMinReference = 0.1; // likewise

std::string engineOf(const RaceLane& lane, bool isGpu) {
    if (!lane.engine.empty()) return lane.engine;
    return lane.entrant.isOther == isGpu ? "multi" : "compute";
}

Json variantOf(const RaceLane& lane, bool isGpu) {
    Json variant{{"engine", engineOf(lane, isGpu)}};
    const auto add = [&variant](const char* key, const char*, const char*, const auto& table, const auto& value) {
        variant[key] = nameOf(table, value);
    };
    forEachMethod(add, lane.entrant.settings);
    variant["denoise"] = lane.entrant.isDenoised ? "on" : "off";
    return variant;
}

} // namespace

const char* whyNoSuite(const RaceState& race) {
    const SceneRequest& request = race.work.request;
    if (request.moment != scene::Moment()) return "a suite knows no moment of an animation";
    if (!request.oneSidedLights) return "in suites lights are one-sided where their scene does not say";
    if (race.work.settings.features) return "the features were forced by --features";
    return nullptr;
}

std::string raceTable(const RaceState& race, bool isGpu) {
    std::ostringstream out;
    out.precision(std::numeric_limits<double>::max_digits10);
    out << "entrant,program,engine,device,denoised";
    const RenderSettings any;
    const auto addKey = [&out](const char* key, const char*, const char*, const auto&, const auto&) {
        out << ',' << key;
    };
    forEachMethod(addKey, any);
    out << ",seconds,spp,relmse,times_leader\n";
    const std::optional<RaceStanding> standing = standingOf(race.lanes);
    for (std::size_t i = 0; i < race.lanes.size(); ++i) {
        const RaceLane& lane = race.lanes[i];
        std::ostringstream head;
        head << csvField(lane.name) << ',' << (lane.entrant.isOther == isGpu ? "cpu" : "gpu") << ','
             << engineOf(lane, isGpu) << ',' << csvField(lane.device) << ',' << nameOf(kOnOff, lane.entrant.isDenoised);
        const auto addName = [&head](const char*, const char*, const char*, const auto& table, const auto& value) {
            head << ',' << nameOf(table, value);
        };
        forEachMethod(addName, lane.entrant.settings);
        for (const ErrorPoint& point : lane.curve) {
            out << head.str() << ',' << point.seconds << ',' << point.spp << ',' << point.relmse << ',';
            const bool isLast = &point == &lane.curve.back();
            const std::optional<double> factor = isLast && standing ? factorOf(race.lanes, *standing, i) : std::nullopt;
            if (factor) out << *factor;
            out << '\n';
        }
    }
    return out.str();
}

std::string raceSuite(const RaceState& race, bool isGpu, const std::string& sceneFile) {
    const RaceWork& work = race.work;
    const std::string named = sceneFile.empty() ? work.request.source : sceneFile;
    std::error_code none; // built-in scenes are no files, and one that is being written is none yet
    const bool isFile = !sceneFile.empty() || std::filesystem::exists(named, none);
    const std::string source = isFile ? std::filesystem::absolute(named, none).string() : named;
    Json variants = Json::array(), seconds = Json::array();
    for (const RaceLane& lane : race.lanes) variants.push_back(variantOf(lane, isGpu));
    for (int i = kSteps - 1; i >= 0; --i)
        if (const double step = race.seconds / (1 << i); step >= kMinStep) seconds.push_back(step);
    Json experiment{{"name", "race"},
                    {"title", "Race: " + work.title},
                    {"scene", source},
                    {"camera", Json::parse(CameraController::toText(work.camera))},
                    {"width", work.settings.width},
                    {"height", work.settings.height},
                    {"max_depth", work.settings.maxDepth},
                    {"russian_roulette", work.settings.russianRoulette}};
    if (!isGpu) experiment["threads"] = work.threads;
    experiment["variants"] = variants;
    experiment["seconds"] = seconds;
    experiment["baseline"] = variants.front();
    const Json suite{{"version", 1},
                     {"title", "Race: " + work.title},
                     {"reference_seconds", std::max(kMinReference, kReferenceShare * race.seconds)},
                     {"experiments", Json::array({experiment})}};
    return suite.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

} // namespace rt::app
