// What the inspector says of a pixel.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "Common/App/Interactive/InteractiveState.h"

namespace rt::gui {

// A row of the inspector: of the picture, and where one is pinned of that and their difference.
struct InspectedRow {
    std::string name, picture, held, difference;
};

// Rows with no columns but name and picture, for narrow windows: what stood side by side stands below each other.
std::vector<InspectedRow> stacked(const std::vector<InspectedRow>& rows);

// What the view shows there, where it is not the radiance, stands before that. `held`: what is shown of the pinned
// picture; null: there is none. Nothing where the pixel is outside of the picture.
std::vector<InspectedRow> inspectPixel(const app::Picture& picture, const image::Image* held,
                                       const std::array<std::uint32_t, 2>& pixel);

} // namespace rt::gui
