// What an image file says of its own making.
#pragma once
#include <string>

#include "Common/App/Options/Options.h"
#include "Common/Image/Film.h"
#include "Common/Render/Engine.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::app {

// One line of JSON: program, scene, engine, device, samples done, and "arguments", a list that makes the program render
// the image again. `options` are complete, with the size in pixels; what was stopped early is rendered to its whole
// SPP.
std::string renderNote(const Options& options, const scene::CameraDesc& camera, const EngineReport& report,
                       const image::Film& film);

} // namespace rt::app
