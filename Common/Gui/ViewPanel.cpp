#include "Common/Gui/Panels.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr app::Named<app::Tonemap> kTonemapNames[] = {
    {"None (clamp)", app::Tonemap::None}, {"Reinhard", app::Tonemap::Reinhard}, {"ACES-like", app::Tonemap::Aces}};
constexpr app::Named<app::ColorMode> kColorModeNames[] = {
    {"Dark", app::ColorMode::Dark}, {"Light", app::ColorMode::Light}, {"High contrast", app::ColorMode::HighContrast}};

} // namespace

void drawViewPanel(Gui& gui) {
    app::GuiSettings& settings = gui.settings;
    double exposure = settings.exposure;
    if (sliderReal("Exposure", "Stops, of what is shown and of PNG files", exposure, -10, 10, "%.2f")) {
        settings.exposure = static_cast<float>(exposure);
    }
    combo("Tone curve", "How radiance beyond white is shown", kTonemapNames, settings.tonemap);
    const float space = ImGui::GetStyle().ItemSpacing.x;
    const float width = (ImGui::GetContentRegionAvail().x - space) / 2;
    if (button("Fit", "The whole picture (F); Ctrl + wheel zooms, Ctrl + right drag moves it", true, width))
        gui.view = {};
    ImGui::SameLine(0, space);
    if (button("1:1", "One pixel for each of the window", true, width)) gui.view = {1, 0, 0};
    row("Save to", "Folder for F12; empty: your pictures folder, else the home folder");
    inputText("##folder", "pictures folder", settings.saveFolder);
    if (button("Save PNG and EXR", "F12 or Ctrl+S", true, -1)) gui.saveRequested = true;
    ImGui::Spacing();
    combo("Colours", "Of the interface", kColorModeNames, settings.colorMode);

    row("Interface scale", "Ctrl + plus, Ctrl + minus");
    static float draft = 0; // while the slider is held: the slider itself would move away from the mouse
    float shown = draft > 0 ? draft : settings.uiScale;
    ImGui::SliderFloat("##scale", &shown, app::kLeastUiScale, app::kMostUiScale, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    if (ImGui::IsItemActive()) {
        draft = shown;
    } else if (draft > 0) {
        settings.uiScale = draft;
        draft = 0;
    }
    row("Font", nullptr);
    const std::string font = settings.font.empty() ? availableFonts().front().name : settings.font;
    if (ImGui::BeginCombo("##font", font.c_str())) {
        for (const FontFile& file : availableFonts()) {
            if (ImGui::Selectable(file.name.c_str(), file.name == font)) settings.font = file.name;
        }
        ImGui::EndCombo();
    }
}

} // namespace rt::gui
