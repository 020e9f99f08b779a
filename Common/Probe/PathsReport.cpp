#include "Common/Probe/PathsReport.h"

#include <algorithm>
#include <cmath>

#include "Common/Core/Format.h"
#include "Common/Shared/Base/Sampling.h"
#include "Common/Shared/Texture/Color.h"

namespace rt::probe {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMost = 0.5;      // of the variance: that is most of it
constexpr double kOneSample = 0.5; // likewise, of one sample

std::string bouncesText(std::uint32_t bounces) {
    if (bounces == 0) return "without a bounce";
    if (bounces == 1) return "after 1 bounce";
    return "after " + std::to_string(bounces) + (bounces == kPooledBounces ? " bounces or more" : " bounces");
}

// What is off, and would find this light otherwise.
std::string remedyFor(const NoiseShare& most, const app::RenderSettings& rendering) {
    const bool aims =
        rendering.lightSampling == app::LightSampling::Mis || rendering.lightSampling == app::LightSampling::MisBalance;
    switch (most.technique) {
        case Technique::Scattering:
            if (!aims) return "Light sampling by MIS would aim at lamps.";
            return "Light sampling is on: this light is of lamps that it leaves out, or that it chooses too rarely "
                   "here.";
        case Technique::Mixture:
            return "MIS would weigh each of both samples by itself.";
        case Technique::BehindSpecular:
            if (aims && !rendering.specularConnections) return "Glass connections would aim at it by way of spheres.";
            return "Light sampling knows no way through mirrors and glass.";
        case Technique::LightSampling:
            if (rendering.lightSelection != app::LightSelection::Contribution)
                return "Choosing lights by contribution may help.";
            if (most.bounces > 1 && rendering.pathReuse == app::PathReuse::Off)
                return "It is indirect light: path reuse may help.";
            return "";
        case Technique::Seen:
            return rendering.edgeRays ? "" : "Edge rays may help, where it is the edge of a light.";
        case Technique::SharedPath:
            return "Pixels share their paths here: without path reuse the shares tell how a neighbour found it.";
        default:
            return "";
    }
}

Json jsonOf(const shared::vec3& v) {
    return {v.x, v.y, v.z};
}

Json jsonOf(const NoiseShare& share) {
    return {{"mean", share.mean}, {"share", share.share}};
}

Json indexOrNull(std::uint32_t index) {
    return index == shared::kNone ? Json() : Json(index);
}

Json jsonOf(const ListedPath& path) {
    const FoundLight& found = path.found;
    Json line = Json::array();
    for (const PathPoint& point : found.line) line.push_back(jsonOf(point.position));
    return {{"sample", path.sample},
            {"technique", app::nameOf(kTechniques, found.technique)},
            {"bounces", found.bounces},
            {"radiance", jsonOf(found.radiance)},
            {"throughput", jsonOf(found.throughput)},
            {"light", indexOrNull(found.light)},
            {"sky", found.isSky},
            {"selection", found.selection},
            {"light_pdf", found.lightPdf},
            {"direction_pdf", found.directionPdf},
            {"weight", found.weight > 0 ? Json(found.weight) : Json()},
            {"from_pixel", {found.from[0], found.from[1]}},
            {"line", std::move(line)}};
}

Json jsonOf(const std::vector<ListedPath>& paths) {
    Json all = Json::array();
    for (const ListedPath& path : paths) all.push_back(jsonOf(path));
    return all;
}

void addRows(std::string& text, const char* title, const std::vector<NoiseShare>& shares, bool byBounces) {
    text += formatted("\n%-28s %12s %10s\n", title, "mean", "variance");
    for (const NoiseShare& share : shares) {
        const std::string name = byBounces ? bouncesText(share.bounces) : app::titleOf(kTechniques, share.technique);
        text += formatted("%-28s %12.5g %10s\n", name.c_str(), share.mean, shareText(share.share).c_str());
    }
}

std::string numberOrDash(float value) {
    return value > 0 ? formatted("%.4g", static_cast<double>(value)) : "-";
}

} // namespace

