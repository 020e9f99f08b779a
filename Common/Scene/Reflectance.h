#pragma once

namespace rt::scene {

// Of a dielectric in air, at normal incidence.
inline double reflectanceOfIor(double ior) {
    const double amplitude = (ior - 1) / (ior + 1);
    return amplitude * amplitude;
}

} // namespace rt::scene
