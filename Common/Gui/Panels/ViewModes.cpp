#include "Common/Gui/Panels/ViewModes.h"

#include <algorithm>
#include <iterator>

namespace rt::gui {
namespace {

using app::ViewMode;

constexpr const char* kNoHalves = "this film has no two halves of its samples: turn the denoiser on (N)";
constexpr const char* kNotDenoised = "it needs the denoiser (N)";

constexpr ViewModeRow kModes[] = {
    {"Picture", ViewMode::Picture, "Radiance, with exposure and tone mapping", ""},
    {"Albedo", ViewMode::Albedo, "Colour of the first surface", ""},
    {"Normal", ViewMode::Normal, "Direction of the first surface, as red, green, blue", ""},
    {"Depth", ViewMode::Depth, "Distance to the first surface; near is bright", ""},
    {"Noise", ViewMode::Noise, "Standard error of each pixel relative to its value, after 16 samples", ""},
    {"Error", ViewMode::Error, "Difference from the reference relative to it",
     "it needs a reference: see Comparison (F3)"},
    {"Heat map", ViewMode::Heat, "What each pixel costs, in rays or time, on a logarithmic scale (H)",
     "this engine does not know what a pixel costs"},
    {"Half A", ViewMode::HalfA,
     "The picture of one half of the samples, denoised if that is on. Pin it (B) and look at the other half: where "
     "both "
     "differ the picture is not certain",
     kNoHalves, true},
    {"Half B", ViewMode::HalfB, "The picture of the other half of the samples", kNoHalves, true},
    {"Denoised error", ViewMode::DenoisedError, "Estimated error of each denoised pixel relative to its value",
     kNotDenoised, true},
    {"Kept bandwidth", ViewMode::Bandwidth,
     "Which filter each denoised pixel keeps: 0 of small patches, 1 narrow, 2 wide, 3 none", kNotDenoised, true},
};

} // namespace

std::span<const ViewModeRow> viewModes() {
    return kModes;
}

const ViewModeRow& rowOf(ViewMode mode) {
    return *std::find_if(std::begin(kModes), std::end(kModes),
                         [mode](const ViewModeRow& row) { return row.mode == mode; });
}

bool isAvailable(const Gui& gui, ViewMode mode) {
    if (gui.state.picture.isPreview) return mode == ViewMode::Picture;
    if (mode == ViewMode::Error) return gui.state.referenceFits;
    if (gui.state.picture.isOfRace) return mode == ViewMode::Picture;
    if (mode == ViewMode::Heat) return gui.state.canShowCost;
    const bool hasHalves = gui.state.settings.replicates % 2 == 0;
    if (mode == ViewMode::HalfA || mode == ViewMode::HalfB) return hasHalves;
    if (app::showsDenoiser(mode)) return hasHalves && gui.settings.denoise;
    return true;
}

} // namespace rt::gui
