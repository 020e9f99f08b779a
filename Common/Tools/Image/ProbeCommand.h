// ray-tracing-image probe.
#pragma once
#include <array>
#include <cstdint>
#include <ostream>
#include <string>

#include "Common/App/Options/Options.h"
#include "Common/Tools/Image/ImageArguments.h"

namespace rt::tools {

// What the arguments say of scene, camera and size.
void applyPixel(const PixelArguments& arguments, app::Options& options);
// Of "X,Y". Throws UsageError where it is none of the image's.
std::array<std::uint32_t, 2> pixelOf(const std::string& text, const app::RenderSettings& settings);

// Prints the figures and writes the picture, if one is asked for. Throws UsageError and InputError.
void runProbe(const ImageArguments& arguments, std::ostream& out);

} // namespace rt::tools
