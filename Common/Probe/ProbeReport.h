// What is written of a probe: figures as JSON, pictures as files.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "Common/Probe/ProbeRun.h"

namespace rt::probe {

// `scene`: its id. Of a result that is done.
nlohmann::ordered_json figuresOf(const ProbeResult& result, const std::string& scene,
                                 const std::array<std::uint32_t, 2>& pixel);

// Writes the picture; where the file's format is not display-referred the first map alone. Throws RenderError.
void writePicture(const std::string& file, const ProbeResult& result);

} // namespace rt::probe
