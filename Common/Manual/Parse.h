// How every program reads its command line by CLI11.
#pragma once
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "Common/Manual/Page.h"

namespace CLI {
class App;
}

namespace rt::manual {

// False: what was asked for, a help or the version, is on `out`. `page` makes the program's, of which help on a command
// takes that command's. Throws UsageError in one line; CLI::FileError, of a configuration file, is the caller's.
bool parse(CLI::App& app, std::vector<std::string> arguments, std::ostream& out, const std::function<Page()>& page);

} // namespace rt::manual
