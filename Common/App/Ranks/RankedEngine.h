// All ranks as one engine: rank 0 drives it as it would drive its own.
#pragma once
#include <memory>

#include "Common/App/Ranks/Communicator.h"
#include "Common/Render/Engine.h"

namespace rt::app {

// `local` renders here, on a thread of its own, what rank 0 has leased to itself. Other ranks run serveLeases(). Any
// rank's failure is thrown as an rt::Error of its exit code; what has been gathered stays on the film.
std::unique_ptr<Engine> makeRankedEngine(std::unique_ptr<Engine> local, Communicator& ranks);

} // namespace rt::app
