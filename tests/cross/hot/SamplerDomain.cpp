#include "tests/cross/SamplerDomain.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/matrix.hpp>

#include "tests/cross/probes/SamplerProbe.h"
#include "tests/unit/Oracles.h"

namespace rt::test {
namespace {

constexpr int kCells = 8;
const dvec3 kUp(0, 1, 0);

} // namespace

SamplerDomain::SamplerDomain(std::uint32_t family, std::uint32_t which)
    : family_(family),
      which_(which),
      isLight_(family < shared::kProbeScattering),
      light_(shared::probeCaseLight(family, which)),
      isRound_(!isLight_ || light_.kind == shared::kLightSphere || isEllipsoid()),
      isTriangle_(isLight_ && light_.kind == shared::kLightTriangle),
      hasCosine_(isLight_ || which == 0),
      corner_(light_.position),
      u_(light_.edgeU),
      v_(light_.edgeV) {
    if (!isRound_) return;
    if (isLight_) {
        const double radius = static_cast<double>(light_.radius); // of an ellipsoid that of a sphere around it
        toSphere_ = glm::inverse(isEllipsoid() ? glm::dmat3(u_, v_, dvec3(light_.normal)) : glm::dmat3(radius));
        isInside_ = glm::length(toSphere_ * corner_) < 1;
        const double sine = std::min(radius / glm::length(corner_), 1.0);
        axis_ = isInside_ ? kUp : glm::normalize(corner_);
        coneCosine_ = isInside_ ? 0 : std::sqrt((1 - sine) * (1 + sine));
    } else {
        const shared::vec4 cone = shared::probeCone(which_);
        axis_ = glm::normalize(dvec3(cone));
        coneCosine_ = static_cast<double>(cone.w);
    }
    side_ = glm::normalize(glm::cross(axis_, dvec3(0.3, 0.2, 1)));
    top_ = glm::cross(side_, axis_);
}

// Whether w meets the ellipsoid.
bool SamplerDomain::isHit(const dvec3& w) const {
    const dvec3 center = toSphere_ * corner_, v = glm::normalize(toSphere_ * w);
    const double along = glm::dot(center, v);
    return isInside_ || (along > 0 && glm::dot(center, center) - along * along < 1);
}

std::size_t SamplerDomain::cellOf(const dvec3& w) const {
    double a = 0, b = 0;
    if (isRound_) {
        a = (1 - glm::dot(w, axis_)) / (1 - coneCosine_);
        b = std::atan2(glm::dot(w, side_), glm::dot(w, top_)) / (2 * kPi) + 0.5;
    } else {
        const dvec3 n = glm::cross(u_, v_);
        const dvec3 p = w * (glm::dot(corner_, n) / glm::dot(w, n)) - corner_;
        a = glm::dot(glm::cross(p, v_), n) / glm::dot(n, n);
        b = glm::dot(glm::cross(u_, p), n) / glm::dot(n, n);
    }
    const auto cell = [](double x) { return std::clamp(static_cast<int>(x * kCells), 0, kCells - 1); };
    const int i = cell(a), k = cell(b);
    const int row = isTriangle_ && i + k >= kCells ? kCells - 1 - i : k;
    return static_cast<std::size_t>(i * kCells + row);
}

std::vector<double> SamplerDomain::measures() const {
    std::vector<double> result;
    for (int i = 0; i < kCells; ++i)
        for (int k = 0; k < kCells; ++k) result.push_back(isRound_ ? roundCell(i, k) : flatCell(i, k));
    return result;
}

double SamplerDomain::roundCell(int i, int k) const {
    constexpr int kSteps = 100;
    double sum = 0;
    for (int x = 0; x < kSteps; ++x)
        for (int y = 0; y < kSteps; ++y) {
            const double c = 1 - (1 - coneCosine_) * (i + (x + 0.5) / kSteps) / kCells;
            const double phi = 2 * kPi * ((k + (y + 0.5) / kSteps) / kCells - 0.5), s = std::sqrt(1 - c * c);
            const dvec3 w = c * axis_ + s * (std::sin(phi) * side_ + std::cos(phi) * top_);
            if (!isEllipsoid() || isHit(w)) sum += measure(w);
        }
    return sum * 2 * kPi * (1 - coneCosine_) / (kCells * kCells * kSteps * kSteps);
}

double SamplerDomain::flatCell(int i, int k) const {
    if (isTriangle_ && i + k >= kCells) return 0;
    const auto at = [&](int a, int b) { return corner_ + u_ * (double(a) / kCells) + v_ * (double(b) / kCells); };
    std::vector<dvec3> corners{at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)};
    if (isTriangle_ && i + k == kCells - 1) corners.erase(corners.begin() + 2);
    return polygonIrradiance(corners, kUp);
}

