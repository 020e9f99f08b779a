// What the panel of objects is made of: their tree, and what it says of one of them, to be changed there.
#pragma once
#include "Common/Gui/Gui.h"

namespace rt::gui {

void drawObjectTree(Gui& gui);
// `path`: of one that is selected; what is changed of it becomes the others', where they have the like.
void drawObjectFields(Gui& gui, const scene::ObjectPath& path);
void drawMaterialFields(Gui& gui, const scene::ObjectPath& path);
void drawSkyFields(Gui& gui);
void drawMaterialLibrary(Gui& gui);

// A colour of linear components; one beyond 1 is divided by its largest, which is a field of its own.
bool inputColor(const char* label, const char* tip, glm::dvec3& color);
bool inputLight(const char* label, const char* tip, glm::dvec3& color);

} // namespace rt::gui
