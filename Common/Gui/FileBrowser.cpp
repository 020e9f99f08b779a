#include "Common/Gui/FileBrowser.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <imgui.h>

#include "Common/Core/Paths.h"
#include "Common/Core/Printable.h"
#include "Common/Core/TextSearch.h"
#include "Common/Gui/Icons.h"
#include "Common/Gui/TextFit.h"
#include "Common/Gui/Widgets.h"

namespace rt::gui {
namespace {

namespace fs = std::filesystem;

constexpr int kPage = 10;    // entries
constexpr int kSettling = 8; // frames: the window gets the keyboard, then its field; asked for until it has it

fs::path homeFolder() {
    for (const char* variable : {"HOME", "USERPROFILE"})
        if (const char* home = std::getenv(variable); home != nullptr && *home != '\0') return home;
    return fs::current_path();
}

// An icon and a name in a row that can be chosen.
bool drawItem(Icon icon, const std::string& name, bool isSelected) {
    const float height = ImGui::GetTextLineHeight();
    const bool pressed = ImGui::Selectable(("##" + name).c_str(), isSelected, ImGuiSelectableFlags_AllowDoubleClick);
    const ImVec2 corner = ImGui::GetItemRectMin(), end = ImGui::GetItemRectMax();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float y = 0.5f * (corner.y + end.y - height);
    drawIcon(list, icon, {corner.x + 0.3f * height, y + 0.12f * height}, 0.76f * height,
             ImGui::GetColorU32(ImGuiCol_TextDisabled));
    list.AddText({corner.x + 1.5f * height, y}, ImGui::GetColorU32(ImGuiCol_Text), printable(name).c_str());
    return pressed;
}

// "*.json *.obj"
std::string kinds(const std::vector<std::string>& extensions) {
    std::string text;
    for (const std::string& extension : extensions) text += (text.empty() ? "*" : " *") + extension;
    return text;
}

// The folder at the left, what is listed of it at the right.
void drawHeading(const std::string& folder, const std::string& listed) {
    const float left = ImGui::GetCursorPosX(), room = ImGui::GetContentRegionAvail().x;
    const float right = ImGui::CalcTextSize(listed.c_str()).x, gap = ImGui::GetFontSize();
    ImGui::TextUnformatted(elided(folder, room - right - gap).c_str());
    tooltip(folder.c_str());
    ImGui::SameLine(left + room - right);
    ImGui::TextDisabled("%s", listed.c_str());
    tooltip("Only folders and such files are listed");
}

} // namespace

void FileBrowser::open(Request request) {
    request_ = std::move(request);
    isOpen_ = true;
    settling_ = kSettling;
    std::error_code none;
    const bool isThere = fs::is_directory(request_.folder, none);
    enter(isThere ? request_.folder : !folder_.empty() ? folder_ : homeFolder());
    name_ = listed_ = request_.name;
}

void FileBrowser::enter(const Path& folder) {
    std::error_code none;
    const Path whole = fs::weakly_canonical(fs::absolute(folder, none), none);
    folder_ = whole.empty() ? folder : whole;
    list_ = app::listFolder(folder_, request_.extensions);
    name_.clear();
    listed_.clear();
    question_.clear();
    selected_ = -1;
}

bool FileBrowser::matches(const app::FolderEntry& entry) const {
    return request_.isToSave || contains(entry.name, listed_);
}

std::vector<std::size_t> FileBrowser::shown() const {
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < list_.entries.size(); ++i)
        if (matches(list_.entries[i])) indices.push_back(i);
    return indices;
}

void FileBrowser::press(Key key) {
    if (key == Key::Parent) return enter(folder_.parent_path());
    if (key == Key::Accept) {
        isAccepted_ = selected_ >= 0; // what is typed is the field's
        return;
    }
    const int count = static_cast<int>(shown().size());
    const int step = key == Key::Up ? -1 : key == Key::Down ? 1 : key == Key::PageUp ? -kPage : kPage;
    selected_ = count > 0 ? std::clamp(selected_ + step, 0, count - 1) : -1;
    scrollToSelected_ = true;
}

std::optional<FileBrowser::Path> FileBrowser::finish(const Path& path) {
    isOpen_ = false;
    return path;
}

// A folder is entered, a file is the end.
std::optional<FileBrowser::Path> FileBrowser::acceptFile(const Path& file) {
    std::error_code none;
    if (fs::is_directory(file, none)) {
        enter(file);
        settling_ = kSettling;
        return std::nullopt;
    }
    if (!request_.isToSave) return finish(file);
    Path target = file;
    if (!target.has_extension()) target += request_.extensions.front();
    if (fs::exists(target, none) && question_ != target.string()) {
        question_ = target.string();
        return std::nullopt;
    }
    return finish(target);
}

std::optional<FileBrowser::Path> FileBrowser::accept() {
    const std::vector<std::size_t> indices = shown();
    if (selected_ >= 0 && selected_ < static_cast<int>(indices.size()))
        return acceptFile(folder_ / list_.entries[indices[static_cast<std::size_t>(selected_)]].name);
    if (name_.empty()) return std::nullopt;
    const Path typed =
        name_.front() == '~' ? homeFolder() / name_.substr(std::min<std::size_t>(2, name_.size())) : Path(name_);
    std::error_code none;
    if (request_.isToSave || typed.is_absolute() || fs::exists(folder_ / typed, none))
        return acceptFile(folder_ / typed);
    // The one that is left of the list; what is none of them is for the caller to judge.
    if (indices.size() == 1) return acceptFile(folder_ / list_.entries[indices.front()].name);
    return finish(typed);
}

