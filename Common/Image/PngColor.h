// What a PNG says of its colours.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace rt::image {

// Why its colours are not what reading them as sRGB makes of them: a profile, a gamma or primaries that are others;
// nothing where the file says no such thing, or is no PNG. Never throws.
std::optional<std::string> otherColorsOfPng(std::span<const std::byte> bytes);

} // namespace rt::image
