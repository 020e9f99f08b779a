// What a configuration file says, before anybody asks what it means.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace rt::app {

struct ConfigEntry {
    std::string name;
    std::vector<std::string> values; // at least one
    std::string place;               // FILE:LINE; of JSON, FILE alone
};

// Reads JSON, {"spp": 500, "sampler": "stratified"}, or lines of TOML or INI:
//
//     # a comment, as is ; at the start of a line
//     spp = 500
//     sampler = "stratified"              text in quotes, of either kind, is taken as it is
//     output = ["a.png", "b.exr"]         may go on over several lines
//
// Throws UsageError, which names file and line, for whatever is neither, for names that appear twice, for sections and
// for bytes that are no text. `file` is what errors call it.
std::vector<ConfigEntry> readConfigText(const std::string& text, const std::string& file);

} // namespace rt::app
