#include "Common/App/OtherProgram.h"

#include <fstream>
#include <sstream>
#include <system_error>

#include "Common/Core/Error.h"
#include "Common/Core/Paths.h"
#include "Common/Render/Names.h"

namespace rt::app {

namespace fs = std::filesystem;

fs::path programFile(const std::string& name, const fs::path& folder) {
    const fs::path own = executablePath();
    fs::path file = (folder.empty() ? own.parent_path() : folder) / name;
    file += own.extension();
    std::error_code none;
    if (!fs::is_regular_file(file, none))
        throw RenderError(file.string() + ": is not there; it is built beside this program");
    return file;
}

std::vector<std::string> settingFlags(const RenderSettings& settings) {
    std::vector<std::string> list;
    const auto add = [&list](const std::string& flag, const std::string& value) {
        list.push_back(flag);
        list.push_back(value);
    };
    add("--width", std::to_string(settings.width));
    add("--height", std::to_string(settings.height));
    add("--spp", std::to_string(settings.spp));
    add("--max-depth", std::to_string(settings.maxDepth));
    add("--seed", std::to_string(settings.seed));
    add("--replicates", std::to_string(settings.replicates));
    forEachMethod([&add](const char* key, const char*, const char*, const auto& table,
                         const auto& value) { add(flagOf(key), nameOf(table, value)); },
                  settings);
    return list;
}

std::vector<std::string> flagsFor(const RenderSettings& settings, const fs::path& picture, const fs::path& statistics) {
    std::vector<std::string> list = settingFlags(settings);
    list.insert(list.end(), {"--russian-roulette", nameOf(kOnOff, settings.russianRoulette), "--output",
                             picture.string(), "--stats", statistics.string()});
    return list;
}

void checkEnd(const std::string& program, int exitCode, const fs::path& messages) {
    if (exitCode == 0) return;
    const std::string line = lastLine(textOf(messages));
    if (exitCode <= 128 && !line.empty()) throw RenderError(line);
    throw RenderError(program + ": ended by itself, exit code " + std::to_string(exitCode) +
                      (line.empty() ? "" : ": " + line));
}

std::string textOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

std::string lastLine(const std::string& text) {
    std::istringstream lines(text);
    std::string last;
    for (std::string line; std::getline(lines, line);)
        if (!line.empty()) last = line;
    return last;
}

} // namespace rt::app
