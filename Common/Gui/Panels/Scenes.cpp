// All scenes to choose from: thumbnails in a grid, grouped by book, and a search.
#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "Common/Core/Printable.h"
#include "Common/Core/TextSearch.h"
#include "Common/Gui/Panels/Panels.h"
#include "Common/Gui/TextFit.h"
#include "Common/Gui/Widgets.h"
#include "Common/Scene/Builtin/BuiltinScenes.h"

namespace rt::gui {
namespace {

constexpr float kCell = 8.2f;        // the width of a scene's place, in heights of the font
constexpr float kCellMargin = 0.35f; // around what is in a cell

// Scenes of a book are titled "Book: Scene".
std::string_view bookOf(const scene::BuiltinScene& scene) {
    const std::size_t colon = scene.title.find(':');
    return colon == std::string_view::npos ? "More scenes" : scene.title.substr(0, colon);
}

bool matches(const scene::BuiltinScene& scene, const std::string& search) {
    return contains(scene.title, search) || contains(scene.description, search) || contains(scene.id, search);
}

// Books in the order of their first scenes; what is of no book comes last.
std::vector<std::string_view> books() {
    std::vector<std::string_view> names;
    for (const scene::BuiltinScene& scene : scene::builtinScenes())
        if (std::find(names.begin(), names.end(), bookOf(scene)) == names.end()) names.push_back(bookOf(scene));
    std::stable_partition(names.begin(), names.end(), [](std::string_view name) { return name != "More scenes"; });
    return names;
}

bool drawCell(Gui& gui, const scene::BuiltinScene& scene, bool isSelected) {
    const float em = ImGui::GetFontSize(), width = kCell * em, margin = kCellMargin * em;
    const float side = width - 2 * margin, lines = 2 * ImGui::GetTextLineHeight();
    ImGui::PushID(scene.id.data());
    const bool chosen = ImGui::Selectable("##scene", isSelected, 0, {width, side + 3 * margin + lines});
    tooltip(std::string(scene.description).c_str());
    ImGui::PopID();
    if (!ImGui::IsItemVisible()) return chosen;
    const ImVec2 corner(ImGui::GetItemRectMin().x + margin, ImGui::GetItemRectMin().y + margin);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (!gui.thumbnails.draw(std::string(scene.id), corner, side))
        list.AddRectFilled(corner, {corner.x + side, corner.y + side}, ImGui::GetColorU32(ImGuiCol_FrameBg));
    const std::string_view title = scene.title; // that of its book, too: it stands alone elsewhere
    const ImVec4 clip(corner.x, corner.y, corner.x + side, corner.y + side + margin + lines);
    list.AddText(ImGui::GetFont(), em, {corner.x, corner.y + side + margin}, ImGui::GetColorU32(ImGuiCol_Text),
                 title.data(), title.data() + title.size(), side, &clip);
    return chosen;
}

void drawBook(Gui& gui, std::string_view book) {
    const std::string current = gui.state.source.substr(0, gui.state.source.find(':'));
    const float gap = ImGui::GetStyle().ItemSpacing.x, width = kCell * ImGui::GetFontSize();
    const int columns = std::max(1, static_cast<int>((ImGui::GetContentRegionAvail().x + gap) / (width + gap)));
    int drawn = 0;
    for (const scene::BuiltinScene& scene : scene::builtinScenes()) {
        if (bookOf(scene) != book || !matches(scene, gui.sceneSearch)) continue;
        if (drawn == 0) ImGui::TextDisabled("%.*s", static_cast<int>(book.size()), book.data());
        if (drawn % columns != 0) ImGui::SameLine(0, gap);
        ++drawn;
        if (!drawCell(gui, scene, scene.id == current)) continue;
        gui.openScene(std::string(scene.id));
        gui.showScenes = false;
    }
    if (drawn > 0) ImGui::Spacing();
}

void drawFiles(Gui& gui) {
    bool isFirst = true;
    for (const std::string& file : std::vector<std::string>(gui.settings.recent)) { // choosing one changes their order
        const std::string name = std::filesystem::path(file).filename().string();
        if (!contains(name, gui.sceneSearch)) continue;
        if (std::exchange(isFirst, false)) ImGui::TextDisabled("Files opened before");
        ImGui::PushID(file.c_str());
        if (ImGui::Selectable(printable(name).c_str(), file == gui.state.source)) {
            gui.openScene(file);
            gui.showScenes = false;
        }
        tooltip(printable(file).c_str());
        ImGui::PopID();
    }
}

} // namespace

void drawScenes(Gui& gui) {
    if (!gui.showScenes) return;
    placeNextWindow({56, 46}, {0.92f, 0.88f});
    ImGui::SetNextWindowSizeConstraints({0, 0}, ImGui::GetMainViewport()->Size);
    if (ImGui::Begin("Scenes", &gui.showScenes, ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings)) {
        ImGui::SetNextItemWidth(-1);
        if (ImGui::IsWindowAppearing()) {
            gui.sceneSearch.clear();
            ImGui::SetKeyboardFocusHere();
        }
        const bool entered = inputText("##search", "search", gui.sceneSearch);
        const auto scenes = scene::builtinScenes();
        const auto first = std::find_if(scenes.begin(), scenes.end(),
                                        [&](const auto& scene) { return matches(scene, gui.sceneSearch); });
        if (entered && first != scenes.end() && !gui.sceneSearch.empty()) {
            gui.openScene(std::string(first->id));
            gui.showScenes = false;
        }
        ImGui::BeginChild("##grid");
        drawFiles(gui);
        for (const std::string_view book : books()) drawBook(gui, book);
        if (first == scenes.end()) note("No scene of that name");
        ImGui::EndChild();
    }
    ImGui::End();
}

} // namespace rt::gui
