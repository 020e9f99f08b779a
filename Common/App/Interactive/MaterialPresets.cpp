#include "Common/App/Interactive/MaterialPresets.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "Common/Core/Error.h"
#include "Common/Core/Paths.h"
#include "Common/Core/ReadFile.h"
#include "Common/Core/TextSearch.h"
#include "Common/Scene/Json/JsonText.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/MaterialTypes.h"

namespace rt::app {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kMaxLibraryBytes = 16u << 20; // of one file

std::vector<std::string> commentLines(const nlohmann::json& document) {
    std::vector<std::string> lines;
    if (const auto comment = document.find("comment"); comment != document.end())
        for (const nlohmann::json& line : *comment) lines.push_back(line.get<std::string>());
    return lines;
}

void addPresets(const fs::path& file, std::vector<MaterialPreset>& presets) {
    const std::vector<std::byte> bytes = readFile(file, kMaxLibraryBytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const auto scene = std::make_shared<scene::SceneDesc>(scene::parseScene(text, file.string(), file.parent_path()));
    const std::vector<std::string> lines = commentLines(scene::parseJson(text, file.string()));
    std::vector<std::pair<std::size_t, MaterialPreset>> ordered; // by the line
    for (const auto& [name, material] : scene->materials) {
        const std::string start = name + ": ";
        const auto isIts = [&](const std::string& line) { return line.starts_with(start); };
        const auto line = std::find_if(lines.begin(), lines.end(), isIts);
        const std::string source = line == lines.end() ? "" : line->substr(start.size());
        ordered.push_back({static_cast<std::size_t>(line - lines.begin()), {name, scene->title, source, scene}});
    }
    const auto isBefore = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::stable_sort(ordered.begin(), ordered.end(), isBefore);
    for (auto& [line, preset] : ordered) presets.push_back(std::move(preset));
}

} // namespace

std::string MaterialPreset::picture() const {
    std::string text;
    for (const char c : name) {
        const bool isPlain = std::isalnum(static_cast<unsigned char>(c)) != 0;
        if (isPlain)
            text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        else if (!text.empty() && text.back() != '-')
            text += '-';
    }
    while (!text.empty() && text.back() == '-') text.pop_back();
    return text;
}

bool MaterialPreset::matches(const std::string& search) const {
    const std::string kind = scene::materialType(scene->materials.at(name).kind).name;
    std::istringstream words(search);
    for (std::string word; words >> word;)
        if (!contains(name, word) && !contains(group, word) && !contains(kind, word)) return false;
    return true;
}

std::vector<MaterialPreset> readMaterialPresets(const fs::path& folder, std::vector<std::string>& failures) {
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (entry->path().extension() == ".json") files.push_back(entry->path());
    std::sort(files.begin(), files.end());
    std::vector<MaterialPreset> presets;
    for (const fs::path& file : files) {
        try {
            addPresets(file, presets);
        } catch (const Error& failure) {
            failures.emplace_back(failure.what());
        }
    }
    return presets;
}

fs::path materialPresetFolder() {
    std::error_code ignored;
    for (const fs::path& folder : assetFolders())
        if (fs::is_directory(folder / "materials", ignored)) return folder / "materials";
    return {};
}

} // namespace rt::app
