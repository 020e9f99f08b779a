// The window of a program from its opening to its end.
#pragma once
#include <string>
#include <vector>

#include "Common/App/Interactive/InteractiveSession.h"
#include "Common/App/Options/Options.h"
#include "Common/Core/Error.h"

namespace rt::gui {

struct WindowProgram {
    app::EngineMaker makeEngine;            // called on the session's thread
    std::vector<app::EngineDevice> devices; // of ray-tracing-gpu, those that are suitable
};

// Returns when the user closes the window. Throws what the options ask in vain: no display, no device, no such scene.
ExitCode runWindow(const app::Options& options, const WindowProgram& program);

} // namespace rt::gui
