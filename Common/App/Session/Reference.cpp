#include "Common/App/Session/Reference.h"

#include <algorithm>
#include <cmath>

#include "Common/App/Session/Outputs.h"
#include "Common/Core/Error.h"
#include "Common/Image/ImageIo.h"

namespace rt::app {

image::Image readReference(const std::string& file, std::uint32_t wantedWidth, std::uint32_t wantedHeight) {
    if (!isLinearFormat(file)) throw InputError(file + ": a reference must be linear: .exr, .hdr or .pfm");
    image::Image reference = image::readImage(file);
    const auto size = [](std::uint32_t width, std::uint32_t height, std::uint32_t channels) {
        return std::to_string(width) + "x" + std::to_string(height) + " pixels of " + std::to_string(channels) +
               " channels";
    };
    if (reference.width != wantedWidth || reference.height != wantedHeight || reference.channels != 3)
        throw InputError(file + ": has " + size(reference.width, reference.height, reference.channels) +
                         ", but the render " + size(wantedWidth, wantedHeight, 3));
    if (!std::all_of(reference.data.begin(), reference.data.end(), [](float value) { return std::isfinite(value); }))
        throw InputError(file + ": has values that are not finite");
    return reference;
}

} // namespace rt::app
