// Images that a render is compared with.
#pragma once
#include <cstdint>
#include <string>

#include "Common/Image/Image.h"

namespace rt::app {

// A linear image of exactly this size whose values are all finite. Throws InputError saying what is wrong.
image::Image readReference(const std::string& file, std::uint32_t width, std::uint32_t height);

} // namespace rt::app
