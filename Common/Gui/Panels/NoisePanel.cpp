// Why a pixel is noisy: its samples, what their variance is made of, and the paths that brought most.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "Common/Core/Format.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Widgets.h"
#include "Common/Probe/PathsReport.h"
#include "Common/Shared/Base/Sampling.h"

namespace rt::gui {
namespace {

constexpr std::uint32_t kMostNoiseSamples = 65536, kMostListed = 256;
constexpr float kStripHeight = 5; // in heights of the font

// ---- the strip -----------------------------------------------------------------------------------------------------

// As wide as the panel: a bar for each sample, or where there are more than pixels for the brightest of several.
struct Strip {
    const probe::PathsResult& result;
    ImVec2 corner, size;
    float most = 0; // luminance

    std::size_t columns() const {
        return std::min(result.samples.size(), static_cast<std::size_t>(std::max(size.x, 1.0f)));
    }
    std::size_t firstOf(std::size_t column) const { return column * result.samples.size() / columns(); }
    std::size_t sampleOf(std::size_t column) const {
        return probe::brightestOf(result.samples, firstOf(column), firstOf(column + 1));
    }
    float leftOf(std::size_t column) const {
        return corner.x + size.x * static_cast<float>(column) / static_cast<float>(columns());
    }
};

void drawStripBars(const Strip& strip, const std::optional<std::uint32_t>& selected) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float bottom = strip.corner.y + strip.size.y;
    list.AddRectFilled(strip.corner, {strip.corner.x + strip.size.x, bottom}, ImGui::GetColorU32(ImGuiCol_FrameBg));
    for (std::size_t column = 0; column < strip.columns(); ++column) {
        const std::size_t sample = strip.sampleOf(column);
        const float left = strip.leftOf(column), right = strip.leftOf(column + 1);
        const float gap = right - left > 4 ? 1.0f : 0.0f;
        if (selected == sample)
            list.AddRectFilled({left, strip.corner.y}, {right, bottom}, ImGui::GetColorU32(ImGuiCol_HeaderActive));
        const float value = strip.result.samples[sample];
        if (!(value > 0) || !(strip.most > 0)) continue;
        const float height = std::max(strip.size.y * std::sqrt(value / strip.most), 1.0f);
        list.AddRectFilled({left, bottom - height}, {right - gap, bottom},
                           techniqueColor(strip.result.dominant[sample]));
    }
}

void drawStrip(NoisyPixel& noise, const probe::PathsResult& result) {
    if (result.samples.empty()) return;
    Strip strip{result,
                ImGui::GetCursorScreenPos(),
                {ImGui::GetContentRegionAvail().x, std::floor(kStripHeight * ImGui::GetFontSize())},
                0};
    for (const float sample : result.samples)
        if (std::isfinite(sample)) strip.most = std::max(strip.most, sample);
    const bool isClicked = ImGui::InvisibleButton("##strip", strip.size);
    drawStripBars(strip, noise.settings.selected);
    if (!ImGui::IsItemHovered()) return;
    const float place = std::clamp((ImGui::GetIO().MousePos.x - strip.corner.x) / strip.size.x, 0.0f, 0.99999f);
    const std::size_t sample = strip.sampleOf(static_cast<std::size_t>(place * static_cast<float>(strip.columns())));
    ImGui::SetTooltip("Sample %zu: luminance %.4g, mostly %s\nThe height is the root. Click to see its paths", sample,
                      static_cast<double>(result.samples[sample]),
                      app::titleOf(probe::kTechniques, result.dominant[sample]).c_str());
    if (!isClicked) return;
    const auto clicked = static_cast<std::uint32_t>(sample);
    noise.settings.selected = noise.settings.selected == clicked ? std::nullopt : std::optional<std::uint32_t>(clicked);
    noise.chosen.reset();
}

// ---- shares of the variance ----------------------------------------------------------------------------------------

void drawNoiseShare(const std::string& name, const char* tip, const probe::NoiseShare& share, ImU32 color) {
    const float width = ImGui::GetContentRegionAvail().x, height = std::floor(0.3f * ImGui::GetFontSize());
    ImGui::TextUnformatted(name.c_str());
    if (tip != nullptr) tooltip(tip);
    const std::string number = probe::shareText(share.share);
    ImGui::SameLine(ImGui::GetCursorPosX() + width - textWidth(number));
    ImGui::TextUnformatted(number.c_str());
    tooltip(formatted("of the variance; %.4g of the mean", share.mean).c_str());
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float length = std::max(width * static_cast<float>(std::clamp(share.share, 0.0, 1.0)), 1.0f);
    list.AddRectFilled(corner, {corner.x + width, corner.y + height}, ImGui::GetColorU32(ImGuiCol_FrameBg));
    list.AddRectFilled(corner, {corner.x + length, corner.y + height}, color);
    ImGui::Dummy({width, height});
}

void drawNoiseShares(const probe::PathsResult& result) {
    note("Variance by how the light was found");
    for (const probe::NoiseShare& share : sharesByTechnique(result)) {
        const char* help = nullptr;
        for (const auto& row : probe::kTechniques)
            if (row.value == share.technique) help = row.help;
        drawNoiseShare(app::titleOf(probe::kTechniques, share.technique), help, share, techniqueColor(share.technique));
    }
    note("Variance by bounces between camera and light");
    for (const probe::NoiseShare& share : sharesByBounces(result)) {
        const bool isPooled = share.bounces == probe::kPooledBounces;
        drawNoiseShare(std::to_string(share.bounces) + (isPooled ? " or more" : ""), nullptr, share,
                       ImGui::GetColorU32(ImGuiCol_PlotHistogram));
    }
}

// ---- paths ---------------------------------------------------------------------------------------------------------

std::string lightNameOf(const probe::FoundLight& found) {
    if (found.isSky) return "the sky";
    return found.light == shared::kNone ? "a lamp that is not sampled" : "light " + std::to_string(found.light);
}

std::string pathTipOf(const probe::ListedPath& path) {
    const probe::FoundLight& found = path.found;
    const auto value = [](float v) { return static_cast<double>(v); };
    std::string text =
        formatted("Sample %u, %s\nradiance %.4g %.4g %.4g\nthroughput %.4g %.4g %.4g\n", path.sample,
                  lightNameOf(found).c_str(), value(found.radiance.x), value(found.radiance.y), value(found.radiance.z),
                  value(found.throughput.x), value(found.throughput.y), value(found.throughput.z));
    if (found.selection > 0) text += formatted("chosen with probability %.4g\n", value(found.selection));
    if (found.lightPdf > 0) text += formatted("density of light sampling %.4g per steradian\n", value(found.lightPdf));
    if (found.directionPdf > 0)
        text += formatted("density of scattering %.4g per steradian\n", value(found.directionPdf));
    if (found.weight > 0) text += formatted("weight %.4g\n", value(found.weight));
    if (found.from[0] != 0 || found.from[1] != 0)
        text += formatted("of the pixel %+d, %+d from here\n", found.from[0], found.from[1]);
    return text + "Click to see it alone";
}

std::string figureOrDash(float density) {
    return density > 0 ? formatted("%.3g", static_cast<double>(density)) : "-";
}

void drawNoisePath(NoisyPixel& noise, std::size_t i, const probe::ListedPath& path) {
    const probe::FoundLight& found = path.found;
    ImGui::PushID(static_cast<int>(i));
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const bool isClicked =
        ImGui::Selectable(formatted("%.3g", static_cast<double>(shared::luminance(found.radiance))).c_str(),
                          noise.chosen == i, ImGuiSelectableFlags_SpanAllColumns);
    if (ImGui::IsItemHovered()) {
        noise.hovered = i;
        ImGui::SetTooltip("%s", pathTipOf(path).c_str());
    }
    if (isClicked) noise.chosen = noise.chosen == i ? std::nullopt : std::optional<std::size_t>(i);
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(std::to_string(found.bounces).c_str());
    ImGui::TableNextColumn();
    ImGui::PushStyleColor(ImGuiCol_Text, techniqueColor(found.technique));
    ImGui::TextUnformatted("|"); // its colour; names are in that of all texts
    ImGui::PopStyleColor();
    ImGui::SameLine(0, 4);
    ImGui::TextUnformatted(app::titleOf(probe::kTechniques, found.technique).c_str());
    for (const float density : {found.weight, found.lightPdf, found.directionPdf}) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(figureOrDash(density).c_str());
    }
    ImGui::PopID();
}

