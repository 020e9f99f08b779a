// What the colours of a view stand for: a bar of them, from the least value to the most.
#include <algorithm>
#include <cmath>
#include <vector>

#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Widgets.h"
#include "Common/Shared/Tonemap.h"

namespace rt::gui {
namespace {

using app::Legend;

constexpr std::uint32_t kCells = 96;                    // of the bar
constexpr float kLegendWidth = 15, kMinLegendWidth = 5; // of the box, in heights of the font
constexpr float kMargin = 10;                           // around it, at scale 1
constexpr float kLegendPadding = 0.5f, kBar = 0.75f;    // likewise: around all, and the bar's height

struct Measure {
    const char* title;
    double factor; // from the legend's values to those that the title names
};
Measure measureOf(Legend::Quantity quantity, bool isGpu) {
    switch (quantity) {
        case Legend::Quantity::Time:
            return isGpu ? Measure{"Shader clock ticks per sample", 1} : Measure{"Microseconds per sample", 1e6};
        case Legend::Quantity::StandardError:
            return {"Standard error in % of the value", 100};
        case Legend::Quantity::Error:
            return {"Error in % of the reference", 100};
        case Legend::Quantity::DenoisedError:
            return {"Estimated error of the denoised picture in % of the value", 100};
        case Legend::Quantity::Bandwidth:
            return {"Kept bandwidth: 0 small patches, 1 narrow, 2 wide, 3 raw", 1};
        case Legend::Quantity::Distance:
            return {"Distance in units of the scene", 1};
        case Legend::Quantity::Rays:
            break;
    }
    return {"Rays per sample", 1};
}

void drawBar(ImDrawList& list, const Legend& legend, const Rect& bar) {
    std::vector<float> values(kCells);
    for (std::uint32_t i = 0; i < kCells; ++i) values[i] = legend.value((static_cast<float>(i) + 0.5f) / kCells);
    const image::Image colours = app::paint(legend, values, kCells, 1);
    for (std::uint32_t i = 0; i < kCells; ++i) {
        const float* rgb = colours.pixel(i, 0);
        const ImVec4 colour(shared::srgbEncode(rgb[0]), shared::srgbEncode(rgb[1]), shared::srgbEncode(rgb[2]), 1);
        const float left = bar.x + bar.width * static_cast<float>(i) / kCells;
        list.AddRectFilled({left, bar.y}, {left + bar.width / kCells, bar.y + bar.height}, ImGui::GetColorU32(colour));
    }
    list.AddRect({bar.x, bar.y}, {bar.x + bar.width, bar.y + bar.height}, ImGui::GetColorU32(ImGuiCol_TextDisabled));
}

// Below the bar: its ends and, where there is room between them, its middle.
void drawValues(ImDrawList& list, const Legend& legend, double factor, const Rect& bar) {
    const float em = ImGui::GetFontSize();
    const auto textAt = [&](float level) { return withPrefix(factor * legend.value(level)); };
    const auto widthAt = [&](float level) { return ImGui::CalcTextSize(textAt(level).c_str()).x; };
    const auto draw = [&](float level, float pivot) {
        list.AddText({bar.x + level * bar.width - pivot * widthAt(level), bar.y + bar.height + 0.25f * em},
                     ImGui::GetColorU32(ImGuiCol_Text), textAt(level).c_str());
    };
    draw(0, 0);
    draw(1, 1);
    if (0.5f * widthAt(0.5f) + std::max(widthAt(0), widthAt(1)) + 0.5f * em < 0.5f * bar.width) draw(0.5f, 0.5f);
}

struct Box {
    float width = 0, height = 0; // 0: there is no room
    float title = 0;             // the height of it
};
Box boxOf(const Gui& gui, const Rect& area, float scale) {
    const std::optional<Legend>& legend = gui.state.picture.legend;
    if (!legend || !(legend->maximum > 0)) return {};
    const float em = ImGui::GetFontSize(), padding = kLegendPadding * em, margin = kMargin * scale;
    Box box;
    box.width = std::min(kLegendWidth * em, area.width - 2 * margin);
    const char* title = measureOf(legend->quantity, gui.isGpu).title;
    box.title = ImGui::CalcTextSize(title, nullptr, false, std::max(box.width - 2 * padding, 1.0f)).y;
    box.height = box.title + (0.25f + kBar + 0.25f) * em + ImGui::GetTextLineHeight() + 2 * padding;
    if (box.width < kMinLegendWidth * em || box.height > area.height - 2 * margin) return {};
    return box;
}

} // namespace

float legendHeight(const Gui& gui, const Rect& area, float scale) {
    return boxOf(gui, area, scale).height;
}

void drawViewLegend(const Gui& gui, const Rect& area, float scale) {
    const Box box = boxOf(gui, area, scale);
    if (box.height <= 0) return;
    const Legend& legend = *gui.state.picture.legend;
    const Measure measure = measureOf(legend.quantity, gui.isGpu);
    const float em = ImGui::GetFontSize(), padding = kLegendPadding * em, margin = kMargin * scale;
    const float inner = box.width - 2 * padding;

    // Below all windows: what is said for a while, and help, may cover it.
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImVec2 corner(std::floor(area.x + area.width - margin - box.width),
                        std::floor(area.y + area.height - margin - box.height));
    const ImVec2 end(corner.x + box.width, corner.y + box.height);
    const float rounding = ImGui::GetStyle().FrameRounding;
    list.AddRectFilled(corner, end, ImGui::GetColorU32(ImGuiCol_WindowBg, 0.92f), rounding);
    list.AddRect(corner, end, ImGui::GetColorU32(ImGuiCol_Border), rounding);
    list.AddText(ImGui::GetFont(), em, {corner.x + padding, corner.y + padding}, ImGui::GetColorU32(ImGuiCol_Text),
                 measure.title, nullptr, inner);
    const Rect bar{corner.x + padding, corner.y + padding + box.title + 0.25f * em, inner, kBar * em};
    drawBar(list, legend, bar);
    drawValues(list, legend, measure.factor, bar);
}

} // namespace rt::gui
