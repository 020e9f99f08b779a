#pragma once
#include <string>

#include <glm/vec3.hpp>

namespace rt::scene {

struct CameraDesc {
    glm::dvec3 lookFrom{0, 0, 0};
    glm::dvec3 lookAt{0, 0, -1};
    glm::dvec3 up{0, 1, 0};
    double verticalFov = 90;  // degrees, (0, 180)
    double defocusAngle = 0;  // degrees, full apex angle of the cone of the lens; 0: pinhole
    double focusDistance = 10; // world units, > 0
    bool operator==(const CameraDesc&) const = default;
};

// What a scene suggests; flags override it.
struct RenderDefaults {
    double aspect = 1.0; // width / height
    bool operator==(const RenderDefaults&) const = default;
};

}  // namespace rt::scene
