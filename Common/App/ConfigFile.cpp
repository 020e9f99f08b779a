#include "Common/App/ConfigFile.h"

#include <filesystem>
#include <sstream>

#include <nlohmann/json.hpp>

#include "Common/App/Platform.h"
#include "Common/Core/Error.h"

namespace rt::app {
namespace {

std::string textOf(const nlohmann::json& value, const std::string& name) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number() || value.is_boolean()) return value.dump();
    throw CLI::ConfigError(name + ": must be a string, a number, true, false or an array of these");
}

std::vector<CLI::ConfigItem> itemsOf(const std::string& text) {
    const nlohmann::json root = nlohmann::json::parse(text);
    std::vector<CLI::ConfigItem> items;
    for (const auto& [name, value] : root.items()) {
        CLI::ConfigItem item;
        item.name = name;
        if (value.is_array()) {
            for (const auto& element : value) item.inputs.push_back(textOf(element, name));
        } else {
            item.inputs.push_back(textOf(value, name));
        }
        items.push_back(item);
    }
    return items;
}

} // namespace

std::vector<CLI::ConfigItem> ConfigFile::from_config(std::istream& input) const {
    if (app_.get_option("--no-config")->count() > 0) {
        const bool named = app_.get_option("--config")->count() > 0; // the user's own file is counted only after this
        if (named) throw UsageError("--no-config: contradicts --config");
        return {};
    }
    std::ostringstream text;
    text << input.rdbuf();
    const std::string content = text.str();
    const std::size_t first = content.find_first_not_of(" \t\r\n");
    std::vector<CLI::ConfigItem> items;
    if (first != std::string::npos && content[first] == '{') {
        items = itemsOf(content);
    } else {
        std::istringstream lines(content);
        items = ConfigBase::from_config(lines);
    }
    std::erase_if(items, [&](const CLI::ConfigItem& item) { return leftOut_.count("--" + item.name) > 0; });
    for (CLI::ConfigItem& item : items) {
        if (!item.parents.empty()) throw CLI::ConfigError("[" + item.parents.front() + "]: there are no sections");
        const CLI::Option* option = app_.get_option_no_throw((item.name.size() == 1 ? "-" : "--") + item.name);
        if (option == nullptr) throw CLI::ConfigError("\"" + item.name + "\" is no flag; --help lists them all");
        if (option->count() == 0) supplied_.insert(option->get_name());
        const bool oneValue = option->get_multi_option_policy() == CLI::MultiOptionPolicy::TakeLast;
        if (oneValue && item.inputs.size() > 1) item.inputs = {CLI::detail::join(item.inputs, ",")};
    }
    return items;
}

std::string userConfigFile() {
    const std::filesystem::path folder = userConfigDirectory();
    for (const char* name : {"config.toml", "config.json"}) {
        std::error_code ignored;
        if (!folder.empty() && std::filesystem::is_regular_file(folder / name, ignored))
            return (folder / name).string();
    }
    return {};
}

} // namespace rt::app
