// How bright the picture is: its luminance in stops about white, as it is exposed.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "Common/Core/Format.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Widgets.h"
#include "Common/Shared/Tonemap.h"

namespace rt::gui {
namespace {

constexpr int kBins = 64;
constexpr float kDarkest = -10, kBrightest = 6; // stops about white

struct Histogram {
    std::array<float, kBins> shares{};
    double aboveWhite = 0, black = 0; // shares of the pixels
};

// Of as many pixels as a frame has time for.
Histogram histogramOf(const image::Image& image, float exposure) {
    constexpr std::size_t kMax = 1 << 16;
    Histogram result;
    const std::size_t pixels = std::size_t{image.width} * image.height, step = std::max<std::size_t>(1, pixels / kMax);
    std::size_t count = 0;
    for (std::size_t i = 0; i < pixels; i += step, ++count) {
        const float* rgb = &image.data[3 * i];
        const float stops = std::log2(shared::displayLuminance({rgb[0], rgb[1], rgb[2]})) + exposure;
        if (!(stops > kDarkest)) {
            ++result.black;
            continue;
        }
        result.aboveWhite += stops > 0;
        const float place = std::min((stops - kDarkest) / (kBrightest - kDarkest), 0.9999f);
        ++result.shares[static_cast<std::size_t>(place * kBins)];
    }
    const double all = std::max<double>(1, static_cast<double>(count));
    for (float& share : result.shares) share /= static_cast<float>(all);
    result.aboveWhite /= all;
    result.black /= all;
    return result;
}

} // namespace

void drawHistogram(const Gui& gui) {
    const image::Image* radiance = gui.state.picture.radiance.get();
    if (radiance == nullptr || radiance->channels != 3) return note("No picture yet");
    static Histogram shown;
    static std::uint64_t serial = 0;
    static float exposure = 0;
    if (serial != gui.state.picture.serial || exposure != gui.exposure()) {
        serial = gui.state.picture.serial;
        exposure = gui.exposure();
        shown = histogramOf(*radiance, exposure);
    }
    const float maximum = *std::max_element(shown.shares.begin(), shown.shares.end());
    ImGui::PlotHistogram("##histogram", shown.shares.data(), kBins, 0, nullptr, 0, std::max(maximum, 1e-6f),
                         {ImGui::GetContentRegionAvail().x, 5 * ImGui::GetFontSize()});
    tooltip("Luminance of the picture in stops, from 10 below white to 6 above, as it is exposed");
    note(formatted("%.2g %% above white, %.2g %% black", 100 * shown.aboveWhite, 100 * shown.black));
}

} // namespace rt::gui