std::string adviceOf(const PathsResult& result, const app::RenderSettings& rendering) {
    if (result.shares.empty()) return "No sample found any light.";
    if (!(result.variance > 0)) return "All samples are alike.";
    const NoiseShare& cell = result.shares.front();
    NoiseShare most = sharesByTechnique(result).front();
    std::string what = app::titleOf(kTechniques, most.technique);
    if (cell.share >= kMost) {
        most = cell;
        what = app::titleOf(kTechniques, most.technique) + " " + bouncesText(most.bounces);
    }
    std::string text = shareText(most.share) + " of the variance is light found by: " + what + ".";
    const auto [sample, share] = result.worst();
    if (share >= kOneSample && result.samples.size() > 2)
        text += " Sample " + std::to_string(sample) + " alone has " + shareText(share) + " of it.";
    const std::string remedy = most.share >= kMost ? remedyFor(most, rendering) : "";
    return remedy.empty() ? text : text + " " + remedy;
}

std::vector<std::string> notesOf(const PathsResult& result, const app::RenderSettings& rendering) {
    std::vector<std::string> notes;
    if (result.sharesPaths)
        notes.emplace_back(
            "Neighbouring pixels share paths: those of its group were traced, too, and count as theirs. Samples of "
            "neighbours depend on each other.");
    if (rendering.sampler != app::SamplerKind::Independent)
        notes.emplace_back("The standard error is that of independent samples; stratified ones do better.");
    if (rendering.adaptive)
        notes.emplace_back("The film may give this pixel or its neighbours other numbers of samples.");
    if (result.dropped > 0)
        notes.push_back(std::to_string(result.dropped) + " samples are not finite and are dropped.");
    return notes;
}

std::string shareText(double share) {
    const bool isZero = std::abs(share) < 0.0005; // has no sign
    return formatted("%.*f %%", std::abs(share) < 0.1 ? 1 : 0, isZero ? 0.0 : 100 * share);
}

std::string textOf(const FoundLight& found) {
    return app::titleOf(kTechniques, found.technique) + " " + bouncesText(std::min(found.bounces, kPooledBounces));
}

Json figuresOf(const PathsResult& result, const PathsPlace& place) {
    Json settings = Json::object(), techniques = Json::object(), bounces = Json::array(), parts = Json::array();
    app::forEachMethod([&settings](const char* key, const char*, const char*, const auto& table,
                                   const auto& value) { settings[key] = app::nameOf(table, value); },
                       place.rendering);
    for (const NoiseShare& share : sharesByTechnique(result))
        techniques[app::nameOf(kTechniques, share.technique)] = jsonOf(share);
    for (const NoiseShare& share : sharesByBounces(result))
        bounces.push_back({{"bounces", share.bounces}, {"mean", share.mean}, {"share", share.share}});
    for (const NoiseShare& share : result.shares)
        parts.push_back({{"technique", app::nameOf(kTechniques, share.technique)},
                         {"bounces", share.bounces},
                         {"mean", share.mean},
                         {"share", share.share}});
    Json samples = Json::array();
    for (const float sample : result.samples) samples.push_back(std::isfinite(sample) ? Json(sample) : Json());
    Json figures = {{"version", 1},
                    {"scene", place.scene},
                    {"pixel", {place.pixel[0], place.pixel[1]}},
                    {"settings", std::move(settings)},
                    {"samples", result.samples.size()},
                    {"dropped", result.dropped},
                    {"radiance", {result.radiance.x, result.radiance.y, result.radiance.z}},
                    {"mean", result.mean},
                    {"variance", result.variance},
                    {"standard_error", result.standardError()},
                    {"advice", adviceOf(result, place.rendering)},
                    {"notes", notesOf(result, place.rendering)},
                    {"techniques", std::move(techniques)},
                    {"bounces", std::move(bounces)},
                    {"parts", std::move(parts)},
                    {"paths", jsonOf(result.listed)},
                    {"luminance", std::move(samples)}};
    if (result.settings.selected) figures["selected"] = jsonOf(result.selected);
    return figures;
}

