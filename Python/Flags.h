// Flags of the programs as a script gives them: the same parser reads them, with the same errors.
#pragma once
#include <string>
#include <vector>

#include "Common/App/Options/Options.h"

namespace rt::python {

// Of ray-tracing-cpu or ray-tracing-gpu: `arguments` as on a command line, of a render without a window. Throws
// UsageError. May be called by any thread.
app::Options parseFlags(const std::string& program, const std::vector<std::string>& arguments);

} // namespace rt::python
