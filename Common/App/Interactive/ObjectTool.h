// Moving, turning and scaling objects by the pointer, from where they were when that began.
#pragma once
#include <optional>
#include <string>

#include <glm/mat3x3.hpp>

#include "Common/App/Interactive/ViewProjection.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::app {

// Where a tool acts.
struct ToolAxes {
    glm::dvec3 pivot{0};        // the middle of what it moves
    glm::dmat3 directions{1.0}; // of X, Y and Z: those of the scene, or an object's own; at right angles, of length 1
    bool operator==(const ToolAxes&) const = default;
};

class ObjectTool {
  public:
    enum class Kind { Move, Turn, Scale };

    // What the pointer's way counts for: one axis alone, or the two others.
    struct Constraint {
        int axis = 0; // X, Y, Z
        bool isPlane = false;
        bool operator==(const Constraint&) const = default;
    };
    // What objects go through, and how it is told: "Move along X: 1.5".
    struct Motion {
        scene::Transform steps;
        std::string text;
    };

    // `start`: the pointer's place in the picture, as ViewProjection has it.
    ObjectTool(Kind kind, const ToolAxes& axes, const glm::dvec2& start) : kind_(kind), axes_(axes), start_(start) {}
    // By a handle that the pointer holds, and that is to stay under it. `reach`: the length of the gizmo's arms.
    ObjectTool(Kind kind, const ToolAxes& axes, const glm::dvec2& start, std::optional<Constraint> constraint,
               double reach)
        : kind_(kind), axes_(axes), start_(start), constraint_(constraint), reach_(reach) {}

    Kind kind() const { return kind_; }
    const ToolAxes& axes() const { return axes_; }
    const std::optional<Constraint>& constraint() const { return constraint_; }
    // Along or about that axis alone; told once more: freely again.
    void constrain(int axis);

    // For a pointer that is there by now: without a constraint objects are moved across the view, turned about its
    // axis, scaled in all directions. Nothing where the pointer's place says nothing, or is where it began.
    // `isSnapped`: by whole steps, of moveStep(), 15 degrees or a tenth.
    std::optional<Motion> motion(const ViewProjection& view, const glm::dvec2& place, bool isSnapped) const;

    // Of lengths about the pivot: 1, 2 or 5 times a power of ten that is some pixels long.
    double moveStep(const ViewProjection& view) const;

  private:
    std::optional<Motion> move(const ViewProjection& view, const glm::dvec2& place, bool isSnapped) const;
    std::optional<Motion> turn(const ViewProjection& view, const glm::dvec2& place, bool isSnapped) const;
    std::optional<Motion> scale(const ViewProjection& view, const glm::dvec2& place, bool isSnapped) const;
    std::optional<double> turnedBy(const ViewProjection& view, const glm::dvec2& place) const;
    std::optional<double> ringAngle(const ViewProjection& view, const glm::dvec2& place) const;
    std::string textOf(const char* verb, const char* preposition) const;

    Kind kind_;
    ToolAxes axes_;
    glm::dvec2 start_;
    std::optional<Constraint> constraint_;
    double reach_ = 0; // 0: by no handle
};

// Nothing where the line of sight is parallel to what it would meet, or meets it behind the eye.
std::optional<double> alongAxis(const ViewProjection& view, const glm::dvec3& point, const glm::dvec3& axis,
                                const glm::dvec2& place); // from the point to where the sight passes the axis
std::optional<glm::dvec3> inPlane(const ViewProjection& view, const glm::dvec3& point, const glm::dvec3& normal,
                                  const glm::dvec2& place); // where the sight meets the plane through the point

} // namespace rt::app
