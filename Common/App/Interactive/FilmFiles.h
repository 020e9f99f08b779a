// What a window's session writes of a film: pictures, statistics, the line of the history.
#pragma once
#include <string>
#include <vector>

#include "Common/App/Interactive/FilmReference.h"
#include "Common/App/Interactive/PublishedState.h"
#include "Common/App/Interactive/RunHistory.h"
#include "Common/App/Session/SceneLoader.h"
#include "Common/Render/FilmRun.h"

namespace rt::app {

// Everything that can be written is; returns what cannot, one line each. `options`: of the film, complete but for what
// the request says.
std::vector<std::string> writeFilm(const SaveRequest& request, Options options, const LoadedScene& scene,
                                   const FilmRun& film, const FilmReference& reference, StopReason reason,
                                   PublishedState& state);

// Of a preview or of a race: the radiance that is seen, and nothing that only a film has.
void writePicture(const SaveRequest& request, const Picture& picture, PublishedState& state);

// What a run is of; its figures are yet to come.
RunRecord recordOfWork(const scene::CompiledScene& scene, bool oneSidedLights, const scene::CameraDesc& camera,
                       const RenderSettings& settings);
RunRecord makeRecord(const std::string& program, const LoadedScene& scene, const FilmRun& film,
                     const FilmReference& reference);

} // namespace rt::app
