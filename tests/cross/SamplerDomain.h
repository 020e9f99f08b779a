// The directions that a case of probes/SamplerProbe.h can draw, in cells of known measure. In double precision, without
// any of the shared formulas that are to be proved.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "Common/Shared/Base/Types.h"

namespace rt::test {

// The measure is, of lights, what they contribute to the irradiance, of scattering the cosine for diffuse and the solid
// angle for others.
class SamplerDomain {
  public:
    SamplerDomain(std::uint32_t family, std::uint32_t which);

    bool isLight() const { return isLight_; }
    // The point is inside a light, which fills all directions.
    bool isInside() const { return isInside_; }

    double measure(const glm::dvec3& w) const { return hasCosine_ ? std::max(w.y, 0.0) : 1.0; }
    double whole() const;
    std::size_t cellOf(const glm::dvec3& w) const;
    std::vector<double> measures() const; // of the cells

    // Of methods that are uniform in something: the density of w, unless it is too steep there to be compared.
    bool hasKnownDensity() const;
    std::optional<double> knownDensity(const glm::dvec3& w) const;
    // Of a round light: the part of the points drawn by area that lies on the near side.
    double nearShare() const;

  private:
    bool isEllipsoid() const { return isLight_ && light_.kind == shared::kLightEllipsoid; }
    bool isHit(const glm::dvec3& w) const;
    double roundCell(int i, int k) const;
    double flatCell(int i, int k) const;
    std::vector<glm::dvec3> outline() const; // of a light that is no sphere

    const std::uint32_t family_, which_;
    const bool isLight_;
    const shared::Light light_;
    const bool isRound_; // cells are those of a cone
    const bool isTriangle_, hasCosine_;
    const glm::dvec3 corner_, u_, v_;
    bool isInside_ = false;
    glm::dmat3 toSphere_{1.0};     // of an ellipsoid or a sphere: to the space in which it is the unit sphere
    glm::dvec3 axis_, side_, top_; // of the cone
    double coneCosine_ = 0;
};

} // namespace rt::test
