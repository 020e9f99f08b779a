// How the interface looks.
#include <string>

#include "Common/Gui/Fonts.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

constexpr app::Named<app::ColorMode> kColorModeNames[] = {
    {"Dark", app::ColorMode::Dark}, {"Light", app::ColorMode::Light}, {"High contrast", app::ColorMode::HighContrast}};

void drawScale(app::GuiSettings& settings) {
    row("Interface scale", "Ctrl + plus, Ctrl + minus");
    static float draft = 0; // while the slider is held: the slider itself would move away from the mouse
    float shown = draft > 0 ? draft : settings.uiScale;
    ImGui::SliderFloat("##scale", &shown, app::kMinUiScale, app::kMaxUiScale, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    if (ImGui::IsItemActive()) {
        draft = shown;
    } else if (draft > 0) {
        settings.uiScale = draft;
        draft = 0;
    }
}

void drawFont(app::GuiSettings& settings) {
    row("Font", nullptr);
    const std::string font = settings.font.empty() ? availableFonts().front().name : settings.font;
    if (!ImGui::BeginCombo("##font", font.c_str())) return;
    for (const FontFile& file : availableFonts())
        if (ImGui::Selectable(file.name.c_str(), file.name == font)) settings.font = file.name;
    ImGui::EndCombo();
}

} // namespace

void drawSettingsPanel(Gui& gui) {
    combo("Theme", "Colours of the interface", kColorModeNames, gui.settings.colorMode);
    drawScale(gui.settings);
    drawFont(gui.settings);
}

} // namespace rt::gui
