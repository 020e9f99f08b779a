// The point of the picture at which the panel Sampler shows what is sampled.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "Common/Gui/PointPicker.h"
#include "Common/Probe/ProbeView.h"

namespace rt::gui {

// What the panel shows its samples on.
enum class SampleSpace { Sphere, Hemisphere, UnitSquare };

// What the window keeps of it between frames.
struct SamplerView : PointPicker {
    probe::ProbeSettings settings;
    SampleSpace space = SampleSpace::Sphere;
    bool showsSamples = true;
    float scale = 1;                 // of the map's brightness
    std::uint64_t paintedSerial = 0; // of the answer that the map's image is of
    float paintedScale = 0;
};

// What is asked of the point, in the scene and by the settings of the picture. Requires both.
probe::ProbeWish wishAt(const Gui& gui, const PickedPixel& point);

// Each frame, before anything is drawn: without its panel nothing is worked out.
void followSampler(Gui& gui);
// Whether the pointer, over `pixel` of the picture, if any, is taken by the point.
bool holdSampledPoint(Gui& gui, bool isInside, const std::optional<std::array<std::uint32_t, 2>>& pixel);
void drawSampledPoint(const Gui& gui, const Rect& image, const Rect& area); // its mark in the picture

} // namespace rt::gui
