#pragma once
#include <cstdint>
#include <string>

#include "Common/App/Session/Settings.h"
#include "Common/Image/Film.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Scene/Silhouettes.h"
#include "Common/Shared/Base/Types.h"

namespace rt::app {

// The settings as kernels see them for this scene.
shared::RenderParams makeRenderParams(const scene::CompiledScene& scene, const RenderSettings& settings);

// Side of the squares of pixels whose noise may be alike in a render with these features.
std::uint32_t dependentSide(shared::Features features);

// Whether any camera could have edges of lights in sight, at which its rays are to be split.
bool mayHaveEdges(const scene::CompiledScene& scene, const RenderSettings& settings);
// Where this camera's are; sets params.edgeRays. The camera is one of makeCamera(). No bits: nowhere.
scene::Silhouettes splitAtEdges(const scene::CompiledScene& scene, const shared::Camera& camera,
                                const RenderSettings& settings, shared::RenderParams& params);

// Whether they ask for an adaptive film and can have one: strata are made for a number of samples that is known.
bool isAdaptive(const RenderSettings& settings);
// Whether the samples of a pixel depend on how many it gets: strata, and plans, are made for a number of them.
bool isMadeForSpp(const RenderSettings& settings);
// An adaptive film has two halves: makes the number of replicates even.
void settleReplicates(RenderSettings& settings);
// The film that they ask for.
image::FilmDesc filmDesc(const RenderSettings& settings);

// What a kernel needs for this scene, camera and settings, and whatever else the settings force on it.
shared::Features renderFeatures(const scene::CompiledScene& scene, const scene::CameraDesc& camera,
                                const RenderSettings& settings);

// How each shape of light that exists is sampled, strategies of `auto` named: "sphere: cone, quad: auto (area, strip,
// ...)".
std::string describeLightShapes(const RenderSettings& settings, shared::Features features);

} // namespace rt::app
