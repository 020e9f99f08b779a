// A camera that is flown, orbited, panned and dollied.
#pragma once
#include <optional>
#include <string>

#include "Common/Scene/SceneDesc.h"

namespace rt::app {

// Directions are those of the camera; distances are in world units. The camera never gets an orientation that
// makeCamera() refuses, whatever it is told.
class CameraController {
  public:
    // A camera of the scene: reset() leads back to it, and its distance from what it looks at sets the pace.
    void setHome(const scene::CameraDesc& camera);
    const scene::CameraDesc& home() const { return home_; }
    void moveHome(const scene::CameraDesc& camera) { home_ = camera; } // that camera is there now; this one stays
    void reset();

    const scene::CameraDesc& camera() const { return camera_; }
    void set(const scene::CameraDesc& camera); // typed or pasted

    // Shares of the speed, -1 to 1, for a time in seconds.
    void fly(double right, double up, double forward, double seconds);
    void look(double yaw, double pitch);  // turns in place; radians, positive: to the left, up
    void orbit(double yaw, double pitch); // moves around the target
    // Moves camera and target across the view, by shares of the image's height at the target's distance.
    void pan(double right, double up);
    void dolly(double steps); // towards the target, positive: nearer
    // As far back as all of a sphere is in sight of an image of that aspect ratio (width / height).
    void frame(const glm::dvec3& center, double radius, double aspect);
    void changeSpeed(double steps);
    double speed() const { return speed_; } // units a second

    // The focus distance that makes a point at this distance along a view ray sharp, for a ray that leaves the view's
    // axis by `cosine`.
    void focusAt(double distanceAlongRay, double cosine);

    // As text for the clipboard, and back. Nothing where the text is no pose.
    static std::string toText(const scene::CameraDesc& camera);
    static std::optional<scene::CameraDesc> fromText(const std::string& text, const scene::CameraDesc& defaults);

  private:
    void move(const glm::dvec3& offset);

    scene::CameraDesc camera_;
    scene::CameraDesc home_;
    double speed_ = 1;
};

} // namespace rt::app
