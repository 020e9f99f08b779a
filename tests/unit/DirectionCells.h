// Cells of equal solid angle around +z, for chi-square tests of sampled directions.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "Common/Shared/Base/Types.h"
#include "tests/unit/Oracles.h"

namespace rt::test {

constexpr int kRows = 16, kColumns = 16;

inline dvec3 onSphere(double u, double v) {
    const double z = 2 * u - 1, r = std::sqrt((1 - z) * (1 + z)), phi = 2 * kPi * v;
    return {r * std::cos(phi), r * std::sin(phi), z};
}

inline std::size_t cellOf(const shared::vec3& w) {
    const double u = 0.5 * (double(w.z) + 1);
    const double v = std::atan2(double(w.y), double(w.x)) / (2 * kPi);
    const int row = std::clamp(int(u * kRows), 0, kRows - 1);
    const int column = std::clamp(int((v < 0 ? v + 1 : v) * kColumns), 0, kColumns - 1);
    return static_cast<std::size_t>(row * kColumns + column);
}

// Over a square of side `side`, which is divided where the density varies: metal's is infinite at the rim of its lobe.
template <typename Density>
double integrate(const Density& density, double u, double v, double side, int depth = 0) {
    constexpr int kMin = 3, kMax = 9;
    const double half = 0.5 * side;
    double sum = 0, low = 1e30, high = 0;
    for (const double du : {0.0, half})
        for (const double dv : {0.0, half}) {
            const double value = density(u + du + 0.5 * half, v + dv + 0.5 * half);
            sum += value;
            low = std::min(low, value);
            high = std::max(high, value);
        }
    if (depth >= kMin && (depth == kMax || high <= 1.2 * low)) return 0.25 * sum * side * side;
    sum = 0;
    for (const double du : {0.0, half})
        for (const double dv : {0.0, half}) sum += integrate(density, u + du, v + dv, half, depth + 1);
    return sum;
}

// The integral over each cell of a density per steradian, density(u, v) in the direction onSphere(u, v).
template <typename Density>
std::vector<double> cellMasses(const Density& density) {
    std::vector<double> masses;
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column)
            masses.push_back(4 * kPi * integrate(density, double(row) / kRows, double(column) / kColumns, 1.0 / kRows));
    return masses;
}

} // namespace rt::test
