#include "Common/Bench/Pictures.h"

#include <algorithm>
#include <sstream>

#include "Common/Bench/Cells.h"
#include "Common/Image/Codecs.h"
#include "Common/Image/Display.h"
#include "Common/Image/Metrics.h"
#include "Common/Shared/Tonemap.h"

namespace rt::bench {
namespace {

using image::Image;

constexpr std::uint32_t kWidest = 180;  // pixels
constexpr std::size_t kMaxPictures = 8; // configurations in a grid

// Means over squares of pixels of what a screen shows.
Image shrunk(const Image& image) {
    const std::uint32_t factor = (image.width + kWidest - 1) / kWidest;
    if (factor < 2 || image.height < factor) return image;
    Image small(image.width / factor, image.height / factor, 3);
    const float weight = 1.0f / static_cast<float>(factor * factor);
    for (std::uint32_t y = 0; y < small.height * factor; ++y)
        for (std::uint32_t x = 0; x < small.width * factor; ++x)
            for (std::uint32_t c = 0; c < 3; ++c)
                small.pixel(x / factor, y / factor)[c] += weight * image.pixel(x, y)[c];
    return small;
}

Image shown(const Image& radiance) {
    return shrunk(image::toImage(image::toDisplay(radiance, 0, shared::kTonemapNone)));
}

// What tells this configuration from the others.
std::string captionOf(const Experiment& experiment, const Config& config) {
    if (config.imported) return config.engine;
    std::string text;
    for (const Axis& axis : axes())
        if (varies(experiment, axis) && axis.name != "scene") text += (text.empty() ? "" : ", ") + axis.get(config);
    return text.empty() ? config.engine : text;
}

const Snapshot* atSpp(const Measured& measured, std::uint64_t spp) {
    const std::vector<Snapshot>& all = measured.runs.front().snapshots;
    const auto found = std::find_if(all.begin(), all.end(), [&](const Snapshot& s) { return s.spp == spp; });
    return found == all.end() ? (all.empty() ? nullptr : &all.back()) : &*found;
}

std::string base64(const std::string& bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (int k = 0; k < 4; ++k) text += kDigits[word >> (18 - 6 * k) & 63];
    }
    const std::size_t padding = (3 - bytes.size() % 3) % 3;
    return text.replace(text.size() - padding, padding, padding, '=');
}

} // namespace

PictureGrid makeGrid(const Experiment& experiment, const std::vector<Measured>& measured,
                     const image::Reference& reference) {
    std::uint64_t spp = ~std::uint64_t{0};
    for (const Measured& one : measured)
        if (!one.config.imported && !one.runs.front().snapshots.empty())
            spp = std::min(spp, one.runs.front().snapshots.back().spp);
    PictureGrid grid{experiment.name, measured.front().config.scene, {}};
    grid.pictures.push_back({"reference", shown(reference.mean)});
    for (std::size_t i = 0; i < std::min(measured.size(), kMaxPictures); ++i) {
        const Snapshot* snapshot = atSpp(measured[i], spp);
        if (snapshot == nullptr) continue;
        const Config& config = measured[i].config;
        const std::string caption =
            captionOf(experiment, config) + ", " +
            (config.imported ? threeDigits(snapshot->seconds) + " s" : std::to_string(snapshot->spp) + " spp");
        grid.pictures.push_back({caption, shown(snapshot->image)});
        grid.pictures.push_back({"its error", shrunk(image::heatMap(snapshot->image, reference.mean))});
    }
    return grid;
}

std::string dataUri(const Image& display) {
    std::ostringstream png;
    image::encodePng(display, png);
    return "data:image/png;base64," + base64(png.str());
}

} // namespace rt::bench
