#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <string>
#include <string_view>
#include <thread>

#include "Common/App/Platform.h"
#include "Common/Gui/Panels/EnginePanel.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Widgets.h"
#include "Common/Image/Film.h"

namespace rt::gui {
namespace {

// Of an image of this aspect ratio whose film, with the pictures made of it, leaves half of the machine's memory to
// others: one digit too many is not to end the program.
std::uint32_t mostWidth(double aspect) {
    constexpr double kPixelBytes = 100;
    const double least = 1024, side = image::kMaxImageSide * std::min(1.0, aspect);
    const double pixels = 0.5 * static_cast<double>(app::machineBytes()) / kPixelBytes;
    if (pixels == 0) return image::kMaxImageSide;
    return static_cast<std::uint32_t>(std::clamp(std::sqrt(pixels * aspect), least, std::max(least, side)));
}

void drawSize(Gui& gui) {
    app::SizeRequest& size = gui.settings.request.size;
    const app::RenderSettings& film = gui.state.settings;
    std::uint32_t width = size.width.value_or(film.width);
    const std::uint32_t most = std::max(width, mostWidth(static_cast<double>(film.width) / std::max(film.height, 1u)));
    if (inputCount("Width", "Pixels; the height follows from the aspect ratio", width, 1, most, 20)) {
        if (size.height && size.width) size.aspect = static_cast<double>(*size.width) / *size.height;
        size.width = width;
        size.height.reset();
    }
    struct Aspect {
        const char* name;
        double value; // 0: the scene's
    };
    constexpr Aspect kAspects[] = {{"From scene", 0}, {"1:1", 1},        {"5:4", 1.25},      {"4:3", 4.0 / 3},
                                   {"3:2", 1.5},      {"16:10", 1.6},    {"16:9", 16.0 / 9}, {"21:9", 21.0 / 9},
                                   {"3:4", 0.75},     {"9:16", 9.0 / 16}};
    const double ratio = size.aspect                 ? *size.aspect
                         : size.width && size.height ? static_cast<double>(*size.width) / *size.height
                                                     : 0;
    char current[32];
    std::snprintf(current, sizeof current, "%.3g : 1", ratio);
    const char* name = current;
    for (const Aspect& aspect : kAspects)
        if (std::abs(aspect.value - ratio) < 1e-9) name = aspect.name;
    row("Aspect ratio", "Width by height");
    if (ImGui::BeginCombo("##aspect", name, ImGuiComboFlags_HeightLarge)) {
        for (const Aspect& aspect : kAspects) {
            if (!ImGui::Selectable(aspect.name, name == aspect.name)) continue;
            if (!size.width) size.width = film.width;
            size.height.reset();
            size.aspect.reset();
            if (aspect.value > 0) size.aspect = aspect.value;
        }
        ImGui::EndCombo();
    }
}

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

// What has no effect stays in place, greyed: how lights are sampled where none are.
void drawMethods(app::RenderSettings& settings, Methods methods) {
    const bool areLightsSampled = settings.lightSampling != app::LightSampling::Bsdf;
    app::forEachMethod(
        [areLightsSampled, methods](const char* key, const char* title, const char* help, const auto& table,
                                    auto& value) {
            if (!isAmong(methods, key)) return;
            const bool isOfLights = std::string_view(key).find("light") != std::string_view::npos;
            const Disabled rest(isOfLights && !areLightsSampled && methods == Methods::Others);
            combo(title, sentence(help).c_str(), table, value);
        },
        settings);
}

void drawLights(app::RenderRequest& request) {
    checkbox("One-sided lights",
             "Quads and triangles emit from their front only. Off: from both sides. "
             "A light whose scene says which side it emits from is not concerned",
             request.oneSidedLights);
}

void drawFrames(app::RenderRequest& request) {
    checkbox(
        "Accumulate samples",
        "Between frames. On: samples add up in one image. Off: every frame is an image of its own, with other random "
        "numbers",
        request.accumulate);
    bool isAuto = request.samplesPerFrame == 0;
    if (checkbox("Auto frames", "Samples per frame: as many as there is time for between two frames", isAuto)) {
        request.samplesPerFrame = isAuto ? 0 : app::RenderRequest().samplesPerFrame;
    }
    const Disabled rest(isAuto);
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

void drawAdvanced(app::RenderRequest& request) {
    app::RenderSettings& settings = request.settings;
    inputCount("Max path depth", "Vertices of a path after the camera", settings.maxDepth, 1, 4096, 1);
    drawMethods(settings, Methods::Others);
    drawLights(request);
    checkbox("Russian roulette", "Ends dim paths early by chance; unbiased", settings.russianRoulette);
    inputCount("Seed", "The same seed gives the same image", settings.seed, 0, 0xffffffffu, 1);
    inputCount("Replicates", "Independent scramblings of the random numbers, for honest error estimates",
               settings.replicates, 1, 1024, 1);
    drawFrames(request);
    checkbox("Loop rendering", "Begins again when done, with the next seed", request.loop);
}

} // namespace

// What matters first, then the rest.
void drawRenderPanel(Gui& gui) {
    app::RenderRequest& request = gui.settings.request;
    app::RenderSettings& settings = request.settings;
    drawEnginePanel(gui);
    inputCount("Samples (SPP)", "Samples per pixel; every number is taken exactly", settings.spp, 1, 0x7fffffff, 10);
    drawMethods(settings, Methods::LightSampling);
    drawMethods(settings, Methods::Sampler);
    drawSize(gui);
    bool& isOpen = gui.settings.openPanels.try_emplace("advanced", false).first->second;
    ImGui::SetNextItemOpen(isOpen);
    isOpen = ImGui::TreeNodeEx("Advanced", ImGuiTreeNodeFlags_NoTreePushOnOpen | ImGuiTreeNodeFlags_SpanAvailWidth);
    if (isOpen) drawAdvanced(request);
}

} // namespace rt::gui
