// Flags by CLI11 with this project's manners: every error is a UsageError of one line, and a value comes from the
// command line, else from the environment, else from the configuration file.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "Common/App/Options/OptionValues.h"
#include "Common/Manual/Page.h"

namespace rt::app {

class ConfigFile;

// `flags` is a comma-separated list of spellings, of which errors name the first. Targets must outlive parse(), which
// leaves those alone that nothing was said about.
class FlagSet {
  public:
    // Is called with the flag's (or the environment variable's) name and the text of the value.
    using Reader = std::function<void(const std::string& flag, const std::string& text)>;

    FlagSet(const std::string& program, const std::string& description);

    void group(const std::string& title) {
        app_.option_defaults()->group(title);
    } // of the flags that follow, in --help

    CLI::Option* add(const std::string& flags, const std::string& type, const std::string& help, Reader read);
    CLI::Option* addSwitch(const std::string& flags, bool& target, const std::string& help);
    // `type`: a form of Common/Manual/Values.h, such as "F.png|.exr".
    CLI::Option* addFile(const std::string& flags, const std::string& type, std::string& target,
                         const std::string& help);
    CLI::Option* addFiles(const std::string& flags, const std::string& type, std::vector<std::string>& target,
                          const std::string& help);
    CLI::Option* addSeconds(const std::string& flags, std::optional<double>& target, const std::string& help);

    // T is std::uint32_t or an optional of it.
    template <class T>
    CLI::Option* addWhole(const std::string& flags, T& target, std::uint32_t min, std::uint32_t max,
                          const std::string& help) {
        return add(flags, "N", help, [&target, min, max](const std::string& flag, const std::string& text) {
            target = parseWhole(flag, text, min, max);
        });
    }

    template <class E, std::size_t N>
    CLI::Option* addChoice(const std::string& flags, const Named<E> (&table)[N], E& target, const std::string& help) {
        std::string type, text = help, byDefault;
        for (const auto& row : table) {
            type += (type.empty() ? "" : "|") + std::string(row.name);
            if (row.help) text += "\n  " + std::string(row.name) + ": " + row.help;
            if (row.value == target) byDefault = row.name;
        }
        const auto read = [&target, &table](const std::string& flag, const std::string& text) {
            target = parseChoice(flag, text, table);
        };
        return add(flags, type, text, read)->default_str(byDefault);
    }

    // A flag that exists elsewhere; using it is an error that says so.
    void refuse(const std::string& flag, const std::string& why);
    // The variable stands for the flag where the command line lacks it.
    void readEnvironment(const std::string& flag, const std::string& variable);

    // What --help and the manual say beside the flags themselves.
    void describe(std::vector<std::string> essentials, std::vector<manual::Term> examples,
                  std::vector<manual::Term> environment);
    manual::Page page() const;

    // Returns false when --help, --help-all or --version was asked for and has been answered on `out`.
    bool parse(std::vector<std::string> arguments, std::ostream& out);
    bool given(const std::string& flag) const;
    bool isFromFile(const std::string& flag) const; // and not from the command line

  private:
    void applyEnvironment();

    struct Variable {
        std::string flag, name;
    };
    CLI::App app_;
    std::shared_ptr<ConfigFile> config_;
    manual::Page description_; // without what the parser knows
    std::vector<Variable> variables_;
    std::vector<std::pair<std::string, Reader>> readers_; // by first spelling
    bool noConfig_ = false;
};

} // namespace rt::app
