#include "Common/Gui/Widgets.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "Common/Core/Format.h"
#include "Common/Gui/TextFit.h"

namespace rt::gui {
namespace {

constexpr float kLabelShare = 0.40f; // of a row

// Edits a copy until the field is left. `edit` draws the field, which is told whether somebody types there.
template <class T, class Edit>
bool editLater(T& value, Edit edit) {
    static ImGuiID active = 0; // only one field is edited at a time
    static T draft{};
    const ImGuiID id = ImGui::GetID("##value");
    T shown = active == id ? draft : value;
    edit(shown, active == id);
    const bool isActive = ImGui::IsItemActive();
    const bool left = ImGui::IsItemDeactivatedAfterEdit();
    if (isActive) {
        active = id;
        draft = shown;
    } else if (active == id) {
        active = 0;
    }
    if (!left || shown == value) return false;
    value = shown;
    return true;
}

// Exponents may be typed, as they are shown.
void editReal(double& value, const char* pattern) {
    ImGui::InputScalar("##value", ImGuiDataType_Double, &value, nullptr, nullptr, pattern,
                       ImGuiInputTextFlags_CharsScientific);
}

bool isNextRowMarked = false;
float roomInNextRow = 0;
const char* whyDisabled = nullptr; // of the rows that are drawn; null: they are not, or it is not said

} // namespace

void markNextRow(bool isChanged) {
    isNextRowMarked = isChanged;
}

void leaveRoomInNextRow(float width) {
    roomInNextRow = width;
}

Disabled::Disabled(bool isOn, const char* why) : isOn_(isOn), outer_(whyDisabled) {
    if (!isOn_) return;
    ImGui::BeginDisabled();
    if (why != nullptr) whyDisabled = why;
}

Disabled::~Disabled() {
    if (!isOn_) return;
    ImGui::EndDisabled();
    whyDisabled = outer_;
}

// One a frame: ImGui would put a second one's text below the first one's. What is grey tells why it is.
void tooltip(const char* text) {
    static int lastFrame = -1;
    const bool isExplained = whyDisabled != nullptr;
    if ((text == nullptr && !isExplained) || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    if (std::exchange(lastFrame, ImGui::GetFrameCount()) == ImGui::GetFrameCount()) return;
    ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 1); // what is grey would have a tooltip that is grey, too
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
    if (text != nullptr) ImGui::TextUnformatted(text);
    if (isExplained) ImGui::TextDisabled("Has no effect now: %s", whyDisabled);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
    ImGui::PopStyleVar();
}

void explainDisabled() {
    if (whyDisabled != nullptr) tooltip(nullptr);
}

void row(const char* label, const char* tip) {
    ImGui::AlignTextToFramePadding();
    const float end = ImGui::GetCursorPosX() + ImGui::CalcTextSize(label).x + ImGui::GetStyle().ItemInnerSpacing.x;
    ImGui::TextUnformatted(label);
    if (std::exchange(isNextRowMarked, false)) {
        const float radius = 0.16f * ImGui::GetFontSize();
        const ImVec2 corner = ImGui::GetItemRectMin(), far = ImGui::GetItemRectMax();
        ImGui::GetWindowDrawList()->AddCircleFilled({far.x + 1.5f * radius, corner.y + radius}, radius,
                                                    ImGui::GetColorU32(ImGuiCol_CheckMark));
    }
    tooltip(tip);
    // A long label moves its control to the right rather than lie under it.
    const float column = ImGui::GetCursorStartPos().x + kLabelShare * ImGui::GetWindowContentRegionMax().x;
    ImGui::SameLine(std::max(column, end));
    ImGui::SetNextItemWidth(std::min(-1.0f, -std::exchange(roomInNextRow, 0.0f)));
}

void wrapped(const std::string& text, const ImVec4& color) {
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
}

void note(const std::string& text) {
    wrapped(text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
}

void placeNextWindow(const ImVec2& size, const ImVec2& maxShares) {
    const ImVec2 all = ImGui::GetMainViewport()->Size;
    const float em = ImGui::GetFontSize();
    ImGui::SetNextWindowPos({0.5f * all.x, 0.5f * all.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({std::min(size.x * em, maxShares.x * all.x), std::min(size.y * em, maxShares.y * all.y)},
                             ImGuiCond_Appearing);
}

float textWidth(const std::string& text) {
    return ImGui::CalcTextSize(text.c_str()).x;
}

std::string elided(const std::string& text, float width) {
    return elided(text, width, textWidth);
}

bool inputCount(const char* label, const char* tip, std::uint32_t& value, std::uint32_t min, std::uint32_t max,
                std::uint32_t step, const char* zero) {
    row(label, tip);
    ImGui::PushID(label);
    const float side = ImGui::GetFrameHeight(), gap = ImGui::GetStyle().ItemInnerSpacing.x;
    if (step > 0) ImGui::SetNextItemWidth(-2 * (side + gap));
    bool changed = editLater(value, [&](std::uint32_t& shown, bool isTyped) {
        const char* pattern = zero != nullptr && shown == 0 && !isTyped ? zero : "%u";
        ImGui::InputScalar("##value", ImGuiDataType_U32, &shown, nullptr, nullptr, pattern);
        if (!ImGui::IsItemActive()) shown = std::clamp(shown, min, max);
        explainDisabled();
    });
    // Buttons of our own: those of ImGui 1.86 end the program when one is pressed while the mouse holds something else.
    for (const bool up : {false, true}) {
        if (step == 0) break;
        ImGui::SameLine(0, gap);
        ImGui::PushButtonRepeat(true);
        const bool pressed = ImGui::Button(up ? "+" : "-", {side, side});
        ImGui::PopButtonRepeat();
        const std::uint32_t from = std::clamp(value, min, max);
        const std::uint32_t next = up ? from + std::min(step, max - from) : from - std::min(step, from - min);
        if (!pressed || next == value) continue;
        value = next;
        changed = true;
    }
    ImGui::PopID();
    return changed;
}

bool inputReal(const char* label, const char* tip, double& value, double min, double max, const char* pattern,
               const char* zero) {
    row(label, tip);
    ImGui::PushID(label);
    const bool changed = editLater(value, [&](double& shown, bool isTyped) {
        editReal(shown, zero != nullptr && shown == 0 && !isTyped ? zero : pattern);
        explainDisabled();
        if (ImGui::IsItemActive()) return;
        shown = std::isfinite(shown) ? std::clamp(shown, min, max) : value;
    });
    ImGui::PopID();
    return changed;
}

bool inputVector(const char* label, const char* tip, glm::dvec3& value) {
    row(label, tip);
    ImGui::PushID(label);
    bool changed = false;
    const float space = ImGui::GetStyle().ItemInnerSpacing.x;
    const float width = (ImGui::GetContentRegionAvail().x - 2 * space) / 3;
    for (int i = 0; i < 3; ++i) {
        ImGui::PushID(i);
        if (i > 0) ImGui::SameLine(0, space);
        ImGui::SetNextItemWidth(width);
        changed |= editLater(value[i], [&](double& shown, bool) {
            editReal(shown, "%.5g");
            if (!ImGui::IsItemActive() && !std::isfinite(shown)) shown = value[i];
        });
        ImGui::PopID();
    }
    ImGui::PopID();
    return changed;
}

bool sliderReal(const char* label, const char* tip, double& value, double min, double max, const char* pattern,
                bool logarithmic) {
    row(label, tip);
    ImGui::PushID(label);
    double shown = value;
    const ImGuiSliderFlags flags = (logarithmic ? ImGuiSliderFlags_Logarithmic : 0) | ImGuiSliderFlags_AlwaysClamp;
    const bool changed = ImGui::SliderScalar("##value", ImGuiDataType_Double, &shown, &min, &max, pattern, flags);
    explainDisabled();
    ImGui::PopID();
    if (!changed || !std::isfinite(shown) || shown == value) return false;
    value = std::clamp(shown, min, max);
    return true;
}

bool inputText(const char* id, const char* hint, std::string& text) {
    const auto resize = [](ImGuiInputTextCallbackData* data) {
        if (data->EventFlag != ImGuiInputTextFlags_CallbackResize) return 0;
        auto& string = *static_cast<std::string*>(data->UserData);
        string.resize(static_cast<std::size_t>(data->BufTextLen));
        data->Buf = string.data();
        return 0;
    };
    constexpr ImGuiInputTextFlags kFlags =
        ImGuiInputTextFlags_CallbackResize | ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll;
    return ImGui::InputTextWithHint(id, hint, text.data(), text.capacity() + 1, kFlags, resize, &text);
}

bool checkbox(const char* label, const char* tip, bool& value) {
    row(label, tip);
    ImGui::PushID(label);
    const bool changed = ImGui::Checkbox("##value", &value);
    tooltip(tip);
    ImGui::PopID();
    return changed;
}

void besideIfItFits(float width) {
    const float space = ImGui::GetStyle().ItemSpacing.x;
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    if (ImGui::GetItemRectMax().x + space + width <= right) ImGui::SameLine(0, space);
}

float buttonWidth(const char* label) {
    return ImGui::CalcTextSize(label).x + 2 * ImGui::GetStyle().FramePadding.x;
}

bool button(const char* label, const char* tip, Usable usable, float width) {
    if (!usable.is) ImGui::BeginDisabled();
    const bool pressed = ImGui::Button(label, {width, 0});
    if (!usable.is) ImGui::EndDisabled();
    const char* const outer = whyDisabled;
    if (usable.whyNot != nullptr) whyDisabled = usable.whyNot;
    if (!pressed) tooltip(tip); // which would cover what a button makes a picture of
    whyDisabled = outer;
    return pressed;
}

std::string withPrefix(double value) {
    if (value >= 1e9) return formatted("%.3g G", value * 1e-9);
    if (value >= 1e6) return formatted("%.3g M", value * 1e-6);
    if (value >= 1e3) return formatted("%.3g k", value * 1e-3);
    return formatted("%.3g", value);
}

std::string bytesText(std::uint64_t bytes) {
    const auto value = static_cast<double>(bytes);
    if (value >= 1u << 30) return formatted("%.2f GiB", value / (1u << 30));
    return formatted("%.1f MiB", value / (1u << 20));
}

std::string shortDuration(double seconds) {
    if (seconds < 1) return formatted("%.3g ms", std::round(seconds * 1e5) / 100); // nothing below 0.01 ms
    if (seconds < 60) return formatted("%.2f s", seconds);
    return roughDuration(seconds);
}

std::string roughDuration(double seconds) {
    if (seconds < 60) return formatted("%.0f s", std::ceil(seconds));
    const auto all = static_cast<long long>(std::min(seconds, 1e12));
    if (all < 3600) return formatted("%lld:%02lld min", all / 60, all % 60);
    return formatted("%lld:%02lld:%02lld h", all / 3600, all / 60 % 60, all % 60);
}

} // namespace rt::gui