void FileBrowser::drawPlaces(const std::vector<std::string>& recent, std::optional<Path>& chosen) {
    const auto place = [this](const char* name, const Path& folder) {
        std::error_code none;
        if (fs::is_directory(folder, none) && drawItem(Icon::Folder, name, folder == folder_)) enter(folder);
    };
    place("Home", homeFolder());
    place("Pictures", homeFolder() / "Pictures");
    if (const auto assets = assetFolders(); !assets.empty()) place("Examples", assets.front() / "examples");
    place("This folder", fs::current_path());
    place("Computer", folder_.root_path());
    if (recent.empty() || request_.isToSave) return;
    ImGui::Spacing();
    ImGui::TextDisabled("Recent");
    for (const std::string& file : recent) {
        const Path path = file;
        const bool isWanted = std::find(request_.extensions.begin(), request_.extensions.end(),
                                        path.extension().string()) != request_.extensions.end();
        if (!isWanted) continue;
        ImGui::PushID(file.c_str());
        if (drawItem(Icon::File, path.filename().string(), false)) chosen = finish(path);
        tooltip(printable(file).c_str());
        ImGui::PopID();
    }
}

void FileBrowser::drawEntries(std::optional<Path>& chosen) {
    const std::vector<std::size_t> indices = shown();
    for (int i = 0; i < static_cast<int>(indices.size()); ++i) {
        const app::FolderEntry entry = list_.entries[indices[static_cast<std::size_t>(i)]];
        ImGui::PushID(i);
        const bool pressed = drawItem(entry.isFolder ? Icon::Folder : Icon::File, entry.name, i == selected_);
        ImGui::PopID();
        if (i == selected_ && std::exchange(scrollToSelected_, false)) ImGui::SetScrollHereY();
        if (!pressed) continue;
        if (request_.isToSave && !entry.isFolder) name_ = entry.name;
        selected_ = i;
        question_.clear();
        if (ImGui::IsMouseDoubleClicked(0) || entry.isFolder) {
            chosen = acceptFile(folder_ / entry.name);
            return; // the list may be another
        }
    }
    if (!list_.failure.empty()) note(printable(list_.failure));
    if (list_.failure.empty() && indices.empty()) note("Nothing here that can be chosen");
    if (list_.isCut) note("Only the first " + std::to_string(app::FolderList::kMax) + " are listed");
}

std::optional<FileBrowser::Path> FileBrowser::draw(const std::vector<std::string>& recent) {
    std::optional<Path> chosen;
    placeNextWindow({50, 34}, {0.92f, 0.88f});
    ImGui::SetNextWindowSizeConstraints({0, 0}, ImGui::GetMainViewport()->Size);
    if (settling_ == kSettling) ImGui::SetNextWindowFocus();
    if (ImGui::Begin((request_.title + "###file-browser").c_str(), &isOpen_,
                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings)) {
        const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
        if (iconButton("parent", Icon::Up, "The folder above (Alt + up)", folder_.has_relative_path()))
            enter(folder_.parent_path());
        ImGui::SameLine(0, gap);
        ImGui::AlignTextToFramePadding();
        drawHeading(printable(folder_.string()), kinds(request_.extensions));
        // The field; what is typed there narrows the list, unless it is a name to be.
        const float action = buttonWidth("Replace"), cancel = buttonWidth("Cancel");
        ImGui::SetNextItemWidth(-(action + cancel + 2 * gap));
        settling_ = std::max(0, settling_ - 1);
        if (settling_ % 2 == 1) ImGui::SetKeyboardFocusHere(); // the frame after tells whether it has come to that
        const bool entered = inputText("##name", request_.isToSave ? "name" : "name or path; arrows choose", name_);
        if (ImGui::IsItemActive()) settling_ = 0;
        if (name_ != listed_) {
            listed_ = name_;
            selected_ = -1;
            question_.clear();
        }
        ImGui::SameLine(0, gap);
        const bool isReplacing = !question_.empty();
        const bool canAccept = !name_.empty() || selected_ >= 0;
        const bool isAccepted = std::exchange(isAccepted_, false);
        if (button(isReplacing ? "Replace" : request_.action.c_str(), nullptr, canAccept, action) || entered ||
            isAccepted) {
            if (auto path = accept()) chosen = path;
        }
        ImGui::SameLine(0, gap);
        if (button("Cancel", "Escape", true, cancel)) isOpen_ = false;
        if (isReplacing) note(printable(question_) + " exists: once more to replace it");
        ImGui::BeginChild("##places", {11 * ImGui::GetFontSize(), 0}, true);
        drawPlaces(recent, chosen);
        ImGui::EndChild();
        ImGui::SameLine();
        ImGui::BeginChild("##entries", {0, 0}, true);
        drawEntries(chosen);
        ImGui::EndChild();
    }
    ImGui::End();
    return chosen;
}

} // namespace rt::gui
