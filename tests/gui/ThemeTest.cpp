// The colours of the interface beside each other.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <imgui.h>

#include "Common/Gui/Theme.h"

namespace rt::gui {
namespace {

// Relative luminance and contrast ratio of WCAG 2.1.
double luminance(const ImVec4& color) {
    const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
    return 0.2126 * linear(color.x) + 0.7152 * linear(color.y) + 0.0722 * linear(color.z);
}
double contrast(const ImVec4& a, const ImVec4& b) {
    const double minimum = std::min(luminance(a), luminance(b)), maximum = std::max(luminance(a), luminance(b));
    return (maximum + 0.05) / (minimum + 0.05);
}

class ThemeTest : public testing::TestWithParam<app::ColorMode> {
  protected:
    void SetUp() override { applyTheme(style_, GetParam()); }
    const ImVec4& color(ImGuiCol index) const { return style_.Colors[index]; }

    ImGuiStyle style_;
};
INSTANTIATE_TEST_SUITE_P(, ThemeTest,
                         testing::Values(app::ColorMode::Dark, app::ColorMode::Light, app::ColorMode::HighContrast));

// 4.5 is what WCAG asks for. A slider's value is written over its grab.
TEST_P(ThemeTest, TextIsReadableOnWhatItIsDrawnOver) {
    for (const ImGuiCol below :
         {ImGuiCol_WindowBg, ImGuiCol_PopupBg, ImGuiCol_FrameBg, ImGuiCol_Button, ImGuiCol_Header, ImGuiCol_TitleBg,
          ImGuiCol_Tab, ImGuiCol_TabActive, ImGuiCol_TabUnfocusedActive, ImGuiCol_PlotHistogram, ImGuiCol_SliderGrab,
          ImGuiCol_SliderGrabActive}) {
        EXPECT_GE(contrast(color(ImGuiCol_Text), color(below)), 4.5) << ImGui::GetStyleColorName(below);
    }
    EXPECT_GE(contrast(accentTextColor(GetParam()), accentColor(GetParam())), 3.0); // large: a button's title
}

TEST_P(ThemeTest, AGrabIsSeenInItsSlider) {
    EXPECT_GE(contrast(color(ImGuiCol_SliderGrab), color(ImGuiCol_FrameBg)), 1.5);
    EXPECT_GE(contrast(color(ImGuiCol_SliderGrabActive), color(ImGuiCol_FrameBgActive)), 1.5);
}

} // namespace
} // namespace rt::gui
