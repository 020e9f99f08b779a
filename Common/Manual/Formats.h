// What is made of a page for others to read; the same bytes whenever and wherever it is made.
#pragma once
#include <string>
#include <vector>

#include "Common/Manual/Page.h"

namespace rt::manual {

std::string manPage(const Page& page, const std::string& version); // of section 1
std::string referenceChapter(const Page& page);                    // of docs/reference.md

// Ids of the scenes that come with the programs.
using SceneIds = std::vector<std::string>;

// What the shells complete: flags, their values, ids of scenes, and files of the endings that a flag takes.
std::string bashCompletion(const Page& page, const SceneIds& scenes);
std::string zshCompletion(const Page& page, const SceneIds& scenes);
std::string fishCompletion(const Page& page, const SceneIds& scenes);

} // namespace rt::manual
