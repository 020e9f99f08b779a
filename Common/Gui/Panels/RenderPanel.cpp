#include <cctype>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "Common/Gui/Panels/EnginePanel.h"
#include "Common/Gui/Panels/ImageSize.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr const char* kNoRays = "ray tracing is off, and the preview takes no samples";

// Of a line of --help.
std::string sentence(std::string text) {
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
    return text;
}

// A method of the table by its key, or all that are none of those two.
enum class Methods { LightSampling, Sampler, Others };
bool isAmong(Methods methods, std::string_view key) {
    if (key == "light_sampling") return methods == Methods::LightSampling;
    if (key == "sampler") return methods == Methods::Sampler;
    return methods == Methods::Others;
}

// The strategies for shapes of light: what they have in common is said once, so that their fields stand in line.
constexpr std::string_view kStrategy = "Sampling strategy for ";

bool isStrategy(std::string_view title) {
    return title.substr(0, kStrategy.size()) == kStrategy;
}

void drawStrategyHeading() {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(kStrategy.data(), kStrategy.data() + kStrategy.size());
}

std::string methodLabel(std::string_view title) {
    return isStrategy(title) ? "  " + std::string(title.substr(kStrategy.size())) : std::string(title);
}

// What has no effect stays in place, greyed: how lights are sampled where none are.
void drawMethods(app::RenderSettings& settings, Methods methods) {
    const bool areLightsSampled = settings.lightSampling != app::LightSampling::Bsdf;
    const app::RenderSettings defaults;
    bool isHeaded = false;
    app::forEachMethod(
        [&isHeaded, areLightsSampled, methods](const char* key, const char* title, const char* help, const auto& table,
                                               auto& value, const auto& byDefault) {
            if (!isAmong(methods, key)) return;
            const bool isOfLights = std::string_view(key).find("light") != std::string_view::npos;
            const Disabled rest(isOfLights && !areLightsSampled && methods == Methods::Others, "light sampling is off");
            if (isStrategy(title) && !std::exchange(isHeaded, true)) drawStrategyHeading();
            markNextRow(value != byDefault);
            combo(methodLabel(title).c_str(), sentence(help).c_str(), table, value);
        },
        settings, defaults);
}

void drawLights(app::RenderRequest& request) {
    markNextRow(!request.oneSidedLights);
    checkbox("One-sided lights",
             "Quads and triangles emit from their front only. Off: from both sides. "
             "A light whose scene says which side it emits from is not concerned",
             request.oneSidedLights);
}

void drawFrames(app::RenderRequest& request) {
    markNextRow(!request.accumulate);
    checkbox(
        "Accumulate samples",
        "Between frames. On: samples add up in one image. Off: every frame is an image of its own, with other random "
        "numbers",
        request.accumulate);
    bool isAuto = request.samplesPerFrame == 0;
    markNextRow(isAuto);
    if (checkbox("Auto frames", "Samples per frame: as many as there is time for between two frames", isAuto)) {
        request.samplesPerFrame = isAuto ? 0 : app::RenderRequest().samplesPerFrame;
    }
    const Disabled rest(isAuto, "frames take as many samples as there is time for");
    markNextRow(!isAuto && request.samplesPerFrame != app::RenderRequest().samplesPerFrame);
    std::uint32_t shown = isAuto ? app::RenderRequest().samplesPerFrame : request.samplesPerFrame;
    if (inputCount(
            "Samples per frame",
            "Samples per pixel from one picture to the next, at least. A picture that takes longer than half a second "
            "is shown while it is rendered; an old render shows four a second at most, and where the window is drawn "
            "by software, pictures come once or twice a second",
            shown, 1, 65536, 5)) {
        request.samplesPerFrame = shown;
    }
}

// Where 0 stands for none.
void drawBudget(const char* label, const char* tip, std::optional<double>& budget) {
    double value = budget.value_or(0);
    markNextRow(budget.has_value());
    if (!inputReal(label, tip, value, 0, 1e9, "%g", "none")) return;
    budget = value > 0 ? std::optional(value) : std::nullopt;
}

