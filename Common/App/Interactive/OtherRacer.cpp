#include "Common/App/Interactive/OtherRacer.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <utility>

#include <nlohmann/json.hpp>

#include "Common/App/OtherProgram.h"
#include "Common/Core/Error.h"
#include "Common/Core/Hash.h"
#include "Common/Image/Checkpoint.h"

namespace rt::app {
namespace {

constexpr double kSaves = 24, kMinSaveSeconds = 0.2; // of a whole race; between two

std::string exactText(double value) {
    std::ostringstream out;
    out.precision(std::numeric_limits<double>::max_digits10);
    out << value;
    return out.str();
}

} // namespace

OtherRacer::OtherRacer(const OtherJob& job, double seconds, const std::filesystem::path& folder)
    : program_(job.program), scene_(job.scene.source), sceneHash_(hexText(job.compiled->hash)) {
    std::vector<std::string> list = argumentsFor(job, folder_ / "picture.pfm", statistics());
    const std::string save = exactText(std::max(seconds / kSaves, kMinSaveSeconds));
    list.insert(list.end(),
                {"--time-limit", exactText(seconds), "--save-every", save, "--checkpoint", checkpoint().string()});
    child_.emplace(programFile(job.program, folder), list, messages());
}

std::optional<OtherRacer::News> OtherRacer::look() {
    const std::optional<FileFingerprint> mark = markOf(checkpoint().string());
    if (!mark || mark == seen_) return std::nullopt;
    seen_ = mark;
    image::Checkpoint read = image::readCheckpoint(checkpoint());
    if (read.render.value("scene_hash", std::string()) != sceneHash_)
        throw RenderError(scene_ + ": has changed since it was loaded here; load it again");
    News news;
    news.seconds = read.render.value(image::kSecondsField, 0.0);
    news.film = std::move(read.film);
    return news;
}

bool OtherRacer::hasEnded() {
    const std::optional<int> code = child_->exitCode();
    if (!code) return false;
    checkEnd(program_, *code, messages());
    return markOf(checkpoint().string()) == seen_;
}

OtherRacer::Device OtherRacer::device() const try {
    const nlohmann::json json = nlohmann::json::parse(textOf(statistics()));
    return {json.at("engine"), json.at("device"), json.at("device_is_software")};
} catch (const nlohmann::json::exception& error) {
    throw RenderError(program_ + ": its statistics cannot be read: " + error.what());
}

} // namespace rt::app
