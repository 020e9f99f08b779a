#include "Common/Image/Display.h"

#include "Common/Shared/Tonemap.h"

namespace rt::image {

Image toDisplay(const Image& radiance, float exposure, std::uint32_t curve) {
    Image display(radiance.width, radiance.height, 3);
    for (std::size_t i = 0; i < display.data.size(); i += 3) {
        const float* from = &radiance.data[i / 3 * radiance.channels];
        const std::size_t green = radiance.channels == 3 ? 1 : 0;
        const shared::vec3 shown = shared::tonemap({from[0], from[green], from[2 * green]}, exposure, curve);
        for (int c = 0; c < 3; ++c) display.data[i + static_cast<std::size_t>(c)] = shown[c];
    }
    return display;
}

} // namespace rt::image
