#include "Common/Scene/Compiler/SunSkyMap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <glm/common.hpp>
#include <glm/trigonometric.hpp>

#include "Common/Core/Parallel.h"
#include "Common/Scene/Compiler/SkyMaps.h"
#include "Common/Scene/Daylight.h"

namespace rt::scene {

namespace {

// The sun is three texels wide.
constexpr std::uint32_t kSkyRows = 1024, kSkyColumns = 2 * kSkyRows, kSkyMiddle = kSkyColumns / 2;
constexpr std::uint32_t kHorizonRow = kSkyRows / 2;
constexpr int kPlacesInTexel = 16; // along each side, where it is asked whether the sun is there

double rowCosine(double row) { // to the zenith
    return std::cos(std::numbers::pi * row / kSkyRows);
}

// Of a texel; times the cosine to the zenith.
double texelAngle(std::uint32_t row) {
    return 2 * std::numbers::pi / kSkyColumns * (rowCosine(row) - rowCosine(row + 1));
}
double projectedTexelAngle(std::uint32_t row) {
    const double upper = rowCosine(row), lower = rowCosine(row + 1);
    return std::numbers::pi / kSkyColumns * (upper - lower) * (upper + lower);
}

class SunSkyMap {
  public:
    SunSkyMap(const SunSkyBackground& sky, std::uint32_t* words)
        : daylight_(sky), sunHeight_(glm::radians(sky.sunElevation)), ground_(sky.ground), words_(words) {}

    void make() {
        std::vector<glm::dvec3> irradiances(kHorizonRow);
        parallelFor(0, kHorizonRow,
                    [&](std::size_t row) { irradiances[row] = makeRow(static_cast<std::uint32_t>(row)); });
        glm::dvec3 irradiance = addSun();
        for (const glm::dvec3& ofRow : irradiances) irradiance += ofRow;
        const glm::dvec3 below = ground_ * irradiance / std::numbers::pi;
        for (std::uint32_t row = kHorizonRow; row < kSkyRows; ++row)
            for (std::uint32_t column = 0; column < kSkyColumns; ++column) set(row, column, below);
    }

  private:
    // Of the angle between the sun and a place in the image.
    double cosineToSun(double row, double column) const {
        const double down = std::numbers::pi * row / kSkyRows;
        const double around = 2 * std::numbers::pi * (column - kSkyMiddle) / kSkyColumns;
        return std::sin(sunHeight_) * std::cos(down) + std::cos(sunHeight_) * std::sin(down) * std::cos(around);
    }

    // The right half, and the left one, which mirrors it. Gives its irradiance of the ground.
    glm::dvec3 makeRow(std::uint32_t row) {
        glm::dvec3 sum(0);
        const double cosine = rowCosine(row + 0.5);
        for (std::uint32_t i = 0; i < kSkyMiddle; ++i) {
            const double toSun = std::clamp(cosineToSun(row + 0.5, kSkyMiddle + i + 0.5), -1.0, 1.0);
            const glm::dvec3 radiance = daylight_.sky(cosine, std::acos(toSun));
            set(row, kSkyMiddle + i, radiance);
            set(row, kSkyMiddle - 1 - i, radiance);
            sum += 2.0 * radiance;
        }
        return projectedTexelAngle(row) * sum;
    }

    // The share of a texel that the sun covers.
    double sunShare(std::uint32_t row, std::uint32_t column) const {
        const double edge = std::cos(kSunRadius);
        int covered = 0;
        for (int i = 0; i < kPlacesInTexel; ++i)
            for (int j = 0; j < kPlacesInTexel; ++j)
                covered +=
                    cosineToSun(row + (i + 0.5) / kPlacesInTexel, column + (j + 0.5) / kPlacesInTexel) >= edge ? 1 : 0;
        return covered / double(kPlacesInTexel * kPlacesInTexel);
    }

    struct SunTexel {
        std::uint32_t row, column; // of the right half
        double share;
    };
    // In each row they begin in the middle.
    std::vector<SunTexel> sunTexels() const {
        const double middle = (0.5 - sunHeight_ / std::numbers::pi) * kSkyRows;
        const double reach = kSunRadius / std::numbers::pi * kSkyRows + 1;
        const auto first = static_cast<std::uint32_t>(std::max(0.0, middle - reach));
        std::vector<SunTexel> texels;
        for (std::uint32_t row = first; row < middle + reach; ++row)
            for (std::uint32_t column = kSkyMiddle; column < kSkyColumns; ++column) {
                const double share = sunShare(row, column);
                if (share == 0) break;
                texels.push_back({row, column, share});
            }
        return texels;
    }

    // What is above the horizon. Gives its irradiance of the ground.
    glm::dvec3 addSun() {
        const std::vector<SunTexel> texels = sunTexels();
        double covered = 0;
        for (const SunTexel& texel : texels) covered += 2 * texel.share * texelAngle(texel.row);
        glm::dvec3 sum(0);
        for (const SunTexel& texel : texels) {
            if (texel.row >= kHorizonRow) continue;
            const glm::dvec3 radiance = texel.share / covered * daylight_.sun();
            add(texel.row, texel.column, radiance);
            add(texel.row, 2 * kSkyMiddle - 1 - texel.column, radiance);
            sum += 2 * projectedTexelAngle(texel.row) * radiance;
        }
        return sum;
    }

    std::uint32_t* texel(std::uint32_t row, std::uint32_t column) {
        return words_ + 3 * (std::size_t{row} * kSkyColumns + column);
    }
    void set(std::uint32_t row, std::uint32_t column, const glm::dvec3& color) { setTexel(texel(row, column), color); }
    void add(std::uint32_t row, std::uint32_t column, const glm::dvec3& color) {
        const std::uint32_t* const words = texel(row, column);
        glm::dvec3 sum = color;
        for (int c = 0; c < 3; ++c) sum[c] += shared::uintBitsToFloat(words[c]);
        set(row, column, sum);
    }

    const Daylight daylight_;
    const double sunHeight_; // above the horizon, in radians
    const glm::dvec3 ground_;
    std::uint32_t* const words_; // of the image
};

} // namespace

std::uint32_t appendSunSkyMap(const SunSkyBackground& sky, CompiledScene& out) {
    const std::uint32_t index = appendLinearImage(kSkyColumns, kSkyRows, out.id, out);
    SunSkyMap(sky, &out.texels[out.images[index].firstTexel]).make();
    return index;
}

} // namespace rt::scene