void drawNoisePaths(NoisyPixel& noise, const probe::PathsShown& shown) {
    const std::vector<probe::ListedPath>& paths = shown.paths();
    note(shown.result.settings.selected
             ? "All paths of sample " + std::to_string(*shown.result.settings.selected) + " that found light"
             : std::string("The brightest paths of all samples"));
    constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_BordersInnerH | ImGuiTableFlags_SizingFixedFit |
                                       ImGuiTableFlags_ScrollX | ImGuiTableFlags_ScrollY;
    const auto rows = static_cast<float>(std::clamp<std::size_t>(paths.size(), 2, 8) + 2);
    if (!ImGui::BeginTable("##paths", 6, kFlags, {0, rows * ImGui::GetTextLineHeightWithSpacing()})) return;
    ImGui::TableSetupScrollFreeze(0, 1);
    for (const char* title : {"Luminance", "Bounces", "Found by", "Weight", "pdf lights", "pdf BSDF"})
        ImGui::TableSetupColumn(title);
    ImGui::TableHeadersRow();
    for (std::size_t i = 0; i < paths.size(); ++i) drawNoisePath(noise, i, paths[i]);
    ImGui::EndTable();
}

// ---- the answer ----------------------------------------------------------------------------------------------------

probe::PathsPlace noisePlaceOf(const probe::PathsState& state) {
    return {state.wish.scene->id, state.wish.pixel, state.wish.rendering};
}

