// What --help and --help-all print.
#pragma once
#include <string>

#include "Common/Manual/Page.h"

namespace rt::manual {

// One screen: 24 lines of 80 columns where the page names essentials; else all flags.
std::string helpText(const Page& page);

// Every flag, by groups, with what each value does; of each command as well.
std::string fullHelpText(const Page& page);

} // namespace rt::manual
