// A configuration file: TOML, INI or JSON whose keys are the names of the flags.
#pragma once
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace rt::app {

class ConfigFile : public CLI::ConfigBase {
  public:
    // `usersOwn` is the file that is read where --config names none; it may be empty.
    ConfigFile(const CLI::App& app, std::string usersOwn) : app_(app), usersOwn_(std::move(usersOwn)) {}

    // Nothing with --no-config; without the flags that leaveOut() named. Throws UsageError.
    std::vector<CLI::ConfigItem> from_config(std::istream& input) const override;

    void leaveOut(const std::string& flag) { leftOut_.insert(flag); }
    // "FILE:LINE: ", or without the line, where the flag's value comes from the file; else empty.
    std::string placeOf(const std::string& flag) const;
    const std::string& usersOwn() const { return usersOwn_; }
    std::string path() const { return app_.get_option("--config")->as<std::string>(); } // of the one that is read

  private:
    const CLI::App& app_;
    std::string usersOwn_;
    std::set<std::string> leftOut_;
    mutable std::map<std::string, std::string> places_; // mutable: the base class reads through a const member
};

// The user's own file, $XDG_CONFIG_HOME/ray-tracing/config.toml or config.json; empty when there is none.
std::string userConfigFile();

} // namespace rt::app
