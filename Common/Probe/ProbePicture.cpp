#include "Common/Probe/ProbePicture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "Common/Shared/Base/Sampling.h"

namespace rt::probe {

using shared::vec3;

namespace {

constexpr std::size_t kDots = 512;    // at most: the density is to be seen between them
const vec3 kInk(0.85f, 0.25f, 0.05f); // of dots
const vec3 kPaper(0.02f, 0.02f, 0.03f);

void paint(image::Image& picture, std::uint32_t x, std::uint32_t y, const vec3& color) {
    float* pixel = picture.pixel(x, y);
    for (int c = 0; c < 3; ++c) pixel[c] = color[c];
}

// The direction of a point of the unit disk, whose rim is the horizon.
vec3 hemisphereDirection(const shared::Frame& frame, double x, double y) {
    const double squared = x * x + y * y; // 1 - cosine
    const double share = std::sqrt(std::max(0.0, 2 - squared));
    return shared::toWorld(
        frame, vec3(static_cast<float>(x * share), static_cast<float>(y * share), static_cast<float>(1 - squared)));
}

// The reverse; nothing below the horizon.
std::optional<glm::dvec2> hemispherePoint(const shared::Frame& frame, const vec3& direction) {
    const vec3 local = shared::toLocal(frame, direction);
    if (!(local.z > 0.0f)) return std::nullopt;
    const double share = 1 / std::sqrt(1.0 + local.z);
    return glm::dvec2(local.x * share, local.y * share);
}

std::uint32_t pixelAt(double share, std::uint32_t size) {
    return std::min(static_cast<std::uint32_t>(std::max(0.0, share) * size), size - 1);
}

} // namespace

image::Image pictureOf(const Probe& probe, const Strategy& strategy, const DirectionMap& map,
                       std::span<const std::optional<vec3>> drawn) {
    const std::uint32_t side = map.height;
    image::Image picture(3 * side, side);
    const float peak = map.density.empty() ? 0.0f : *std::max_element(map.density.begin(), map.density.end());
    const auto grey = [peak](float density) {
        return vec3(peak > 0.0f ? std::sqrt(std::min(density / peak, 1.0f)) : 0.0f);
    };
    const shared::Frame frame = shared::makeFrame(probe.vertex().shading);
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < 2 * side; ++x)
            paint(picture, x, y, grey(map.density[std::size_t{y} * 2 * side + x]));
        for (std::uint32_t x = 0; x < side; ++x) {
            const double right = 2 * (x + 0.5) / side - 1, up = 1 - 2 * (y + 0.5) / side;
            const bool isAbove = right * right + up * up < 1;
            const vec3 color = isAbove ? grey(probe.density(strategy, hemisphereDirection(frame, right, up))) : kPaper;
            paint(picture, 2 * side + x, y, color);
        }
    }
    for (const std::optional<vec3>& direction : drawn.first(std::min(drawn.size(), kDots))) {
        if (!direction) continue;
        const auto cell = static_cast<std::uint32_t>(map.cellOf(*direction));
        paint(picture, cell % (2 * side), cell / (2 * side), kInk);
        if (const auto point = hemispherePoint(frame, *direction))
            paint(picture, 2 * side + pixelAt((point->x + 1) / 2, side), pixelAt((1 - point->y) / 2, side), kInk);
    }
    return picture;
}

image::Image imageOf(const DirectionMap& map) {
    image::Image image(2 * map.height, map.height, 1);
    image.data = map.density;
    return image;
}

} // namespace rt::probe
