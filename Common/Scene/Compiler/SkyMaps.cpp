#include "Common/Scene/Compiler/SkyMaps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <glm/mat3x3.hpp>

#include "Common/Core/Error.h"
#include "Common/Core/Parallel.h"
#include "Common/Scene/Compiler/TextureTable.h"

namespace rt::scene {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kPlaces = 4; // along each side of a texel

// Of a direction as kernels see it: u is 0.5 at +X and grows by way of +Z, v is 0 at +Y.
glm::dvec3 skyDirection(double u, double v) {
    const double around = 2 * kPi * (u - 0.5), down = kPi * v;
    return {std::cos(around) * std::sin(down), std::cos(down), std::sin(around) * std::sin(down)};
}

glm::dvec2 latLongPlace(const glm::dvec3& d) {
    return {0.5 + std::atan2(d.z, d.x) / (2 * kPi), std::acos(std::clamp(d.y, -1.0, 1.0)) / kPi};
}

// pbrt's: the upper row at +Z, from +X by way of +Y.
glm::dvec2 pbrtLatLongPlace(const glm::dvec3& d) {
    const double around = std::atan2(d.y, d.x) / (2 * kPi);
    return {around < 0 ? around + 1 : around, std::acos(std::clamp(d.z, -1.0, 1.0)) / kPi};
}

std::uint32_t cellOf(double place, std::uint32_t count) {
    return std::min(static_cast<std::uint32_t>(std::max(place, 0.0) * count), count - 1);
}

} // namespace

bool mustBeMapped(const ImageBackground& sky) {
    return sky.projection != SkyProjection::LatitudeLongitude || sky.orientation != ImageBackground().orientation;
}

// P. Clarberg's map: on each half a disk of equal areas, its rings made diamonds.
glm::dvec2 equalAreaPlace(const glm::dvec3& d) {
    const double x = std::abs(d.x), y = std::abs(d.y), radius = std::sqrt(std::max(0.0, 1 - std::abs(d.z)));
    const double turn = x == 0 && y == 0 ? 0 : std::atan2(y, x) * 2 / kPi; // of a quarter
    double v = turn * radius, u = radius - v;
    if (d.z < 0) {
        const double inner = u;
        u = 1 - v;
        v = 1 - inner;
    }
    return {0.5 * (std::copysign(u, d.x) + 1), 0.5 * (std::copysign(v, d.y) + 1)};
}

std::uint32_t appendLinearImage(std::uint32_t width, std::uint32_t height, const std::string& name,
                                CompiledScene& out) {
    const std::size_t first = out.texels.size(), size = std::size_t{3} * width * height;
    if (first + size > shared::kNone) throw InputError(name + ": all images together exceed 16 GiB");
    out.texels.resize(first + size);
    shared::Image image{};
    image.firstTexel = static_cast<std::uint32_t>(first);
    image.width = width;
    image.height = height;
    image.format = shared::kTexelLinearF32;
    out.images.push_back(image);
    return static_cast<std::uint32_t>(out.images.size() - 1);
}

void setTexel(std::uint32_t* words, const glm::dvec3& color) {
    for (int c = 0; c < 3; ++c) words[c] = shared::floatBitsToUint(static_cast<float>(color[c]));
}

std::uint32_t appendSkyMap(const ImageBackground& sky, std::uint32_t image, CompiledScene& out) {
    const shared::Image source = out.images[image];
    const auto& m = sky.orientation;
    const glm::dmat3 toImage(m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]); // columns
    const auto placeOf = sky.projection == SkyProjection::LatitudeLongitude ? latLongPlace
                         : source.width == source.height                    ? equalAreaPlace
                                                                            : pbrtLatLongPlace;
    // Whatever its shape is, with twice its texels.
    const double side = std::sqrt(double(source.width) * source.height);
    const std::uint32_t height = std::max(static_cast<std::uint32_t>(std::ceil(side)), 2u);
    const std::uint32_t index = appendLinearImage(2 * height, height, sky.file, out);
    const shared::Image made = out.images[index];
    parallelFor(0, made.height, [&](std::size_t row) {
        for (std::uint32_t column = 0; column < made.width; ++column) {
            glm::dvec3 sum(0);
            for (int place = 0; place < kPlaces * kPlaces; ++place) {
                const int across = place % kPlaces, down = place / kPlaces;
                const double u = (column + (across + 0.5) / kPlaces) / made.width;
                const double v = (static_cast<double>(row) + (down + 0.5) / kPlaces) / made.height;
                const glm::dvec2 at = placeOf(toImage * skyDirection(u, v));
                sum += texelColor(out, source, cellOf(at.x, source.width), cellOf(at.y, source.height));
            }
            setTexel(&out.texels[made.firstTexel + 3 * (row * made.width + column)],
                     sum / static_cast<double>(kPlaces * kPlaces));
        }
    });
    return index;
}

} // namespace rt::scene
