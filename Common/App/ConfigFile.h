// A configuration file in TOML, INI or JSON: {"spp": 500, "sampler": "stratified"}. Keys are the names of the flags.
#pragma once
#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace rt::app {

class ConfigFile : public CLI::ConfigBase {
  public:
    explicit ConfigFile(const CLI::App& app) : app_(app) {}

    // Nothing with --no-config; without the flags that leaveOut() named.
    std::vector<CLI::ConfigItem> from_config(std::istream& input) const override;

    void leaveOut(const std::string& flag) { leftOut_.insert(flag); }
    bool supplied(const std::string& flag) const { return supplied_.count(flag) > 0; }

  private:
    const CLI::App& app_;
    std::set<std::string> leftOut_;
    mutable std::set<std::string> supplied_; // mutable: the base class reads through a const member
};

// The user's own file, $XDG_CONFIG_HOME/ray-tracing/config.toml or config.json; empty when there is none.
std::string userConfigFile();

} // namespace rt::app
