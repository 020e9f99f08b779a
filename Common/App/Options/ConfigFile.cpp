#include "Common/App/Options/ConfigFile.h"

#include <algorithm>
#include <filesystem>

#include "Common/App/Options/ConfigText.h"
#include "Common/App/Options/OptionValues.h"
#include "Common/App/Platform.h"
#include "Common/Core/Error.h"

namespace rt::app {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20;

std::string readAll(std::istream& input, const std::string& file) {
    std::string text(kMaxBytes + 1, '\0');
    input.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (input.bad()) throw UsageError("--config " + file + ": cannot be read");
    text.resize(static_cast<std::size_t>(input.gcount()));
    if (text.size() > kMaxBytes)
        throw UsageError("--config " + file + ": must be of at most " + std::to_string(kMaxBytes) + " bytes");
    return text;
}

} // namespace

const CLI::Option* findOption(const CLI::App& app, const std::string& flag) {
    const std::vector<const CLI::Option*> options = app.get_options();
    const auto isNamed = [&flag](const CLI::Option* option) { return option->check_name(flag); };
    const auto found = std::find_if(options.begin(), options.end(), isNamed);
    return found == options.end() ? nullptr : *found;
}

std::vector<CLI::ConfigItem> ConfigFile::from_config(std::istream& input) const {
    if (findOption(app_, "--no-config")->count() > 0) {
        if (isNamed_) throw UsageError("--no-config: contradicts --config");
        return {};
    }
    std::vector<CLI::ConfigItem> items;
    for (const ConfigEntry& entry : readConfigText(readAll(input, path()), path())) {
        if (leftOut_.count("--" + entry.name) > 0) continue;
        const CLI::Option* option = findOption(app_, (entry.name.size() == 1 ? "-" : "--") + entry.name);
        const std::string named = entry.place + ": \"" + excerpt(entry.name) + "\" ";
        if (option == nullptr) throw UsageError(named + "is no flag; --help-all lists them all");
        if (!option->get_configurable()) throw UsageError(named + "can be given on the command line only");
        CLI::ConfigItem item;
        item.name = entry.name;
        item.inputs = entry.values;
        const bool isSwitch = option->get_expected_max() == 0;
        const bool oneValue = isSwitch || option->get_multi_option_policy() == CLI::MultiOptionPolicy::TakeLast;
        if (oneValue && item.inputs.size() > 1) item.inputs = {CLI::detail::join(item.inputs, ",")};
        if (isSwitch && item.inputs.front() != "true" && item.inputs.front() != "false")
            refuseValue(entry.place + ": " + option->get_name(), item.inputs.front(), "true or false");
        if (option->count() == 0) places_["--" + option->get_single_name()] = entry.place + ": ";
        items.push_back(std::move(item));
    }
    return items;
}

std::string ConfigFile::placeOf(const std::string& flag) const {
    const auto place = places_.find(flag);
    return place != places_.end() ? place->second : "";
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
