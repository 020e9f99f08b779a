// Nothing that a render writes may take the place of what it reads, or of what else it writes.
#pragma once
#include "Common/App/Options/Options.h"

namespace rt::app {

// Looks at all files that the options name, through links. Throws UsageError naming both flags. Only the checkpoint may
// be the one that the render goes on from; devices and pipes may be written as often as one likes.
void checkDistinctFiles(const Options& options);

} // namespace rt::app
