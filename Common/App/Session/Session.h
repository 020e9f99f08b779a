// The whole program behind the flags. Start reading here.
#pragma once
#include <functional>
#include <memory>

#include "Common/App/Options/Options.h"
#include "Common/App/Session/Engine.h"
#include "Common/Core/Error.h"

namespace rt::app {

using EngineFactory = std::function<std::unique_ptr<Engine>()>;

// Does what the options say with an engine that is made only when something is to be rendered. Errors are exceptions,
// of which RunMain.h makes the line and the exit code.
ExitCode runSession(Options options, const EngineFactory& makeEngine);

} // namespace rt::app