std::vector<dvec3> SamplerDomain::outline() const {
    if (isEllipsoid()) return ellipsoidOutline(corner_, glm::inverse(toSphere_));
    if (isTriangle_) return {corner_, corner_ + u_, corner_ + v_};
    return {corner_, corner_ + u_, corner_ + u_ + v_, corner_ + v_};
}

double SamplerDomain::whole() const {
    if (!isLight_) return hasCosine_ ? kPi : 2 * kPi * (1 - coneCosine_);
    if (isInside_) return kPi;
    if (light_.kind == shared::kLightSphere) return sphereIrradiance(corner_, static_cast<double>(light_.radius), kUp);
    return polygonIrradiance(outline(), kUp);
}

bool SamplerDomain::hasKnownDensity() const {
    const std::uint32_t shape = shared::probeShape(family_, which_);
    // Of a quad that the horizon cuts only a part is sampled; an ellipsoid's cone is stretched.
    const bool isCutQuad = isLight_ && light_.kind == shared::kLightQuad && which_ == 2;
    const bool isUniform =
        shape == shared::kShapeArea || (shape == shared::kShapeSolidAngle && !isEllipsoid() && !isCutQuad);
    return isLight_ && isUniform && !isInside_;
}

// Spheres and ellipsoids are uniform where they are the unit sphere; M takes densities to the world, by |M w|^3 / |det
// M|.
std::optional<double> SamplerDomain::knownDensity(const dvec3& w) const {
    const bool isByArea = shared::probeShape(family_, which_) == shared::kShapeArea;
    if (isRound_) {
        const dvec3 center = toSphere_ * corner_, v = glm::normalize(toSphere_ * w);
        const double stretch = glm::length(glm::inverse(toSphere_) * v);
        const double jacobian = stretch * stretch * stretch * std::abs(glm::determinant(toSphere_));
        const double d2 = glm::dot(center, center), along = glm::dot(center, v);
        if (!isByArea) return jacobian / (2 * kPi * (1 - std::sqrt(1 - 1 / d2)));
        const double cosine = std::sqrt(std::max(along * along - d2 + 1, 0.0)), distance = along - cosine;
        if (cosine < 0.02) return std::nullopt; // without bound
        return jacobian * distance * distance / (4 * kPi * cosine);
    }
    if (isByArea) {
        const dvec3 n(light_.normal);
        const double distance = glm::dot(corner_, n) / glm::dot(w, n), cosine = std::abs(glm::dot(w, n));
        if (cosine < 0.02) return std::nullopt;
        return distance * distance / (static_cast<double>(light_.area) * cosine);
    }
    const std::vector<dvec3> corners = outline();
    double solidAngle = triangleSolidAngle(corners[0], corners[1], corners[2]);
    if (!isTriangle_) solidAngle += triangleSolidAngle(corners[0], corners[2], corners[3]);
    return 1 / solidAngle;
}

double SamplerDomain::nearShare() const {
    return 0.5 * (1 - 1 / glm::length(toSphere_ * corner_));
}

} // namespace rt::test
