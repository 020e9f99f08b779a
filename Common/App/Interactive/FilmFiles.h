// What a window's session writes of a film: pictures, statistics, the line of the history.
#pragma once
#include <string>
#include <vector>

#include "Common/App/Interactive/FilmReference.h"
#include "Common/App/Interactive/PublishedState.h"
#include "Common/App/Interactive/RunHistory.h"
#include "Common/App/Session/FilmRun.h"
#include "Common/App/Session/SceneLoader.h"

namespace rt::app {

// Everything that can be written is; returns what cannot, one line each. `options`: of the film, complete but for what
// the request says.
std::vector<std::string> writeFilm(const SaveRequest& request, Options options, const LoadedScene& scene,
                                   const FilmRun& film, const FilmReference& reference, StopReason reason,
                                   PublishedState& state);

// What is seen, and nothing that only a film has. A preview without pixels is yet to be drawn.
void writePreview(const SaveRequest& request, const Preview& preview, PublishedState& state);

// What a run is of; its figures are yet to come.
RunRecord recordOfWork(const scene::CompiledScene& scene, bool oneSidedLights, const scene::CameraDesc& camera,
                       const RenderSettings& settings);
RunRecord makeRecord(const std::string& program, const LoadedScene& scene, const FilmRun& film,
                     const FilmReference& reference);

} // namespace rt::app
