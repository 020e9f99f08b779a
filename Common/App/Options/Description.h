// What the help and the manual of ray-tracing-cpu and ray-tracing-gpu say beside their flags.
#pragma once
#include <string>

#include "Common/App/Options/FlagSet.h"

namespace rt::app {

void describeProgram(FlagSet& flags, const std::string& program);

} // namespace rt::app
