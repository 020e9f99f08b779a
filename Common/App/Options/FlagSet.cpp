#include "Common/App/Options/FlagSet.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

#include "Common/App/Options/ConfigFile.h"
#include "Common/Core/BuildInfo.h"
#include "Common/Core/Error.h"
#include "Common/Manual/Parse.h"

namespace rt::app {
namespace {

std::string firstSpelling(const std::string& flags) {
    return flags.substr(0, flags.find(','));
}

} // namespace

FlagSet::FlagSet(const std::string& program, const std::string& description)
    : app_(description, program), config_(std::make_shared<ConfigFile>(app_)) {
    app_.option_defaults()->take_last();
    app_.allow_extras();
    app_.allow_config_extras(CLI::config_extras_mode::error);
    app_.config_formatter(config_);
    app_.set_config("--config", userConfigFile(), "defaults of flags, as TOML, INI or JSON")
        ->type_name("F.toml|.json|.ini")
        ->configurable(false);
    addSwitch("--no-config", noConfig_,
              "ignore the user's configuration file; a window keeps no settings, layout, history and references")
        ->configurable(false);
    app_.set_help_flag("--help,-h", "print the flags that matter most and exit");
    app_.set_help_all_flag("--help-all", "print every flag and exit");
    app_.set_version_flag("--version", versionText(program), "print version, commit, features and compilers and exit");
}

CLI::Option* FlagSet::add(const std::string& flags, const std::string& type, const std::string& help, Reader read) {
    const std::string flag = firstSpelling(flags);
    readers_.emplace_back(flag, read);
    const auto callback = [this, flag, read = std::move(read)](const std::string& text) {
        try {
            read(flag, text);
        } catch (const UsageError& error) {
            throw UsageError(config_->placeOf(flag) + error.what());
        }
    };
    return app_.add_option_function<std::string>(flags, callback, help)->type_name(type);
}

CLI::Option* FlagSet::addSwitch(const std::string& flags, bool& target, const std::string& help) {
    return app_.add_flag(flags, target, help);
}

CLI::Option* FlagSet::addFile(const std::string& flags, const std::string& type, std::string& target,
                              const std::string& help) {
    return add(flags, type, help, [&target](const std::string& flag, const std::string& text) {
        if (text.empty()) refuseValue(flag, text, "the name of a file");
        target = text;
    });
}

CLI::Option* FlagSet::addFiles(const std::string& flags, const std::string& type, std::vector<std::string>& target,
                               const std::string& help) {
    const std::string flag = firstSpelling(flags);
    const auto callback = [this, &target, flag](const std::vector<std::string>& files) {
        for (const std::string& file : files)
            if (file.empty()) refuseValue(config_->placeOf(flag) + flag, file, "the name of a file");
        target = files;
    };
    return app_.add_option_function<std::vector<std::string>>(flags, callback, help)
        ->type_name(type)
        ->take_all()
        ->allow_extra_args(false);
}

CLI::Option* FlagSet::addSeconds(const std::string& flags, std::optional<double>& target, const std::string& help) {
    return add(flags, "S", help, [&target](const std::string& flag, const std::string& text) {
        constexpr double kMin = std::numeric_limits<double>::min();
        constexpr double kMax = 1e9; // 30 years
        target = parseReal(flag, text, kMin, kMax, "a number of seconds above 0, at most 1e9");
    });
}

void FlagSet::refuse(const std::string& flag, const std::string& why) {
    // Takes any number of values, so that the flag is blamed and not what follows it.
    const auto callback = [this, flag, why](const std::vector<std::string>&) {
        throw UsageError(config_->placeOf(flag) + flag + ": " + why);
    };
    app_.add_option_function<std::vector<std::string>>(flag, callback)->expected(0, -1)->group("");
}

void FlagSet::readEnvironment(const std::string& flag, const std::string& variable) {
    variables_.push_back({flag, variable});
    const char* value = std::getenv(variable.c_str());
    if (value != nullptr && *value != '\0') config_->leaveOut(flag);
}

void FlagSet::applyEnvironment() {
    for (const Variable& variable : variables_) {
        const char* value = std::getenv(variable.name.c_str());
        if (value == nullptr || *value == '\0' || given(variable.flag)) continue;
        for (const auto& [flag, read] : readers_)
            if (flag == variable.flag) read(variable.name, value);
    }
}

void FlagSet::describe(std::vector<std::string> essentials, std::vector<manual::Term> examples,
                       std::vector<manual::Term> environment) {
    description_.essentials = std::move(essentials);
    description_.examples = std::move(examples);
    description_.environment = std::move(environment);
}

manual::Page FlagSet::page() const {
    manual::Page page = manual::pageOf(app_);
    page.essentials = description_.essentials;
    page.examples = description_.examples;
    page.environment = description_.environment;
    for (manual::Flag& flag : page.flags)
        if (flag.names.front() == "--config") flag.byDefault.clear(); // it is this user's own file
    return page;
}

bool FlagSet::given(const std::string& flag) const {
    const CLI::Option* option = findOption(app_, flag);
    return option != nullptr && option->count() > 0;
}

bool FlagSet::isFromFile(const std::string& flag) const {
    return !config_->placeOf(flag).empty();
}

bool FlagSet::parse(std::vector<std::string> arguments, std::ostream& out) {
    config_->forgetPlaces();
    config_->setNamed(std::any_of(arguments.begin(), arguments.end(), [](const std::string& argument) {
        return argument == "--config" || argument.starts_with("--config=");
    }));
    try {
        if (!manual::parse(app_, std::move(arguments), out, [this] { return page(); })) return false;
    } catch (const CLI::FileError&) {
        throw UsageError("--config " + config_->path() + ": cannot be read");
    }
    if (const auto unknown = app_.remaining(); !unknown.empty())
        throw UsageError(unknown.front() + ": unknown flag; --help-all lists them all");
    applyEnvironment();
    return true;
}

} // namespace rt::app
