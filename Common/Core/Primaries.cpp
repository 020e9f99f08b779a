#include "Common/Core/Primaries.h"

#include <cmath>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

namespace rt {

namespace {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;

constexpr double kRounding = 5e-4; // of chromaticities in files

bool isFinite(const dmat3& m) {
    bool all = true;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) all = all && std::isfinite(m[column][row]);
    return all;
}

// From one white to another, of XYZ: the cone responses of Bradford, each scaled on its own.
dmat3 adaptation(const dvec3& from, const dvec3& to) {
    const dmat3 cones(0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367, 1.0296); // columns
    const dvec3 ratio = (cones * to) / (cones * from);
    return glm::inverse(cones) * dmat3(ratio.x, 0, 0, 0, ratio.y, 0, 0, 0, ratio.z) * cones;
}

// A Gaussian that is wider on one side.
double lobe(double nm, double middle, double below, double above) {
    const double t = (nm - middle) / (nm < middle ? below : above);
    return std::exp(-0.5 * t * t);
}

} // namespace

bool areSame(const Primaries& a, const Primaries& b) {
    const auto isNear = [](const dvec2& p, const dvec2& q) {
        return std::abs(p.x - q.x) <= kRounding && std::abs(p.y - q.y) <= kRounding;
    };
    return isNear(a.red, b.red) && isNear(a.green, b.green) && isNear(a.blue, b.blue) && isNear(a.white, b.white);
}

dvec3 xyzOf(const dvec2& xy) {
    return dvec3(xy.x / xy.y, 1, (1 - xy.x - xy.y) / xy.y);
}

std::optional<dmat3> toXyz(const Primaries& p) {
    // Primaries by X + Y + Z = 1, as one of them, of blue light, may have no luminance.
    const auto column = [](const dvec2& xy) { return dvec3(xy.x, xy.y, 1 - xy.x - xy.y); };
    const dmat3 columns(column(p.red), column(p.green), column(p.blue));
    if (!(std::abs(glm::determinant(columns)) > 1e-6) || !(std::abs(p.white.y) > 1e-6)) return std::nullopt;
    const dvec3 amounts = glm::inverse(columns) * xyzOf(p.white);
    const dmat3 matrix(columns[0] * amounts.x, columns[1] * amounts.y, columns[2] * amounts.z);
    return isFinite(matrix) ? std::optional(matrix) : std::nullopt;
}

dmat3 xyzToRec709() {
    return glm::inverse(*toXyz(kRec709));
}

dvec3 colorMatching(double nm) {
    return {
        1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) - 0.065 * lobe(nm, 501.1, 20.4, 26.2),
        0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
        1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

std::optional<dmat3> toRec709(const Primaries& primaries, White white) {
    const std::optional<dmat3> xyz = toXyz(primaries);
    if (!xyz || white == White::Kept) return xyz ? std::optional(xyzToRec709() * *xyz) : std::nullopt;
    const dmat3 matrix = xyzToRec709() * adaptation(xyzOf(primaries.white), xyzOf(kRec709.white)) * *xyz;
    return isFinite(matrix) ? std::optional(matrix) : std::nullopt;
}

} // namespace rt
