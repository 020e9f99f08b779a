// The headers of an OpenEXR file, before the format's library reads them.
#pragma once
#include <cstddef>
#include <span>
#include <string>

namespace rt::image {

// Throws InputError naming `name` unless every attribute lies inside the file and has the size of its type: the library
// takes the memory that a size asks for, up to 2 GiB, before it finds that the file ends.
void checkExrHeaders(std::span<const std::byte> bytes, const std::string& name);

} // namespace rt::image
