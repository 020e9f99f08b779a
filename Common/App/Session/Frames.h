// The pictures of --frames, each as a render of its own.
#pragma once
#include <cstdint>

#include "Common/App/Options/Options.h"

namespace rt::app {

// What one frame is rendered by: NAME.0007.EXT for NAME.EXT, at its time. It goes on from the checkpoint that an
// interrupted one has left beside its first output.
Options optionsOfFrame(const Options& sequence, std::uint32_t frame);

// Whether all files of a frame are there, and no checkpoint that says that they are of a part of its samples.
bool isRendered(const Options& frame);

// A frame that is done needs none.
void removeCheckpoint(const Options& frame);

} // namespace rt::app
