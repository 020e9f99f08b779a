// Moving, turning and scaling an object by the pointer, from where it was when that began.
#pragma once
#include <optional>
#include <string>

#include "Common/App/Interactive/ViewProjection.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::app {

class ObjectTool {
  public:
    enum class Kind { Move, Turn, Scale };

    // `pivot`: the object's middle; `start`: the pointer's place in the picture, as ViewProjection has it.
    ObjectTool(Kind kind, const glm::dvec3& pivot, const glm::dvec2& start)
        : kind_(kind), pivot_(pivot), start_(start) {}

    Kind kind() const { return kind_; }
    const std::optional<int>& axis() const { return axis_; }
    const glm::dvec3& pivot() const { return pivot_; }
    // Along or about the axis x, y or z of the scene (0, 1, 2) alone; told once more: freely again.
    void constrain(int axis) { axis_ = axis_ == axis ? std::nullopt : std::optional(axis); }

    // What the object goes through for a pointer that is there by now: without an axis it is moved across the view,
    // turned about its axis, scaled in all directions. Nothing where the pointer's place says nothing, or is where it
    // began.
    std::optional<scene::Transform> steps(const ViewProjection& view, const glm::dvec2& place) const;
    std::string text(const scene::Transform& steps) const; // "Move along X: 1.5, 0, 0"

  private:
    std::optional<scene::Transform> move(const ViewProjection& view, const glm::dvec2& place) const;
    std::optional<scene::Transform> turn(const ViewProjection& view, const glm::dvec2& place) const;
    std::optional<scene::Transform> scale(const ViewProjection& view, const glm::dvec2& place) const;

    Kind kind_;
    glm::dvec3 pivot_;
    glm::dvec2 start_;
    std::optional<int> axis_;
};

} // namespace rt::app
