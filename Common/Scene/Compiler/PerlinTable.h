#pragma once
#include <cstdint>

#include "Common/Scene/CompiledScene.h"

namespace rt::scene {

// Appends the gradients (uniform on the unit sphere) and the three permutations that `seed` stands for; returns the
// index of the table. The same on every machine.
std::uint32_t appendPerlinTable(std::uint32_t seed, CompiledScene& out);

} // namespace rt::scene
