#include "Common/Core/BuildInfo.h"

#include <BuildFacts.h> // generated: cmake/BuildInfo.cmake

namespace rt {

std::string versionText(const std::string& program) {
    const std::string commit = RT_COMMIT;
    return program + " " RT_VERSION "\n" + (commit.empty() ? "" : "commit " + commit + "\n") +
           "features: " RT_FEATURES "\ncompilers: " RT_COMPILERS;
}

} // namespace rt
