// What the shells complete: flags, their values, ids of scenes, and files of the endings that a flag takes.
#pragma once
#include <string>
#include <vector>

#include "Common/Manual/Page.h"

namespace rt::manual {

// Ids of the scenes that come with the programs.
using SceneIds = std::vector<std::string>;

std::string bashCompletion(const Page& page, const SceneIds& scenes);
std::string zshCompletion(const Page& page, const SceneIds& scenes);
std::string fishCompletion(const Page& page, const SceneIds& scenes);

} // namespace rt::manual
