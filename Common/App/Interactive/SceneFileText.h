// The text that an edited scene is saved as.
#pragma once
#include <string>

#include "Common/Scene/Moment.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::app {

// `source`: what was edited, by its whole path, at that moment; `file`: where the text is going to be. What was
// imported or taken in is named, by a path from there where there is one, with what is otherwise now. A model that cannot
// be read any more, or of which nothing is left, is not named: all of it is in the text.
std::string sceneFileText(const scene::SceneDesc& scene, const std::string& source, const scene::Moment& moment,
                          const std::string& file);

} // namespace rt::app
