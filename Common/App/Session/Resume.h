// Checkpoints: going on with a render exactly as if it had never stopped.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "Common/Image/Film.h"
#include "Common/Render/Engine.h"
#include "Common/Render/Settings.h"
#include "Common/Scene/CompiledScene.h"

namespace rt::app {

// Replaces the file. `motionHash`: the engine's. `seconds`: of sampling, by this program, if the file is to tell.
// Throws RenderError.
void saveCheckpoint(const std::string& file, const RenderSettings& settings, const scene::CompiledScene& scene,
                    const EngineReport& report, std::uint64_t motionHash, std::optional<double> seconds,
                    const image::Film& film);

// The film to go on from. The render that is asked for must be the same but for its length; InputError names the first
// field that differs. What only says how the film is kept, or how its strata were laid out, is taken over into
// `settings`.
image::Film loadCheckpoint(const std::string& file, RenderSettings& settings, const scene::CompiledScene& scene,
                           const EngineReport& report, std::uint64_t motionHash);

} // namespace rt::app