void drawNoiseAnswer(Gui& gui, const probe::PathsState& state) {
    const probe::PathsResult& result = state.result.result;
    note(formatted("Pixel %u, %u: %zu samples%s", state.wish.pixel[0], state.wish.pixel[1], result.samples.size(),
                   result.isDone ? "" : " ..."));
    const double relative = result.mean > 0 ? 100 * result.standardError() / result.mean : 0;
    ImGui::TextUnformatted(
        formatted("Mean %.4g +- %.2g (%.2g %%)", result.mean, result.standardError(), relative).c_str());
    tooltip(formatted("Luminance, and its standard error as for independent samples. Variance of a sample: %.4g",
                      result.variance)
                .c_str());
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(adviceOf(result, state.wish.rendering).c_str());
    ImGui::PopTextWrapPos();
    drawStrip(gui.noise, result);
    if (!result.shares.empty()) {
        drawNoisePaths(gui.noise, state.result);
        drawNoiseShares(result);
    }
    for (const std::string& text : notesOf(result, state.wish.rendering)) note(text);
}

void drawNoiseSettings(NoisyPixel& noise) {
    checkbox("Draw paths", "Over the picture: what is hidden is dim, a disk is at the light", noise.drawsPaths);
    inputCount("Samples", "To trace again, from the first one on", noise.settings.samples, 2, kMostNoiseSamples, 64);
    auto listed = static_cast<std::uint32_t>(noise.settings.listed);
    if (inputCount("Paths", "To list and to draw, the brightest ones", listed, 1, kMostListed, 4))
        noise.settings.listed = listed;
    if (noise.settings.selected && *noise.settings.selected >= noise.settings.samples) noise.settings.selected.reset();
}

} // namespace

void drawNoisePanel(Gui& gui) {
    if (!gui.state.scene || !gui.state.picture.image) return note("There is no picture yet");
    NoisyPixel& noise = gui.noise;
    noise.isShown = true;
    noise.hovered.reset();
    const float space = ImGui::GetStyle().ItemSpacing.x, width = (ImGui::GetContentRegionAvail().x - space) / 2;
    drawPickButton(noise, "Pick a pixel", width);
    const auto state = noise.point ? gui.paths.state() : nullptr;
    const bool hasAnswer = state && state->whyNot.empty();
    ImGui::SameLine(0, space);
    if (button("Copy report", "As ray-tracing-image paths prints it", Usable{hasAnswer, "no pixel was picked yet"},
               width))
        ImGui::SetClipboardText(textOf(state->result.result, noisePlaceOf(*state)).c_str());
    if (!noise.point) {
        gui.paths.wish(std::nullopt);
        return note("Why a pixel is noisy: its samples are traced again, and the paths that bring most are drawn");
    }
    gui.paths.wish(noiseWishAt(gui, *noise.point));
    if (hasAnswer)
        drawNoiseAnswer(gui, *state);
    else
        note(state ? state->whyNot : "Working ...");
    drawNoiseSettings(noise);
}

} // namespace rt::gui
