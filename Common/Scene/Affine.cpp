#include "Common/Scene/Affine.h"

namespace rt::scene {

namespace {

// Multiples of 90 degrees give exact zeros and ones, so that turned boxes stay aligned with the axes.
void sineAndCosine(double degrees, double& sine, double& cosine) {
    const double turns = degrees / 90;
    if (turns == std::floor(turns)) {
        const int quarter = static_cast<int>(std::fmod(turns, 4.0) + 4) % 4;
        sine = quarter == 1 ? 1 : quarter == 3 ? -1 : 0;
        cosine = quarter == 0 ? 1 : quarter == 2 ? -1 : 0;
        return;
    }
    const double radians = degrees * (3.14159265358979323846 / 180);
    sine = std::sin(radians);
    cosine = std::cos(radians);
}

// Rodrigues' formula.
Affine toAffine(const Rotate& step) {
    const double length = glm::length(step.axis);
    if (!(length > 0)) return {};
    const glm::dvec3 a = step.axis / length;
    double s = 0, c = 1;
    sineAndCosine(step.degrees, s, c);
    const glm::dmat3 skew(0, a.z, -a.y, -a.z, 0, a.x, a.y, -a.x, 0);
    return {glm::dmat3(c) + s * skew + (1 - c) * glm::outerProduct(a, a), glm::dvec3(0)};
}

Affine toAffine(const Translate& step) {
    return translation(step.offset);
}

Affine toAffine(const Scale& step) {
    return scaling(step.factors);
}

Affine toAffine(const Matrix& step) {
    const auto& m = step.rows;
    return {glm::dmat3(m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]), {m[3], m[7], m[11]}};
}

} // namespace

Affine toAffine(const Transform& transform) {
    Affine all;
    for (const auto& step : transform) all = std::visit([](const auto& s) { return toAffine(s); }, step) * all;
    return all;
}

std::optional<Affine> inverse(const Affine& map) {
    const double determinant = glm::determinant(map.linear);
    if (!(std::abs(determinant) > 0) || !std::isfinite(determinant)) return std::nullopt;
    const glm::dmat3 linear = glm::inverse(map.linear);
    const glm::dvec3 offset = -(linear * map.offset);
    if (!std::isfinite(glm::dot(linear[0] + linear[1] + linear[2], offset))) return std::nullopt;
    return Affine{linear, offset};
}

glm::dmat3 frameAround(const glm::dvec3& n) {
    const double s = std::signbit(n.z) ? -1 : 1;
    const double a = -1 / (s + n.z), b = n.x * n.y * a;
    return {glm::dvec3(1 + s * n.x * n.x * a, s * b, -s * n.x), glm::dvec3(b, s + n.y * n.y * a, -n.y), n};
}

// Hestenes' one-sided variant of Jacobi's method: turns two columns at a time in their plane.
glm::dmat3 orthogonalColumns(const glm::dmat3& a) {
    constexpr int kSweeps = 30; // it takes about five
    constexpr int kPairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    glm::dmat3 result = a;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (const auto& [p, q] : kPairs) {
            const glm::dvec3 x = result[p], y = result[q];
            const double xx = glm::dot(x, x), yy = glm::dot(y, y), xy = glm::dot(x, y);
            if (std::abs(xy) <= 1e-15 * std::sqrt(xx * yy)) continue;
            const double zeta = (yy - xx) / (2 * xy);
            const double t = std::copysign(1.0, zeta) / (std::abs(zeta) + std::sqrt(1 + zeta * zeta));
            const double c = 1 / std::sqrt(1 + t * t);
            result[p] = c * (x - t * y);
            result[q] = c * (y + t * x);
        }
    }
    return result;
}

std::optional<double> uniformScale(const Affine& map) {
    const glm::dmat3 square = glm::transpose(map.linear) * map.linear;
    const double s2 = (square[0][0] + square[1][1] + square[2][2]) / 3;
    if (!(s2 > 0) || !std::isfinite(s2)) return std::nullopt;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (std::abs(square[i][j] - (i == j ? s2 : 0.0)) > 2e-6 * s2) return std::nullopt;
    return std::sqrt(s2);
}

} // namespace rt::scene
