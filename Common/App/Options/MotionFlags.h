// Flags of scenes that move: at which moment a picture is made, and sequences of pictures.
#pragma once
#include "Common/App/Options/FlagSet.h"
#include "Common/App/Options/Options.h"

namespace rt::app {

void addMotion(FlagSet& flags, Options& options);

// What --frames goes together with. Throws UsageError.
void settleFrames(const FlagSet& flags, const Options& options);

} // namespace rt::app