void drawSamples(Gui& gui) {
    app::RenderRequest& request = gui.settings.request;
    std::uint32_t& spp = request.settings.spp;
    constexpr std::uint32_t kMax = 0x7fffffff, kMore = 100;
    markNextRow(spp != app::RenderSettings().spp);
    inputCount("Samples (SPP)",
               "Samples per pixel; every number is taken exactly. More go on from those there are, unless strata or "
               "adaptive samples are made for one number",
               spp, 1, kMax, 10);
    std::uint32_t& depth = request.settings.maxDepth;
    markNextRow(depth != app::RenderSettings().maxDepth);
    inputCount("Max path depth", "Vertices of a path after the camera", depth, 1, 4096, 1);
    row("More samples", nullptr);
    if (button("+100 spp", "Goes on from the samples there are",
               {request.accumulate && spp <= kMax - kMore,
                request.accumulate ? "there are no more samples" : "frames are images of their own"})) {
        spp += kMore;
        gui.session.goOn();
    }
    drawBudget("Time limit (s)", "Ends the render after so many seconds of sampling; 0: no limit", request.timeLimit);
    drawBudget("Target relMSE",
               "Ends the render when its estimated relMSE is surely below (95 %); 0: none. Needs four replicates",
               request.targetError);
}

void drawAdvanced(app::RenderRequest& request) {
    app::RenderSettings& settings = request.settings;
    const app::RenderSettings defaults;
    drawMethods(settings, Methods::Others);
    drawLights(request);
    markNextRow(settings.russianRoulette != defaults.russianRoulette);
    checkbox("Russian roulette", "Ends dim paths early by chance; unbiased", settings.russianRoulette);
    markNextRow(settings.seed != defaults.seed);
    inputCount("Seed", "The same seed gives the same image", settings.seed, 0, 0xffffffffu, 1);
    markNextRow(settings.replicates != defaults.replicates);
    inputCount("Replicates", "Independent scramblings of the random numbers, for honest error estimates",
               settings.replicates, 1, 1024, 1);
    drawFrames(request);
    markNextRow(request.loop);
    checkbox("Loop rendering", "Begins again when done, with the next seed", request.loop);
}

// The features of --features are no setting of the panel.
void drawDefaults(Gui& gui) {
    app::RenderRequest defaults;
    defaults.settings.features = gui.settings.request.settings.features;
    const bool isChanged = gui.settings.request != defaults || gui.settings.engine != app::EngineChoice();
    if (button("Restore defaults", "Of all settings of this panel; a dot marks those that differ",
               {isChanged, "all are at their defaults"})) {
        gui.settings.request = defaults;
        gui.settings.engine = app::EngineChoice();
    }
}

} // namespace

// What matters first, then the rest. A preview has no samples and no paths: what is about them rests.
void drawRenderPanel(Gui& gui) {
    app::RenderSettings& settings = gui.settings.request.settings;
    const bool isPreview = gui.state.picture.isPreview;
    drawEnginePanel(gui);
    {
        const Disabled rest(isPreview, kNoRays);
        drawSamples(gui);
        drawMethods(settings, Methods::LightSampling);
        drawMethods(settings, Methods::Sampler);
    }
    drawImageSize(gui);
    bool& isOpen = gui.settings.openPanels.try_emplace("advanced", false).first->second;
    ImGui::SetNextItemOpen(isOpen);
    isOpen = ImGui::TreeNodeEx("Advanced", ImGuiTreeNodeFlags_NoTreePushOnOpen | ImGuiTreeNodeFlags_SpanAvailWidth);
    if (isOpen) {
        const Disabled rest(isPreview, kNoRays);
        drawAdvanced(gui.settings.request);
    }
    drawDefaults(gui);
}

} // namespace rt::gui
