// Rows of a panel: a label to the left, a control to the right, an explanation on hovering.
#pragma once
#include <cstdint>
#include <string>

#include <glm/vec3.hpp>
#include <imgui.h>

#include "Common/Render/Names.h"

namespace rt::gui {

// What follows is the control of this row. `tip` may be null.
void row(const char* label, const char* tip);
// The next row's setting is not at its default: its label says so.
void markNextRow(bool isChanged);
// The next row's control leaves that width free to its right.
void leaveRoomInNextRow(float width);
void tooltip(const char* text);     // of the item before
void explainDisabled();             // likewise, where it is grey: why
void note(const std::string& text); // dimmed and wrapped
void wrapped(const std::string& text, const ImVec4& color);
// The beginning of a text, ended by dots where it is wider than that.
std::string elided(const std::string& text, float width);
float textWidth(const std::string& text);
// The next window appears in the middle, of this size in heights of the font, of at most these shares of the screen.
void placeNextWindow(const ImVec2& size, const ImVec2& maxShares);

// All return whether the value has changed. Typed numbers count when the field is left, brought into their range.
// `zero`: a word, without "%", that stands for 0 while nobody types.
bool inputCount(const char* label, const char* tip, std::uint32_t& value, std::uint32_t min, std::uint32_t max,
                std::uint32_t step, const char* zero = nullptr);
bool inputReal(const char* label, const char* tip, double& value, double min, double max, const char* format,
               const char* zero = nullptr);
bool inputVector(const char* label, const char* tip, glm::dvec3& value);
bool sliderReal(const char* label, const char* tip, double& value, double min, double max, const char* format,
                bool logarithmic = false);
// A field of text with a hint while it is empty. What is typed after it got the keyboard replaces its text. Whether it
// was left by Enter.
bool inputText(const char* id, const char* hint, std::string& text);
bool checkbox(const char* label, const char* tip, bool& value);

// The control of combo() alone, as wide as the next item is to be.
template <class E, std::size_t N>
bool comboField(const char* id, const app::Named<E> (&table)[N], E& value) {
    const std::string current = app::titleOf(table, value);
    bool changed = false;
    ImGui::PushID(id);
    const bool isOpen = ImGui::BeginCombo("##value", current.c_str());
    if (!isOpen) explainDisabled();
    if (isOpen) {
        for (const auto& entry : table) {
            const bool selected = entry.value == value;
            if (ImGui::Selectable(app::titleOf(table, entry.value).c_str(), selected) && !selected) {
                value = entry.value;
                changed = true;
            }
            if (entry.help) tooltip(entry.help);
            if (selected) ImGui::SetItemDefaultFocus();
        }
        ImGui::EndCombo();
    }
    ImGui::PopID();
    return changed;
}

template <class E, std::size_t N>
bool combo(const char* label, const char* tip, const app::Named<E> (&table)[N], E& value) {
    row(label, tip);
    return comboField(label, table, value);
}

// Rows that have no effect at the moment, while one of these lives: grey, and where they always are. Their tooltips say
// `why`, which outlives it.
class Disabled {
  public:
    explicit Disabled(bool isOn = true, const char* why = nullptr);
    ~Disabled();
    Disabled(const Disabled&) = delete;
    Disabled& operator=(const Disabled&) = delete;

  private:
    bool isOn_;
    const char* outer_;
};

// What follows, which is so wide, stands beside the item before if there is room, else below.
void besideIfItFits(float width);
// How wide a button of that label is.
float buttonWidth(const char* label);
// Whether something can be used, or why not.
struct Usable {
    Usable(bool isUsable, const char* reason = nullptr) : is(isUsable), whyNot(isUsable ? nullptr : reason) {}
    bool is;
    const char* whyNot; // null: it can be, or it is not said
};
// A button that is grey where it has nothing to do; its tooltip says why.
bool button(const char* label, const char* tip, Usable usable, float width = 0);

// "1.23 M", "456 k"
std::string withPrefix(double value);
std::string bytesText(std::uint64_t bytes);
std::string shortDuration(double seconds); // "12.3 ms", "4.56 s", "1:23:45 h"
std::string roughDuration(double seconds); // "5 s", "1:23:45 h"

} // namespace rt::gui
