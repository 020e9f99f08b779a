#include "Common/Core/OwnFolder.h"

#include <random>
#include <string>
#include <system_error>

#include "Common/Core/Error.h"

namespace rt {

OwnFolder::OwnFolder() {
    std::random_device random;
    std::error_code error;
    do path_ = std::filesystem::temp_directory_path() / ("ray-tracing-" + std::to_string(random()));
    while (!std::filesystem::create_directory(path_, error) && !error); // somebody else's
    if (error) throw RenderError(path_.string() + ": cannot be made: " + error.message());
    std::filesystem::permissions(path_, std::filesystem::perms::owner_all, error);
}

OwnFolder::~OwnFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

} // namespace rt
