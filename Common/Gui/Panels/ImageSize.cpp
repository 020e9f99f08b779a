#include "Common/Gui/Panels/ImageSize.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "Common/App/Platform.h"
#include "Common/Core/Format.h"
#include "Common/Gui/Theme.h"
#include "Common/Gui/Widgets.h"
#include "Common/Image/Film.h"

namespace rt::gui {
namespace {

constexpr double kPixelBytes = 100; // of a film, with the pictures made of it
constexpr double kDeviceBytes = 60; // likewise, of the device that the GPU engine renders on, where it has them
constexpr double kAskedBytes = 1e9; // from here on it is asked for

struct Size {
    std::uint32_t width = 0, height = 0;
    double pixels() const { return static_cast<double>(width) * height; }
    double bytes() const { return kPixelBytes * pixels(); }
};

// Of an image of this aspect ratio whose memory, with that of other viewports, leaves half of the machine's to others:
// one digit too many is not to end the program.
std::uint32_t maxWidth(const Gui& gui, double aspect) {
    const double minimum = 1024, side = image::kMaxImageSide * std::min(1.0, aspect);
    const double all = 0.5 * static_cast<double>(app::machineBytes()) / kPixelBytes;
    const double pixels = std::max(0.0, all - gui.otherPixels);
    if (all == 0) return image::kMaxImageSide;
    return static_cast<std::uint32_t>(std::clamp(std::sqrt(pixels * aspect), minimum, std::max(minimum, side)));
}

std::string sizeText(const Size& size) {
    return std::to_string(size.width) + " x " + std::to_string(size.height);
}
std::string memoryText(const Gui& gui, const Size& size) {
    const auto text = [&size](double bytes) { return bytesText(static_cast<std::uint64_t>(bytes * size.pixels())); };
    return "about " + text(kPixelBytes) + " of memory" +
           (gui.isGpu ? ", and up to " + text(kDeviceBytes) + " of the device's" : "");
}

double aspectOf(const Gui& gui) {
    const app::SizeRequest& size = gui.settings.request.size;
    if (size.aspect) return *size.aspect;
    if (size.width && size.height) return static_cast<double>(*size.width) / *size.height;
    return 0; // the scene's
}
double filmAspect(const app::RenderSettings& film) {
    return static_cast<double>(std::max(film.width, 1u)) / std::max(film.height, 1u);
}

// The size that the request comes to, as far as it is known here.
Size sizeOf(const Gui& gui, const app::SizeRequest& request) {
    const app::RenderSettings& film = gui.state.settings;
    const double aspect = request.aspect.value_or(filmAspect(film));
    const std::uint32_t width = request.width.value_or(film.width);
    const auto height = static_cast<std::uint32_t>(std::lround(width / aspect));
    return {width, request.height.value_or(std::max(1u, height))};
}

// At once, or after a question where it is large and larger than what there is.
void wish(Gui& gui, app::SizeRequest request) {
    const Size size = sizeOf(gui, request), now{gui.state.settings.width, gui.state.settings.height};
    const bool isMuch = size.bytes() + kPixelBytes * gui.otherPixels > kAskedBytes;
    const bool isAsked = isMuch && size.bytes() > now.bytes();
    gui.askedSize = isAsked ? std::optional(request) : std::nullopt;
    if (!isAsked) gui.settings.request.size = request;
}

void drawQuestion(Gui& gui) {
    if (!gui.askedSize) return;
    const Size size = sizeOf(gui, *gui.askedSize);
    wrapped(sizeText(size) + " pixels take " + memoryText(gui, size) + ".", noticeColor(gui.settings.colorMode));
    if (button("Render at this size", "Stop gives it up while it is prepared", true)) {
        gui.settings.request.size = *gui.askedSize;
        gui.askedSize.reset();
    }
    besideIfItFits(buttonWidth("Keep the size"));
    if (button("Keep the size", nullptr, true)) gui.askedSize.reset();
}

std::uint32_t limited(Gui& gui, const char* what, std::uint32_t value, std::uint32_t maximum) {
    if (value > maximum)
        gui.say(std::string(what) + " " + std::to_string(value) + " is more than the most here, " +
                std::to_string(maximum));
    return std::clamp(value, 1u, maximum);
}

void drawWidthAndHeight(Gui& gui) {
    const app::SizeRequest& size = gui.settings.request.size;
    const app::RenderSettings& film = gui.state.settings;
    const double aspect = filmAspect(film);
    const Size now{film.width, film.height};
    const std::uint32_t maxHere = std::max(film.width, maxWidth(gui, aspect));
    const auto tip = [&](const char* other, std::uint32_t maximum) {
        return std::string("Pixels; the ") + other + " follows from the aspect ratio. At most " +
               std::to_string(maximum) + " here: a side has " + std::to_string(image::kMaxImageSide) +
               ", and an image takes half of this machine's memory. " + sizeText(now) + " take " + memoryText(gui, now);
    };
    std::uint32_t width = size.width.value_or(film.width);
    markNextRow(size.width != app::SizeRequest().width);
    if (inputCount("Width", tip("height", maxHere).c_str(), width, 1, 0xffffffffu, 20)) {
        app::SizeRequest request = size;
        if (size.height && size.width) request.aspect = aspect;
        request.width = limited(gui, "Width", width, maxHere);
        request.height.reset();
        wish(gui, request);
    }
    std::uint32_t height = film.height;
    const auto maxHigh = static_cast<std::uint32_t>(std::max(1.0, maxHere / aspect));
    if (inputCount("Height", tip("width", maxHigh).c_str(), height, 1, 0xffffffffu, 20)) {
        app::SizeRequest request = size;
        request.aspect = aspect;
        request.width = static_cast<std::uint32_t>(
            std::clamp<long>(std::lround(limited(gui, "Height", height, maxHigh) * aspect), 1, maxHere));
        request.height.reset();
        wish(gui, request);
    }
}

void drawPresets(Gui& gui) {
    constexpr Size kPresets[] = {{600, 600},   {1024, 1024}, {2048, 2048}, {1280, 720},
                                 {1920, 1080}, {2560, 1440}, {3840, 2160}, {1080, 1920}};
    row("Size preset", "Width and height");
    const Size now{gui.state.settings.width, gui.state.settings.height};
    if (!ImGui::BeginCombo("##preset", sizeText(now).c_str(), ImGuiComboFlags_HeightLarge)) return;
    for (const Size& preset : kPresets) {
        const bool isNow = preset.width == now.width && preset.height == now.height;
        if (ImGui::Selectable(sizeText(preset).c_str(), isNow)) wish(gui, {preset.width, preset.height, {}});
        tooltip(("Takes " + memoryText(gui, preset)).c_str());
    }
    ImGui::EndCombo();
}

void drawAspect(Gui& gui) {
    struct Aspect {
        const char* name;
        double value; // 0: the scene's
    };
    constexpr Aspect kAspects[] = {{"From scene", 0}, {"1:1", 1},        {"5:4", 1.25},      {"4:3", 4.0 / 3},
                                   {"3:2", 1.5},      {"16:10", 1.6},    {"16:9", 16.0 / 9}, {"21:9", 21.0 / 9},
                                   {"3:4", 0.75},     {"9:16", 9.0 / 16}};
    const double ratio = aspectOf(gui);
    const std::string current = formatted("%.3g : 1", ratio);
    const char* name = current.c_str();
    for (const Aspect& aspect : kAspects)
        if (std::abs(aspect.value - ratio) < 1e-9) name = aspect.name;
    markNextRow(ratio > 0);
    row("Aspect ratio", "Width by height");
    if (!ImGui::BeginCombo("##aspect", name, ImGuiComboFlags_HeightLarge)) return;
    for (const Aspect& aspect : kAspects) {
        if (!ImGui::Selectable(aspect.name, name == aspect.name)) continue;
        app::SizeRequest request = gui.settings.request.size;
        if (!request.width) request.width = gui.state.settings.width;
        request.height.reset();
        request.aspect.reset();
        if (aspect.value > 0) {
            request.aspect = aspect.value;
            request.width = std::min(*request.width, maxWidth(gui, aspect.value));
        }
        wish(gui, request);
    }
    ImGui::EndCombo();
}

// In as many viewports of the present size as there will be more.
double viewportPixels(const Gui& gui, std::size_t count) {
    const Size now{gui.state.settings.width, gui.state.settings.height};
    const std::size_t more = count > gui.viewportCount() ? count - gui.viewportCount() : 0;
    return gui.otherPixels + static_cast<double>(more + 1) * now.pixels();
}

} // namespace

void wishViewports(Gui& gui, std::size_t count) {
    gui.askedViewports.reset();
    if (count <= gui.viewportCount() || kPixelBytes * viewportPixels(gui, count) <= kAskedBytes) {
        gui.wantedViewports = count;
        return;
    }
    gui.askedViewports = count;
    gui.settings.showPanels = gui.settings.openPanels["view"] = true; // where it is asked
    gui.revealPanel = "view";
}

void drawViewportQuestion(Gui& gui) {
    if (!gui.askedViewports) return;
    const double bytes = kPixelBytes * viewportPixels(gui, *gui.askedViewports);
    wrapped(std::to_string(*gui.askedViewports) + " pictures of this size take about " +
                bytesText(static_cast<std::uint64_t>(bytes)) + " of memory.",
            noticeColor(gui.settings.colorMode));
    if (button("Open them", nullptr, true)) gui.wantedViewports = *std::exchange(gui.askedViewports, std::nullopt);
    besideIfItFits(buttonWidth("Keep what there is"));
    if (button("Keep what there is", nullptr, true)) gui.askedViewports.reset();
}

void drawImageSize(Gui& gui) {
    drawWidthAndHeight(gui);
    drawQuestion(gui);
    drawPresets(gui);
    drawAspect(gui);
}

} // namespace rt::gui