std::string textOf(const PathsResult& result, const PathsPlace& place) {
    std::string text = place.scene + ", pixel " + std::to_string(place.pixel[0]) + "," +
                       std::to_string(place.pixel[1]) + ", " + std::to_string(result.samples.size()) + " samples\n";
    text += formatted("radiance %.6g %.6g %.6g\n", result.radiance.x, result.radiance.y, result.radiance.z);
    text += formatted("luminance: mean %.6g, variance of a sample %.6g, standard error %.6g\n", result.mean,
                      result.variance, result.standardError());
    text += adviceOf(result, place.rendering) + "\n";
    for (const std::string& note : notesOf(result, place.rendering)) text += note + "\n";
    addRows(text, "By technique", sharesByTechnique(result), false);
    addRows(text, "By bounces", sharesByBounces(result), true);
    const auto& paths = result.settings.selected ? result.selected : result.listed;
    text += formatted("\n%-12s %-8s %-40s %6s %10s %10s %10s %7s\n", "luminance", "sample", "path", "light", "chosen",
                      "light pdf", "pdf", "weight");
    for (const ListedPath& path : paths) {
        const FoundLight& found = path.found;
        const std::string light = found.isSky                    ? "sky"
                                  : found.light == shared::kNone ? "-"
                                                                 : std::to_string(found.light);
        text += formatted("%-12.5g %-8u %-40s %6s %10s %10s %10s %7s\n",
                          static_cast<double>(shared::luminance(found.radiance)), path.sample, textOf(found).c_str(),
                          light.c_str(), numberOrDash(found.selection).c_str(), numberOrDash(found.lightPdf).c_str(),
                          numberOrDash(found.directionPdf).c_str(), numberOrDash(found.weight).c_str());
    }
    return text;
}

std::size_t brightestOf(std::span<const float> samples, std::size_t first, std::size_t end) {
    std::size_t best = first;
    for (std::size_t i = first + 1; i < end; ++i)
        if (samples[i] > samples[best] || std::isnan(samples[best])) best = i;
    return best;
}

image::Image stripOf(const PathsResult& result) {
    constexpr std::uint32_t kHeight = 96, kLeastWidth = 512, kMostWidth = 8192;
    const auto count = static_cast<std::uint32_t>(std::max<std::size_t>(result.samples.size(), 1));
    const std::uint32_t bar = std::max(kLeastWidth / count, 1u);
    image::Image strip(std::min(count * bar, kMostWidth), kHeight);
    std::fill(strip.data.begin(), strip.data.end(), 0.02f);
    float most = 0;
    for (const float sample : result.samples)
        if (std::isfinite(sample)) most = std::max(most, sample);
    if (!(most > 0)) return strip;
    const auto firstOf = [&](std::uint32_t column) { return std::size_t{column} * count / strip.width; };
    for (std::uint32_t x = 0; x < strip.width; ++x) {
        const std::size_t i = brightestOf(result.samples, firstOf(x), firstOf(x + 1));
        if (!(result.samples[i] > 0)) continue;
        const float share = std::sqrt(std::min(result.samples[i] / most, 1.0f));
        const auto height = static_cast<std::uint32_t>(std::lround(kHeight * share));
        const TechniqueColor color = colorOf(result.dominant[i]);
        const std::uint8_t encoded[3] = {color.r, color.g, color.b};
        for (std::uint32_t y = kHeight - height; y < kHeight; ++y)
            for (int c = 0; c < 3; ++c)
                strip.pixel(x, y)[c] = shared::srgbToLinear(static_cast<float>(encoded[c]) / 255.0f);
    }
    return strip;
}

} // namespace rt::probe
