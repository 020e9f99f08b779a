// Editing of the scene by way of the window, beyond its panels: what is clicked in the picture, how that is seen, and
// what moves with the pointer.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "Common/App/Interactive/ObjectList.h"
#include "Common/App/Interactive/ObjectTool.h"
#include "Common/App/Interactive/SceneEditor.h"
#include "Common/Gui/Layout.h"

namespace rt::gui {

struct Gui;

// What the window keeps of it between frames.
struct SceneEditing {
    // A pixel of the picture that was clicked, and where it was seen from.
    struct Click {
        scene::CameraDesc camera;
        std::array<std::uint32_t, 2> pixel{}, size{};
    };
    std::optional<Click> click; // until what it meets can be named
    std::optional<app::ObjectTool> tool;
    bool isToolStale = false; // though the pointer rests
    std::uint64_t toolGesture = 0;
    std::uint64_t pressGesture = 0; // of what is changed while the mouse is held
    app::ObjectList list;
    std::uint64_t listRevision = ~std::uint64_t{0}; // of the scene's structure that it was built of
    std::string listSearch, search;
    std::set<scene::ObjectPath> open; // groups
    bool isListStale = true, revealsSelection = false;
    std::string materialCounted; // how many surfaces have it
    std::uint64_t countRevision = ~std::uint64_t{0};
    std::size_t materialUses = 0;
    std::function<void()> whenSaved; // what waits until the user has said what becomes of unsaved edits; none
    bool goesOnAfterSaving = false;
    bool isDiscarded = false; // what is not saved is not wanted
};

// Each frame, before anything is drawn.
void followEditing(Gui& gui);
// Makes a step of the history; what is refused is told. Whether it was made. `isHeld`: while the mouse is held on what
// changes it, all of it is one step.
bool editScene(Gui& gui, const std::string& name, std::vector<scene::SceneEdit> edits, bool isHeld = true);
void undoEdit(Gui& gui);
void redoEdit(Gui& gui);
void saveScene(Gui& gui);   // to its file, or to one that is asked for
void saveSceneAs(Gui& gui); // to one that is asked for
// Does it at once, or when the user has decided about edits that are not saved.
void onceSaved(Gui& gui, std::function<void()> action);
void drawUnsaved(Gui& gui); // asks for that

void pickObject(Gui& gui, const std::array<std::uint32_t, 2>& pixel); // what is seen there becomes selected
void deleteSelection(Gui& gui);
void duplicateSelection(Gui& gui);
void frameSelection(Gui& gui); // moves the camera until it is in sight; turns it not
void deselect(Gui& gui);

// A tool, by which the pointer moves what is selected until a click, Enter or Escape.
void beginTool(Gui& gui, app::ObjectTool::Kind kind);
void endTool(Gui& gui, bool isConfirmed);
void drawSelection(Gui& gui, const Rect& image, const Rect& area); // outlined in the picture; follows the pointer

} // namespace rt::gui
