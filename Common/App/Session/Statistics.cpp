#include "Common/App/Session/Statistics.h"

#include <nlohmann/json.hpp>

#include "Common/App/Platform.h"
#include "Common/App/Session/FeatureNames.h"
#include "Common/App/Session/ImagePart.h"
#include "Common/Core/Hash.h"
#include "Common/Render/FilmEstimate.h"
#include "Common/Render/RenderParams.h"

namespace rt::app {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json orNull(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json settingsJson(const Options& options) {
    const RenderSettings& settings = options.settings;
    Json json;
    forEachMethod([&json](const char* key, const char*, const char*, const auto& table,
                          const auto& value) { json[key] = nameOf(table, value); },
                  settings);
    json.update({{"one_sided_lights", options.oneSidedLights},
                 {"russian_roulette", settings.russianRoulette},
                 {"replicates", settings.replicates},
                 {"features", settings.features ? "forced" : "auto"},
                 {"policy", nameOf(kPolicies, options.policy)},
                 {"time_limit", orNull(options.timeLimit)},
                 {"target_error", orNull(options.targetError)}});
    return json;
}

Json secondsJson(const Seconds& seconds, const EngineReport& report) {
    return {
        {"load", seconds.load},     {"accel_build", report.accelBuildSeconds},     {"pipeline", report.pipelineSeconds},
        {"render", seconds.render}, {"render_device", report.renderDeviceSeconds}, {"write", seconds.write}};
}

double perSecond(double count, double seconds) {
    return seconds > 0 ? count / seconds : 0;
}

Json raysJson(const RayCounts& rays, double seconds) {
    return {{"camera", rays.camera}, {"scattered", rays.scattered},
            {"shadow", rays.shadow}, {"edge", rays.edge},
            {"reuse", rays.reuse},   {"per_second", perSecond(static_cast<double>(rays.all()), seconds)}};
}

Json errorJson(const image::ErrorFigures& error) {
    return {
        {"mse", error.mse}, {"rmse", error.rmse}, {"relmse", error.relmse}, {"mae", error.mae}, {"psnr", error.psnr}};
}

// Shares of the pixels that kept each bandwidth, in standard deviations of the noise; "raw": those left as they are.
// The device, and how long it took for each pass, unless the processor has filtered.
Json denoisedJson(const DenoiseFigures& figures) {
    if (!figures.library.empty()) return {{"library", figures.library}, {"seconds", figures.seconds}};
    Json shares = Json::array();
    for (std::uint32_t i = 0; i < shared::kDenoiseBandwidths; ++i) {
        const shared::DenoiseBandwidth candidate = shared::denoiseBandwidth(i);
        shares.push_back({{"bandwidth", candidate.bandwidth},
                          {"patch_pixels", 2 * candidate.patchReach + 1},
                          {"share", figures.shares[i]}});
    }
    Json json = {{"estimated_relmse", figures.relmse.value},
                 {"estimated_relmse_interval", {figures.relmse.low(), figures.relmse.high()}},
                 {"seconds", figures.seconds},
                 {"bandwidths", shares},
                 {"raw_share", figures.shares.back()}};
    if (figures.device.empty()) return json;
    json["device"] = figures.device;
    for (const DenoisePassTime& pass : figures.passes) json["device_seconds"][pass.name] = pass.seconds;
    return json;
}

Json windowJson(const WindowFigures& window, const EngineReport& report) {
    const double dispatch = report.longestDispatchSeconds;
    return {{"frames_per_second", window.framesPerSecond},
            {"median_turn_seconds", window.medianTurn},
            {"longest_turn_seconds", window.longestTurn},
            {"slowest_answer_seconds", window.slowestAnswer},
            {"longest_dispatch_seconds", dispatch > 0 ? Json(dispatch) : Json(nullptr)}};
}

// How `auto` chose the engine.
Json choiceJson(const EngineReport& report) {
    Json rates = Json::object();
    for (const EngineRate& rate : report.rates) rates[rate.engine] = rate.raysPerSecond;
    return {{"by", report.ratesAreOfBefore ? "earlier measurement" : "measurement"}, {"rays_per_second", rates}};
}

Json shutterJson(const ShutterFigures& shutter) {
    return {{"open", shutter.open},
            {"close", shutter.close},
            {"poses", shutter.poses},
            {"pose_seconds", shutter.poseSeconds}};
}

Json ranksJson(const std::vector<RankFigures>& ranks) {
    Json json = Json::array();
    for (const RankFigures& rank : ranks)
        json.push_back({{"device", rank.device},
                        {"threads", rank.threads},
                        {"samples", rank.samples},
                        {"busy_share", rank.busyShare},
                        {"bytes", rank.bytes}});
    return json;
}

} // namespace

std::string Statistics::toJson(const Options& options, const scene::CompiledScene& scene, const EngineReport& report,
                               const image::Film& film) const {
    const FilmEstimate estimated = estimate(film, dependentSide(report.features));
    const RenderSettings& settings = options.settings;
    Json json{{"version", 1},
              {"app", options.program},
              {"scene", scene.id},
              {"scene_hash", hexText(scene.hash)},
              {"engine", report.engine},
              {"device", report.device},
              {"device_is_software", report.isSoftware},
              {"threads", report.threads},
              {"width", settings.width},
              {"height", settings.height},
              {"spp", settings.spp},
              {"spp_done", samplesPerPixel(options, film)},
              {"max_depth", settings.maxDepth},
              {"seed", settings.seed},
              {"stopped_by", nameOf(kStopReasons, stoppedBy)},
              {"settings", settingsJson(options)},
              {"features", featureNames(report.features)},
              {"kernel", report.kernel},
              {"light_shapes", report.lightSampling},
              {"skipped", absentFeatureNames(report.features)},
              {"seconds", secondsJson(seconds, report)}};
    const double samples = static_cast<double>(film.totalSamples() - samplesRestored);
    json["samples_per_second"] = perSecond(samples, seconds.render);
    json["rays"] = raysJson(report.rays, seconds.render);
    json["mean_radiance"] = estimated.meanRadiance;
    // Pixels of a replicate that share the times of their samples do not tell how far off their mean is.
    json["standard_error"] = report.shutter ? Json(nullptr) : orNull(estimated.standardError);
    json["nonfinite_samples"] = report.nonfiniteSamples;
    json["cut_off_share"] = report.cutOffShare();
    json["estimated_relmse"] = json["estimated_relmse_interval"] = json["error_is"] = nullptr;
    if (const auto& relmse = estimated.relmse) {
        json["estimated_relmse"] = relmse->value;
        json["estimated_relmse_interval"] = {relmse->low(), relmse->high()};
        json["error_is"] = film.desc().replicates > 1 ? "replicates" : "blocks";
    }
    if (denoised) json["denoised"] = denoisedJson(*denoised);
    if (error) json["error"] = errorJson(*error);
    if (flip) json["error"]["flip"] = *flip;
    json["memory"] = {{"peak_rss_bytes", peakResidentBytes()}, {"device_bytes", report.deviceBytes}};
    json["outputs"] = outputs;
    if (!report.rates.empty()) json["engine_choice"] = choiceJson(report);
    if (options.frame) json["frame"] = *options.frame;
    if (report.shutter) json["shutter"] = shutterJson(*report.shutter);
    if (!report.ranks.empty()) json["ranks"] = ranksJson(report.ranks);
    if (window) json["window"] = windowJson(*window, report);
    // Names of files may be anything; JSON is UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace rt::app
