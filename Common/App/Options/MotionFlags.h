// Flags of scenes that move: at which moment a picture is made, and sequences of pictures.
#pragma once
#include "Common/App/Options/FlagSet.h"
#include "Common/App/Options/Options.h"

namespace rt::app {

void addMotion(FlagSet& flags, Options& options);

// A shutter that closes when it opens is a time, which the moment then has; of a sequence each frame has its own.
void settleInstant(Options& options);

// What --shutter and --frames go together with. Throw UsageError.
void settleShutter(Options& options);
void settleFrames(const FlagSet& flags, const Options& options);

} // namespace rt::app
