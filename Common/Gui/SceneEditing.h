// Editing of the scene by way of the window, beyond its panels: what is clicked in the picture, and how that is seen.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "Common/App/Interactive/ObjectList.h"
#include "Common/App/Interactive/ObjectTool.h"
#include "Common/App/Interactive/SceneEditor.h"
#include "Common/Gui/Layout.h"

namespace rt::gui {

struct Gui;

// What the pointer moves by a handle of the gizmo.
struct GizmoDrag {
    bool hasBegun = false;                    // the pointer has left where it was pressed
    bool duplicates = false;                  // as soon as it does
    std::vector<scene::ObjectPath> originals; // of copies, which move; none
    std::uint64_t copyGesture = 0;
};

// What the window keeps of it between frames.
struct SceneEditing {
    // A pixel of the picture that was clicked, and where it was seen from.
    struct Click {
        scene::CameraDesc camera;
        std::array<std::uint32_t, 2> pixel{}, size{};
        bool isAdded = false; // to what is selected, or removed from it
    };
    std::optional<Click> click; // until what it meets can be named
    std::optional<app::ObjectTool> tool;
    std::optional<GizmoDrag> drag; // where the tool is by the gizmo
    bool isToolStale = false;      // though the pointer rests
    bool isSnapped = false, hasMoved = false;
    std::string toolText; // beside the pointer; empty: nothing to tell yet
    std::uint64_t toolGesture = 0;
    std::optional<app::ToolAxes> axes; // where the gizmo was last, of the selection with that serial number
    std::uint64_t axesSelection = 0;
    std::optional<std::optional<app::ObjectTool::Constraint>> hovered; // the handle under the pointer
    std::uint64_t pressGesture = 0;                                    // of what is changed while the mouse is held
    app::ObjectList list;
    std::uint64_t listRevision = ~std::uint64_t{0}; // of the scene's structure that it was built of
    std::string listSearch, search;
    std::set<scene::ObjectPath> open;            // groups
    std::optional<scene::ObjectPath> rangeStart; // of the tree's rows that are selected with Shift; none yet
    bool isListStale = true, revealsSelection = false;
    std::string materialCounted; // how many surfaces have it
    std::uint64_t countRevision = ~std::uint64_t{0};
    std::size_t materialUses = 0;
    bool isAnyHidden = false; // of the scene's objects, at that revision
    std::uint64_t hiddenRevision = ~std::uint64_t{0};
    std::function<void()> whenSaved; // what waits until the user has said what becomes of unsaved edits; none
    bool goesOnAfterSaving = false;
    bool isDiscarded = false; // the window closes, and what is not saved is not wanted
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

// What is seen there becomes selected. `isAdded`: beside what is selected by now; or no longer, where it is that.
void pickObject(Gui& gui, const std::array<std::uint32_t, 2>& pixel, bool isAdded);
void deleteSelection(Gui& gui);
void duplicateSelection(Gui& gui);
void assignMaterial(Gui& gui, const std::string& name); // to what is selected and has surfaces
void frameSelection(Gui& gui);                          // moves the camera until it is in sight; turns it not
void deselect(Gui& gui);
void hideObjects(Gui& gui, const std::vector<scene::ObjectPath>& paths, bool areHidden);
void hideSelection(Gui& gui); // or shows it, where all of it is hidden
void soloSelection(Gui& gui); // hides all else but what gives light
void showAllObjects(Gui& gui);

void drawSelection(Gui& gui, const Rect& image, const Rect& area); // outlined in the picture
// In that of another viewport, which rests while the user moves what has the focus: where it shows the objects.
void drawSelectionOfOther(Gui& gui, const Rect& image, const Rect& area);
// Edits that lead all of the objects through the steps, of which none lies within another.
std::vector<scene::SceneEdit> movedAll(const scene::SceneDesc& scene, const std::vector<scene::ObjectPath>& paths,
                                       const scene::Transform& steps);
std::string ofHowMany(std::size_t count); // what follows the name of a step: " 3 objects", nothing for one

} // namespace rt::gui
