// Materials for objects by way of the window: of the library, of files, and of what is seen in the picture.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Interactive/MaterialPresets.h"
#include "Common/Gui/SceneEditing.h"

namespace rt::gui {

struct Gui;

// What the window keeps of it between frames.
struct MaterialTools {
    // A place in the picture that somebody waits to hear of: the object that is seen there, and its material's name.
    using Take = std::function<void(Gui&, const scene::ObjectPath&, const std::string&)>;
    struct Question {
        std::optional<SceneEditing::Click> place; // none: of nothing that is seen
        Take take;
        std::function<void(Gui&)> takeSky; // where no object is seen; none: that is told
    };
    std::optional<std::vector<app::MaterialPreset>> presets; // of the library, once it has been seen
    std::string search;
    bool isPicking = false;             // the next click in the picture says whose material the selection gets
    std::optional<std::size_t> dragged; // of the presets, by the mouse
    std::string droppedFile; // a MaterialX document or an image, until it is known what is under the pointer; none
    std::vector<std::string> notices; // of the last such document that was opened or saved
    std::optional<Question> question; // until the picture's scene and the description name the same objects
};

// Each frame, after followEditing().
void followMaterials(Gui& gui);
const std::vector<app::MaterialPreset>& materialPresets(Gui& gui); // read when they are asked for first

// A material of another scene for objects of this one, in one step; says what has become of it.
void giveMaterial(Gui& gui, const std::vector<scene::ObjectPath>& objects, const scene::SceneDesc& source,
                  const std::string& material);

// Asks what is seen at a pixel of the picture; the answer comes when it and the description name the same objects.
void askPicture(Gui& gui, const std::array<std::uint32_t, 2>& pixel, MaterialTools::Take take,
                std::function<void(Gui&)> takeSky = {});
// The name in the description of the material that an object shows; empty: it is of a file of the object's own.
std::string materialSeen(const scene::SceneDesc& scene, const scene::ObjectPath& path, const std::string& shown);

// The material that is dragged, or the file that was dropped, was let go: at a pixel of the picture, or elsewhere.
void dropMaterial(Gui& gui, const std::optional<std::array<std::uint32_t, 2>>& pixel);
// The pipette: the next click in the picture, or Escape, ends it.
void beginPipette(Gui& gui);
void pickMaterial(Gui& gui, const std::array<std::uint32_t, 2>& pixel);

// MaterialX documents: all materials of one become those of the scene, the first is for what is selected; and one gets
// that of what is selected.
bool isMaterialFile(const std::string& file); // by its name
void openMaterials(Gui& gui, const std::string& file);
void saveMaterial(Gui& gui, const std::string& file);
std::string selectedMaterial(const Gui& gui); // its name; empty: none is selected

} // namespace rt::gui
