#include "Common/Core/BuildInfo.h"

#include <BuildFacts.h> // generated: cmake/BuildInfo.cmake

namespace rt {

const std::string& programVersion() {
    static const std::string version = RT_VERSION;
    return version;
}

std::string versionText(const std::string& program) {
    const std::string commit = RT_COMMIT;
    return program + " " + programVersion() + "\n" + (commit.empty() ? "" : "commit " + commit + "\n") +
           "features: " RT_FEATURES "\ncompilers: " RT_COMPILERS;
}

} // namespace rt
