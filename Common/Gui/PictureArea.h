// The part of the window that shows the picture: where the picture lies in it, and what the mouse does there.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "Common/Gui/FilmPass.h"
#include "Common/Gui/Gui.h"
#include "Common/Gui/Layout.h"

namespace rt::gui {

class PictureArea {
  public:
    explicit PictureArea(Gui& gui) : gui_(gui) {}

    // In the window's units; a picture that fits lies in `inner`.
    void place(const Rect& area, const Rect& inner) {
        area_ = area;
        inner_ = inner;
    }
    Rect imageRect() const; // the whole picture's
    // Looks, orbits, pans, zooms, picks and inspects; within a frame of ImGui, after the panels.
    void handlePointer();
    PresentConstants constants() const;
    // Pixels of a row of the preview that suit the window: one for each that it shows; 0: the picture's own.
    std::uint32_t previewWidth() const;

  private:
    using Pixel = std::array<std::uint32_t, 2>;

    bool showsPixels() const;
    void drawGrid() const;
    bool isSplit() const;
    void compare(PresentConstants& constants) const;
    float fitScale() const;
    float filmPixels() const;
    float scale() const { return gui_.view.zoom > 0 ? gui_.view.zoom * filmPixels() : fitScale(); } // of the picture's
    std::optional<Pixel> pixelUnderPointer() const;
    void mark(const Pixel& pixel) const;
    void inspect(const std::optional<Pixel>& pixel);
    void drag();
    void handleTool(const std::optional<Pixel>& pixel);
    void takeMaterial();
    void select(bool inside, const std::optional<Pixel>& pixel);
    void turnWheel();

    std::string materialAt(const Pixel& pixel, const image::Image& picture);

    // What the last pixel asked for was of, and the material it shows.
    struct Seen {
        std::uint64_t sceneLoads = 0;
        scene::CameraDesc camera;
        std::array<std::uint32_t, 4> place{}; // pixel and size
        bool operator==(const Seen&) const = default;
    };

    Gui& gui_;
    Rect area_, inner_;
    Seen seen_;
    std::string seenMaterial_;
    bool isClick_ = false;  // a press in the picture that has not become a drag
    bool isAdding_ = false; // the latest press selects what is there besides
    bool dragging_ = false; // a drag that began in the picture goes on outside of it
};

} // namespace rt::gui
