// The engines that this build has.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "Common/App/Options/Options.h"
#include "Common/Render/Engine.h"

namespace rt::python {

// The one that the options ask for, ray-tracing-cpu's or ray-tracing-gpu's. Throws UsageError where this build lacks
// it, and what making it throws.
std::unique_ptr<app::Engine> makeEngine(const app::Options& options);

bool hasGpuEngine();      // in this build
bool hasHardwareDevice(); // for it, on this machine: not a driver that lets the processor do the work
std::string describeDevices();

} // namespace rt::python
