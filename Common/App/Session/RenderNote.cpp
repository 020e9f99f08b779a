#include "Common/App/Session/RenderNote.h"

#include <charconv>

#include <nlohmann/json.hpp>

#include "Common/App/Interactive/CameraController.h"
#include "Common/App/OtherProgram.h"
#include "Common/App/Session/FeatureNames.h"
#include "Common/App/Session/ImagePart.h"
#include "Common/Core/BuildInfo.h"
#include "Common/Scene/ModelFile.h"

namespace rt::app {
namespace {

using Json = nlohmann::ordered_json;

// Short, and read back as the same number.
template <typename Number>
std::string exactly(Number value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

Json argumentList(const Options& options, const scene::CameraDesc& camera, const EngineReport& report) {
    const RenderSettings& s = options.settings;
    Json list = Json::array();
    const auto add = [&list](const std::string& flag, const std::string& value) {
        list.push_back(flag);
        list.push_back(value);
    };
    add("--scene", options.scene);
    if (!options.moment.animation.empty()) add("--animation", options.moment.animation);
    const bool mayComeAfterAnImport = scene::kindOfFile(options.scene) == ".json";
    if (options.moment.time != 0 || (options.moment.isWhole && mayComeAfterAnImport))
        add("--time", exactly(options.moment.time));
    if (options.shutter.isOpen())
        add("--shutter", exactly(options.shutter.open) + "," + exactly(options.shutter.close));
    add("--camera", CameraController::toText(camera));
    for (const std::string& word : settingFlags(s)) list.push_back(word);
    add("--one-sided-lights", nameOf(kOnOff, options.oneSidedLights));
    add("--russian-roulette", nameOf(kOnOff, s.russianRoulette));
    add("--exposure", exactly(options.exposure));
    add("--tonemap", nameOf(kTonemaps, options.tonemap));
    if (options.denoisedOnly) add("--denoise", "only");
    if (options.program == kGpuProgram) add("--engine", report.engine); // policies and threads make no difference
    if (options.region) {
        const Region& r = *options.region;
        add("--region", std::to_string(r.x) + "," + std::to_string(r.y) + "," + std::to_string(r.width) + "," +
                            std::to_string(r.height));
    }
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
                    {"program_version", programVersion()},
                    {"device", report.device},
                    {"spp_done", samplesPerPixel(options, film)},
                    {"arguments", argumentList(options, camera, report)}};
    return json.dump(-1, ' ', false, Json::error_handler_t::replace); // names of files may be anything
}

} // namespace rt::app
