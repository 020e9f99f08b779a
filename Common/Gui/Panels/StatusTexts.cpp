#include "Common/Gui/Panels/StatusTexts.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "Common/Gui/Panels/RunTexts.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

using app::Activity;

constexpr const char* kBetween = "   |   ";

const char* activityText(Activity activity) {
    switch (activity) {
        case Activity::Preparing:
            return "preparing";
        case Activity::Rendering:
            return "rendering";
        case Activity::Paused:
            return "paused";
        case Activity::Stopped:
            return "stopped";
        case Activity::Finished:
            return "done";
        case Activity::Failed:
            break;
    }
    return "failed";
}

std::string timeLeft(const app::SessionState& state, double timeLimit) {
    const app::RenderStatus& status = state.status;
    if (state.activity != Activity::Rendering || status.samplesDone == 0 || state.renderSeconds <= 0) return "";
    const double rate = static_cast<double>(status.samplesDone) / state.renderSeconds;
    auto left = static_cast<double>(status.samplesTotal - std::min(status.samplesTotal, status.samplesDone)) / rate;
    // A render that goes on beyond its limit has as much time again.
    if (timeLimit > 0) left = std::min(left, timeLimit - std::fmod(state.renderSeconds, timeLimit));
    return ", " + roughDuration(left) + " left";
}

std::string joined(std::initializer_list<std::string> parts) {
    std::string text;
    for (const std::string& part : parts) {
        if (part.empty()) continue;
        if (!text.empty()) text += kBetween;
        text += part;
    }
    return text;
}

ProgressTexts progressOfRace(const app::RaceState& race) {
    using Phase = app::RaceState::Phase;
    ProgressTexts texts;
    switch (race.phase) {
        case Phase::Preparing:
            texts.bar = "race";
            texts.line = race.stage;
            return texts;
        case Phase::Reference:
            texts.share = static_cast<float>(std::min(1.0, race.referenceSeconds / race.referenceWanted));
            texts.bar = "reference";
            texts.line = "Rendering the race's reference: " + roughDuration(race.referenceSeconds) + " of at least " +
                         roughDuration(race.referenceWanted);
            return texts;
        case Phase::Running:
        case Phase::Over:
            break;
    }
    double slowest = race.seconds; // of those that are under way
    for (const app::RaceLane& lane : race.lanes)
        if (!lane.isOut) slowest = std::min(slowest, lane.seconds);
    texts.share = static_cast<float>(std::min(1.0, slowest / race.seconds));
    texts.bar = "race: " + shortDuration(slowest) + " of " + shortDuration(race.seconds);
    const std::string end = race.ending.empty() ? "race over" : "race over: " + race.ending;
    texts.line = race.phase == Phase::Over ? end : "race: each has had that much";
    return texts;
}

// Of the entrant that is shown.
std::vector<std::string> chipsOfRace(const app::SessionState& state) {
    const app::RaceLane& lane = state.race->lanes[state.race->shown];
    std::vector<std::string> texts{"Race: " + lane.name, std::to_string(state.picture.spp) + " spp"};
    if (lane.curve.empty()) return texts;
    texts.push_back(shortDuration(lane.curve.back().seconds));
    texts.push_back("relMSE " + errorText(lane.curve.back().relmse) + ", measured");
    return texts;
}

} // namespace

ProgressTexts progressOf(const app::SessionState& state, double timeLimit) {
    ProgressTexts texts;
    if (state.race && state.race->isShown) return progressOfRace(*state.race);
    const app::RenderStatus& status = state.status;
    if (!state.stage.empty()) {
        texts.bar = "preparing";
        texts.line = state.stage + " ... " + shortDuration(state.stageSeconds);
        return texts;
    }
    const bool isPreview = state.picture.isPreview;
    texts.line = isPreview ? "preview: ray tracing is off" : activityText(state.activity);
    if (state.activity == Activity::Preparing) {
        texts.bar = "preparing";
        return texts;
    }
    const double share = status.samplesTotal > 0
                             ? static_cast<double>(status.samplesDone) / static_cast<double>(status.samplesTotal)
                             : 0;
    const std::uint64_t pixels = std::uint64_t{state.settings.width} * state.settings.height;
    const std::uint64_t spp = pixels > 0 ? status.samplesDone / pixels : 0;
    texts.share = static_cast<float>(std::min(1.0, share));
    // All of them are 100 % and nothing less is.
    const int percent = static_cast<int>(std::floor(100 * std::min(1.0, share)));
    texts.bar =
        std::to_string(spp) + " / " + std::to_string(state.settings.spp) + " spp   " + std::to_string(percent) + " %";
    if (!isPreview) texts.line += timeLeft(state, timeLimit);
    return texts;
}

std::vector<std::string> chipTexts(const app::SessionState& state, bool isGpu, bool isBarShown) {
    const std::string program = isGpu ? "GPU " : "CPU ";
    if (state.picture.isPreview) return {program + "preview"};
    if (state.picture.isOfRace && state.race) return chipsOfRace(state);
    std::vector<std::string> texts{program + state.report.engine};
    const std::string wanted = isBarShown ? "" : " / " + std::to_string(state.settings.spp);
    texts.push_back(state.picture.spp > 0 ? std::to_string(state.picture.spp) + wanted + " spp" : "draft");
    if (state.renderSeconds > 0) texts.push_back(shortDuration(state.renderSeconds));
    if (state.picture.isLive)
        texts.emplace_back("denoised, live");
    else if (state.picture.isDenoised && !state.denoisedRelmse)
        texts.emplace_back("denoised");
    const std::string how = state.curve.empty() ? ", estimated" : ", measured";
    if (state.relmse)
        texts.push_back((state.denoisedRelmse ? "raw relMSE " : "relMSE ") + errorText(*state.relmse) + how);
    if (state.denoisedRelmse) texts.push_back("denoised relMSE " + errorText(*state.denoisedRelmse) + how);
    return texts;
}

StatusParts statusOf(const app::SessionState& state) {
    StatusParts parts;
    parts.title = state.scene ? state.scene->title : "no scene";
    parts.size = std::to_string(state.settings.width) + " x " + std::to_string(state.settings.height);
    if (state.renderSeconds > 0)
        parts.rate = withPrefix(static_cast<double>(state.status.samplesDone) / state.renderSeconds) + " samples/s";
    parts.engine = state.report.engine.empty() ? "starting" : state.report.engine;
    parts.device = state.report.device + (state.report.isSoftware ? " (software)" : "");
    return parts;
}

std::string fitStatus(const StatusParts& parts, float width, const TextWidth& widthOf) {
    constexpr std::size_t kMinDevice = 8; // letters and dots: less of a name tells nothing
    const std::string withEngine = joined({parts.title, parts.size, parts.rate, parts.engine});
    std::string all = joined({withEngine, parts.device});
    if (widthOf(all) <= width) return all;
    if (widthOf(withEngine) <= width) {
        const std::string device = elided(parts.device, width - widthOf(withEngine + kBetween), widthOf);
        return device.size() >= kMinDevice ? joined({withEngine, device}) : withEngine;
    }
    const std::string figures = joined({parts.size, parts.rate});
    std::string rest = joined({parts.title, figures});
    if (widthOf(rest) <= width) return rest;
    const std::string title = elided(parts.title, width - widthOf(kBetween + figures), widthOf);
    return elided(joined({title, figures}), width, widthOf);
}

} // namespace rt::gui
