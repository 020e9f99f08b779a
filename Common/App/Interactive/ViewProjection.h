// Where points of a scene are seen in its picture, and back. The middle of the lens counts.
#pragma once
#include <optional>
#include <utility>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "Common/Scene/SceneDesc.h"

namespace rt::app {

class ViewProjection {
  public:
    // `aspect`: width / height of the picture.
    ViewProjection(const scene::CameraDesc& camera, double aspect);

    // In shares of the picture from its upper left corner, also beyond its edges; nothing for what is not in front.
    std::optional<glm::dvec2> place(const glm::dvec3& point) const;
    // Of the part of a line between two points that is in front.
    std::optional<std::pair<glm::dvec2, glm::dvec2>> line(glm::dvec3 a, glm::dvec3 b) const;
    // From the camera to what is seen at a place; of unit length along the view's axis.
    glm::dvec3 direction(const glm::dvec2& place) const;
    // What is seen there in the plane across the view that goes through a point.
    glm::dvec3 inPlaneOf(const glm::dvec3& point, const glm::dvec2& place) const;

    // Of the picture, as far away as a point is.
    double heightAt(const glm::dvec3& point) const { return 2 * halfHeight_ * depth(point); }

    const glm::dvec3& eye() const { return eye_; }
    const glm::dvec3& forward() const { return forward_; }
    double aspect() const { return halfWidth_ / halfHeight_; }

  private:
    double depth(const glm::dvec3& point) const;

    glm::dvec3 eye_, right_, up_, forward_;
    double halfWidth_, halfHeight_; // of the picture at the distance 1
    double nearest_;                // that is in front
};

} // namespace rt::app
