// Where something stands in a pbrt file.
#pragma once
#include <cstddef>
#include <memory>
#include <string>

#include "Common/Core/Error.h"

namespace rt::scene {

struct PbrtPlace {
    std::shared_ptr<const std::string> file;
    std::size_t line = 0; // from 1

    std::string text() const { return *file + ":" + std::to_string(line); }
    // "FILE:LINE: MESSAGE"
    [[noreturn]] void fail(const std::string& message) const { throw InputError(text() + ": " + message); }
};

} // namespace rt::scene
