// A configuration file: TOML, INI or JSON whose keys are the names of the flags.
#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace rt::app {

// Nothing where there is no such flag. In CLI::App::get_option() and its kin want of memory ends the program.
const CLI::Option* findOption(const CLI::App& app, const std::string& flag);

class ConfigFile : public CLI::ConfigBase {
  public:
    explicit ConfigFile(const CLI::App& app) : app_(app) {}

    // Nothing with --no-config; without the flags that leaveOut() named. Throws UsageError.
    std::vector<CLI::ConfigItem> from_config(std::istream& input) const override;

    void leaveOut(const std::string& flag) { leftOut_.insert(flag); }
    // "FILE:LINE: ", or without the line, where the flag's value comes from the file; else empty.
    std::string placeOf(const std::string& flag) const;
    std::string path() const { return findOption(app_, "--config")->as<std::string>(); }
    void forgetPlaces() { places_.clear(); }
    // Whether the command line has --config. Some versions of CLI11 count the user's own file as given, too.
    void setNamed(bool named) { isNamed_ = named; }

  private:
    const CLI::App& app_;
    bool isNamed_ = false;
    std::set<std::string> leftOut_;
    mutable std::map<std::string, std::string> places_; // mutable: the base class reads through a const member
};

// The user's own file, $XDG_CONFIG_HOME/ray-tracing/config.toml or config.json; empty when there is none.
std::string userConfigFile();

} // namespace rt::app
