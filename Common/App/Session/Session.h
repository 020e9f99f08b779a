// The whole program behind the flags. Start reading here.
#pragma once
#include <functional>
#include <memory>

#include "Common/App/Options/Options.h"
#include "Common/App/Ranks/Communicator.h"
#include "Common/Core/Error.h"
#include "Common/Render/Engine.h"

namespace rt::app {

using EngineFactory = std::function<std::unique_ptr<Engine>()>;

// Does what the options say with an engine that is made only when something is to be rendered. Errors are exceptions,
// of which RunMain.h makes the line and the exit code. As rank 0 of `ranks`, if there are any, it shares a render out.
ExitCode runSession(Options options, const EngineFactory& makeEngine, Communicator* ranks = nullptr);

// As another rank: takes part in rank 0's render of the same options, and returns when rank 0 has ended it; of a
// sequence it renders frames of its own. Returns whether it has got rank 0's End.
bool followSession(Options options, const EngineFactory& makeEngine, Communicator& ranks);

} // namespace rt::app
