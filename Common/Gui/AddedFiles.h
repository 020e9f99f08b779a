// Files that become a part of the scene that is edited: models, and images as its sky or as textures.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "Common/App/Interactive/ModelReading.h"

namespace rt::gui {

struct Gui;

// A parameter of a material that an image can be for.
struct TextureSlot {
    std::string material;
    bool isColor = true; // else the image holds numbers
    std::function<void(scene::MaterialDesc&, const std::string& texture)> set;
    bool needsTangents = false; // the numbers are directions in the frame of the surface
};

// What the window keeps of it between frames.
struct AddedFiles {
    std::string wantedModel; // a file, until the description of the scene is there; none
    app::ModelReading model;
    std::uint64_t sceneReads = 0;                                 // of the scene that it is for
    std::function<void(Gui&, const std::string& file)> takeImage; // the image that the browser is asked for
    // Files that were let go above what may take them in this frame; none.
    std::string droppedImage, droppedScene;
};

void addModel(Gui& gui, const std::string& file); // where the camera looks, or where the file has it
void followAddedFiles(Gui& gui);                  // each frame, after followEditing()
void drawModelReading(Gui& gui);                  // what is being read, and a way to stop it

// What images of textures and skies can be.
inline constexpr const char* kImageKinds[] = {".png", ".jpg", ".jpeg", ".exr",  ".hdr", ".pfm",
                                              ".bmp", ".tga", ".tif",  ".tiff", ".webp"};
bool isImageFile(const std::string& file); // by its name
// Asks for an image, and takes it when it is chosen.
void askImage(Gui& gui, std::function<void(Gui&, const std::string& file)> take);
void setSkyImage(Gui& gui, const std::string& file);
void setTexture(Gui& gui, const TextureSlot& slot, const std::string& file);
// The image that was dropped is for what is seen there: the colour of an object's material, else the sky.
void dropImage(Gui& gui, const std::string& file, const std::array<std::uint32_t, 2>& pixel);
void beginDrop(Gui& gui, const std::string& file); // before the frame: what the panels may take
// Whether a file was dropped above the item that was drawn last, which then is to take it; or above the window.
std::optional<std::string> takeDroppedImage(Gui& gui);
std::optional<std::string> takeDroppedModel(Gui& gui);
// Each frame, after the panels: what none of them has taken. A scene is opened.
void endDrops(Gui& gui);

} // namespace rt::gui
