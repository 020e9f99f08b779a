#pragma once
#include <cstdint>

#include "Common/Scene/SceneDesc.h"
#include "Common/Shared/Base/Types.h"

namespace rt::scene {

// The camera that kernels see: `desc` in the coordinates relative to `origin` (CompiledScene::origin), for an image of
// width x height pixels. Computed in double and rounded once, so a camera far from zero loses nothing. Throws
// InputError for a camera that has no orientation: lookFrom equals lookAt, or up is parallel to the view; or whose
// numbers are out of range.
shared::Camera makeCamera(const CameraDesc& desc, std::uint32_t width, std::uint32_t height, const glm::dvec3& origin);

} // namespace rt::scene
