#include "Common/App/RenderNote.h"

#include <charconv>

#include <nlohmann/json.hpp>

#include "Common/App/CameraController.h"
#include "Common/App/FeatureNames.h"

namespace rt::app {
namespace {

using Json = nlohmann::ordered_json;

// Short, and read back as the same number.
std::string exactly(float value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

Json argumentList(const Options& options, const scene::CameraDesc& camera, const EngineReport& report) {
    const RenderSettings& s = options.settings;
    Json list{"--scene",
              options.scene,
              "--camera",
              CameraController::toText(camera),
              "--width",
              std::to_string(s.width),
              "--height",
              std::to_string(s.height),
              "--spp",
              std::to_string(s.spp),
              "--max-depth",
              std::to_string(s.maxDepth),
              "--seed",
              std::to_string(s.seed),
              "--replicates",
              std::to_string(s.replicates),
              "--light-sampling",
              nameOf(kLightSamplings, s.lightSampling),
              "--light-selection",
              nameOf(kLightSelections, s.lightSelection),
              "--sphere-light",
              nameOf(kSphereLights, s.sphereLight),
              "--quad-light",
              nameOf(kFlatLights, s.quadLight),
              "--triangle-light",
              nameOf(kFlatLights, s.triangleLight),
              "--sampler",
              nameOf(kSamplers, s.sampler),
              "--one-sided-lights",
              nameOf(kOnOff, options.oneSidedLights),
              "--russian-roulette",
              nameOf(kOnOff, s.russianRoulette),
              "--exposure",
              exactly(options.exposure),
              "--tonemap",
              nameOf(kTonemaps, options.tonemap)};
    const auto add = [&list](const std::string& flag, const std::string& value) {
        list.push_back(flag);
        list.push_back(value);
    };
    if (options.program == kGpuProgram) add("--engine", report.engine); // policies and threads make no difference
    if (s.features) {
        std::string names;
        for (const std::string& name : featureNames(*s.features)) names += (names.empty() ? "" : ",") + name;
        add("--features", names);
    }
    return list;
}

} // namespace

std::string renderNote(const Options& options, const scene::CameraDesc& camera, const EngineReport& report,
                       const image::Film& film) {
    const Json json{{"version", 1},
                    {"program", options.program},
                    {"program_version", RT_VERSION},
                    {"device", report.device},
                    {"spp_done", film.minSamples()},
                    {"arguments", argumentList(options, camera, report)}};
    return json.dump(-1, ' ', false, Json::error_handler_t::replace); // names of files may be anything
}

} // namespace rt::app
