// A program's page for man, section 1; the same bytes whenever and wherever it is made.
#pragma once
#include <string>

#include "Common/Manual/Page.h"

namespace rt::manual {

std::string manPage(const Page& page, const std::string& version);

} // namespace rt::manual
