// ray-tracing-image probe.
#pragma once
#include <ostream>

#include "Common/Tools/Image/ImageArguments.h"

namespace rt::tools {

// Prints the figures and writes the picture, if one is asked for. Throws UsageError and InputError.
void runProbe(const ImageArguments& arguments, std::ostream& out);

} // namespace rt::tools
