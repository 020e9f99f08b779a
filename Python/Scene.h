// A compiled scene as scripts use it.
#pragma once
#include "Common/Probe/SceneFormulas.h"

namespace rt::python {

using Scene = probe::SceneFormulas;

} // namespace rt::python
