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

    void place(const Rect& area) { area_ = area; } // in the window's units
    const Rect& rect() const { return area_; }
    // Looks, orbits, pans, zooms, picks and inspects; within a frame of ImGui, after the panels.
    void handlePointer();
    PresentConstants constants() const;

  private:
    using Pixel = std::array<std::uint32_t, 2>;

    float fitScale() const;
    float scale() const { return gui_.view.zoom > 0 ? gui_.view.zoom : fitScale(); }
    std::optional<Pixel> pixelUnderPointer() const;
    void inspect(const std::optional<Pixel>& pixel);
    void drag();
    void turnWheel();

    std::string materialAt(const Pixel& pixel, const image::Image& picture);

    // What the last pixel asked for was of, and the material it shows.
    struct Seen {
        std::uint64_t sceneSerial = 0;
        scene::CameraDesc camera;
        std::array<std::uint32_t, 4> place{}; // pixel and size
        bool operator==(const Seen&) const = default;
    };

    Gui& gui_;
    Rect area_;
    Seen seen_;
    std::string seenMaterial_;
    bool dragging_ = false; // a drag that began in the picture goes on outside of it
};

} // namespace rt::gui
