#include "Common/App/Session/Resume.h"

#include <algorithm>
#include <iomanip>
#include <limits>
#include <locale>
#include <sstream>
#include <vector>

#include <nlohmann/json.hpp>

#include "Common/Core/Error.h"
#include "Common/Core/Hash.h"
#include "Common/Core/Log.h"
#include "Common/Image/Checkpoint.h"
#include "Common/Render/Names.h"
#include "Common/Render/RenderParams.h"

namespace rt::app {
namespace {

using Json = nlohmann::ordered_json;

Json toJson(const scene::CameraDesc& camera) {
    const auto vector = [](const glm::dvec3& v) { return Json{v.x, v.y, v.z}; };
    return {{"look_from", vector(camera.lookFrom)},
            {"look_at", vector(camera.lookAt)},
            {"up", vector(camera.up)},
            {"vertical_fov", camera.verticalFov},
            {"defocus_angle", camera.defocusAngle},
            {"focus_distance", camera.focusDistance}};
}

// "0.5,0.52" s of the animation.
std::string shutterText(const EngineReport& report) {
    if (!report.shutter) return "off";
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << std::setprecision(std::numeric_limits<double>::max_digits10) << report.shutter->open << ','
         << report.shutter->close;
    return text.str();
}

// Everything that the samples of a pixel depend on, in the order in which a difference is best explained.
Json identity(const RenderSettings& settings, const scene::CompiledScene& scene, const EngineReport& report,
              std::uint64_t motionHash) {
    Json json = {{"engine", report.threads > 0 ? "cpu" : report.engine}, // threads and policies make no difference
                 {"width", settings.width},
                 {"height", settings.height},
                 {"seed", settings.seed},
                 {"replicates", settings.replicates},
                 {"max_depth", settings.maxDepth}};
    forEachMethod([&json](const char* key, const char*, const char*, const auto& table,
                          const auto& value) { json[key] = nameOf(table, value); },
                  settings);
    json["russian_roulette"] = settings.russianRoulette;
    json["shutter"] = shutterText(report);
    json["camera"] = toJson(scene.camera);
    json["scene_hash"] = hexText(scene.hash); // with a shutter, in its middle
    json["motion_hash"] = report.shutter ? hexText(motionHash) : "off";
    return json;
}

void checkIdentity(const std::string& file, nlohmann::json stored, const Json& wanted) {
    const std::vector<std::string> added = image::addLaterFields(stored);
    for (const auto& [field, value] : wanted.items()) {
        if (stored.at(field) == nlohmann::json(value)) continue;
        const bool isTold = std::ranges::find(added, field) == added.end();
        throw InputError(file + ": " + field + " is " + stored.at(field).dump() + " in the checkpoint" +
                         (isTold ? "" : " (of a program that had no choice)") + " but " + value.dump() + " now");
    }
}

// More samples may be asked for than before, but not fewer than there are; strata made for a known number allow no
// other.
void checkSpp(const std::string& file, std::uint32_t stored, const RenderSettings& settings, const image::Film& film) {
    const std::string now = std::to_string(settings.spp) + " now";
    if (settings.adaptive) {
        if (stored == settings.spp) return;
        throw InputError(file + ": spp is " + std::to_string(stored) +
                         " in the checkpoint, whose adaptive samples allow no other, but " + now);
    }
    if (isMadeForSpp(settings) && stored != settings.spp)
        throw InputError(file + ": spp is " + std::to_string(stored) +
                         " in the checkpoint, whose strata allow no other, but " + now);
    if (const std::uint64_t maximum = film.maxSamples(); maximum > settings.spp)
        throw InputError(file + ": spp is at " + std::to_string(maximum) + " in the checkpoint already but " + now);
}

} // namespace

void saveCheckpoint(const std::string& file, const RenderSettings& settings, const scene::CompiledScene& scene,
                    const EngineReport& report, std::uint64_t motionHash, std::optional<double> seconds,
                    const image::Film& film) {
    nlohmann::json header = identity(settings, scene, report, motionHash);
    header["spp"] = settings.spp;
    header["spp_is_known"] = settings.sppIsKnown;
    header["kernel"] = report.kernel;
    if (seconds) header[image::kSecondsField] = *seconds;
    image::writeCheckpoint(file, header, film);
}

image::Film loadCheckpoint(const std::string& file, RenderSettings& settings, const scene::CompiledScene& scene,
                           const EngineReport& report, std::uint64_t motionHash) try {
    image::Checkpoint checkpoint = image::readCheckpoint(file);
    const nlohmann::json& stored = checkpoint.render;
    checkIdentity(file, stored, identity(settings, scene, report, motionHash));
    const auto instructionSet = [](const std::string& kernel) { return kernel.substr(kernel.rfind('/') + 1); };
    if (report.threads > 0 && instructionSet(stored.at("kernel")) != instructionSet(report.kernel))
        logWarning(file + ": was made with another instruction set; the last bits may differ from those of one run");
    settings.secondMoments = checkpoint.film.desc().secondMoments;
    settings.sppIsKnown = stored.at("spp_is_known");
    checkSpp(file, stored.at("spp"), settings, checkpoint.film);
    return std::move(checkpoint.film);
} catch (const nlohmann::json::exception& error) {
    throw InputError(file + ": not a checkpoint of this program: " + error.what());
}

} // namespace rt::app
