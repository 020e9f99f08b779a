// The pixel of which the panel Pixel noise tells why it is noisy, and its paths over the picture.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "Common/Gui/PointPicker.h"
#include "Common/Probe/PathsView.h"
#include "Common/Render/Settings.h"

namespace rt::gui {

// What the window keeps of it between frames.
struct NoisyPixel : PointPicker {
    probe::PathsSettings settings;
    std::optional<app::RenderSettings> rendering; // of the film, not of drafts
    std::optional<std::size_t> chosen, hovered;   // of the paths in the table
    bool drawsPaths = true;
};

// What is asked of the pixel, in the scene and by the settings of the picture. Requires both.
probe::PathsWish noiseWishAt(Gui& gui, const PickedPixel& point);

// Each frame, before anything is drawn: without its panel nothing is worked out.
void followNoisyPixel(Gui& gui);
// Whether the pointer, over `pixel` of the picture, if any, is taken by the mark.
bool holdNoisyPixel(Gui& gui, bool isInside, const std::optional<std::array<std::uint32_t, 2>>& pixel);
// Its mark in the picture and its paths: what is hidden is thin and dim, a ring is where a path first meets the scene,
// a disk the light that it found.
void drawNoisyPixel(const Gui& gui, const Rect& image, const Rect& area);

ImU32 techniqueColor(probe::Technique technique, float opacity = 1);

} // namespace rt::gui
