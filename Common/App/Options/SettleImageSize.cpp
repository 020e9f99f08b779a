// Of width, height and aspect two give the third.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "Common/App/Options/Options.h"
#include "Common/Core/Error.h"
#include "Common/Image/Film.h"

namespace rt::app {

namespace {

constexpr std::uint32_t kDefaultWidth = 600;

std::uint32_t rounded(double pixels, const std::string& what) {
    if (!(pixels < image::kMaxImageSide + 0.5))
        throw UsageError(what + ": makes an image larger than 16384 pixels a side");
    return std::max(1u, static_cast<std::uint32_t>(std::lround(pixels)));
}

} // namespace

void settleImageSize(Options& options, const std::string& scene, double sceneAspect) {
    const auto& [width, height, aspect] = options.size;
    const double ratio = aspect.value_or(sceneAspect);
    std::uint32_t& w = options.settings.width;
    std::uint32_t& h = options.settings.height;
    if (width && height) {
        w = *width;
        h = *height;
        if (aspect && rounded(w / ratio, "--aspect") != h && rounded(h * ratio, "--aspect") != w)
            throw UsageError("--aspect: contradicts --width " + std::to_string(w) + " --height " + std::to_string(h));
    } else if (height) {
        h = *height;
        w = rounded(h * ratio, "--height " + std::to_string(h));
    } else {
        if (!width && !aspect && kDefaultWidth / sceneAspect >= image::kMaxImageSide + 0.5)
            throw InputError(scene + ": an aspect of " + std::to_string(sceneAspect) +
                             " makes an image larger than 16384 pixels a side");
        w = width.value_or(kDefaultWidth);
        h = rounded(w / ratio, "--width " + std::to_string(w));
    }
}

} // namespace rt::app
