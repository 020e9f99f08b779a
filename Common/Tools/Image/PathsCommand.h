// ray-tracing-image paths.
#pragma once
#include <ostream>

#include "Common/Tools/Image/ImageArguments.h"

namespace rt::tools {

// Prints the figures and writes the strip, if one is asked for. Throws UsageError and InputError.
void runPaths(const ImageArguments& arguments, std::ostream& out);

} // namespace rt::tools
