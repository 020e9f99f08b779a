// Where a camera's image shows what, in double precision.
#pragma once
#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "Common/Shared/Base/Types.h"

namespace rt::scene {

// Of a camera for an image of this size. Places are in pixels from the image's upper left corner, x to the right and y
// down; lengths are the world's unless they are said to be pixels.
class ImagePlane {
  public:
    ImagePlane(const shared::Camera& camera, std::uint32_t width, std::uint32_t height)
        : eye_(camera.origin),
          fromView_(camera.across, camera.down, camera.corner),
          toView_(glm::inverse(fromView_)),
          size_(width, height),
          width_(width) {
        const double focus = 1.0 / glm::length(glm::dvec3(toView_[0].z, toView_[1].z, toView_[2].z));
        pixelsPerLength_ = focus * size_.x / glm::length(fromView_[0]);
    }

    const glm::dvec3& eye() const { return eye_; } // the middle of the lens
    const glm::dvec2& size() const { return size_; }
    // The number of the pixel in this column and row, row by row.
    std::uint64_t pixelAt(double column, double row) const {
        return static_cast<std::uint64_t>(row) * width_ + static_cast<std::uint64_t>(column);
    }

    // A vector in the camera's own terms: across and down the image, each times the depth and in units of the image's
    // side, and the depth in units of the distance of the plane of focus.
    glm::dvec3 toView(const glm::dvec3& vector) const { return toView_ * vector; }
    // Where a vector from the eye points to, given toView() of it, with z > 0.
    glm::dvec2 placeOf(const glm::dvec3& view) const { return glm::dvec2(view) / view.z * size_; }
    // From the eye through a place, of no particular length.
    glm::dvec3 directionTo(const glm::dvec2& place) const { return fromView_ * glm::dvec3(place / size_, 1.0); }
    // That a length across the view takes, in the middle of the image and as far away as it is long.
    double pixelsPerLength() const { return pixelsPerLength_; }

  private:
    glm::dvec3 eye_;
    glm::dmat3 fromView_, toView_;
    glm::dvec2 size_;
    std::uint64_t width_;
    double pixelsPerLength_ = 0;
};

} // namespace rt::scene
