// What this build is: its version, the commit it was made from, what it was built with.
#pragma once
#include <string>

namespace rt {

const std::string& programVersion(); // "1.0.0"

// What --version prints: "ray-tracing-cpu 1.0.0" and a line each on commit, features and compilers.
std::string versionText(const std::string& program);

} // namespace rt
