#include "Common/Core/Error.h"

#include <filesystem>
#include <new>

namespace rt {

std::string messageOf(const std::exception& error) {
    if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return "not enough memory";
    if (const auto* const file = dynamic_cast<const std::filesystem::filesystem_error*>(&error))
        return file->path1().string() + ": " + file->code().message();
    return error.what();
}

} // namespace rt
