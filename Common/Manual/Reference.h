// The chapter of a program in docs/reference.md.
#pragma once
#include <string>

#include "Common/Manual/Page.h"

namespace rt::manual {

std::string referenceChapter(const Page& page);

} // namespace rt::manual
