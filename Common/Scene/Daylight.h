// The daylight of a clear sky: the sky of Preetham, Shirley and Smits, and the sun through the same air. Both are
// absolute, in photometric units, so that one fits the other: an illuminance of 100 000 lx is an irradiance of pi here,
// under which a white surface has radiance 1.
#pragma once
#include <glm/vec3.hpp>

#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

inline constexpr double kSunRadius = 4.652e-3; // as an angle: 6.957e8 m at 1.4956e11 m

glm::dvec3 sunDirection(const SunSkyBackground& sky); // towards it

class Daylight {
  public:
    explicit Daylight(const SunSkyBackground& sky); // of which its factor does not count

    // Radiance of the sky above the horizon in a direction, by its cosine to the zenith, above 0, and the angle between
    // it and the sun. What the sun itself adds is not in it.
    glm::dvec3 sky(double cosine, double angle) const;
    // Irradiance by the sun of a surface across its direction.
    const glm::dvec3& sun() const { return sun_; }

  private:
    // Coefficients of the Perez formula, and what it is multiplied by, for Y in kcd/m2 and for x and y.
    struct Perez {
        double a, b, c, d, e, scale;
        double at(double cosine, double angle) const;
    };
    Perez luminance_, x_, y_;
    glm::dvec3 sun_;
};

} // namespace rt::scene
