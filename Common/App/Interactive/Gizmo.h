// What is drawn over the picture to take objects by: arrows along the axes to move them, rings about the axes to turn
// them, arms with boxes to scale them. Of the same size on the screen however far away they are.
#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "Common/App/Interactive/ObjectTool.h"

namespace rt::app {

// A part of it, in places of the picture as ViewProjection has them.
struct GizmoHandle {
    using Line = std::pair<glm::dvec2, glm::dvec2>;

    std::optional<ObjectTool::Constraint> constraint; // none: as without
    std::vector<Line> lines;
    std::vector<glm::dvec2> area{};     // filled; of planes
    std::optional<Line> arm{};          // whose end has an arrow's head or a box
    std::optional<glm::dvec2> letter{}; // where the axis is named
};

// Without those that are seen from where the pointer could not use them, such as arrows towards the eye. `size`: the
// length of the arms, in heights of the picture. Nothing where the middle is behind the eye.
std::vector<GizmoHandle> gizmoHandles(ObjectTool::Kind kind, const ToolAxes& axes, const ViewProjection& view,
                                      double size);

// The one that is nearest to a place, up to a distance in heights of the picture; null where none is.
const GizmoHandle* handleAt(const std::vector<GizmoHandle>& handles, double aspect, const glm::dvec2& place,
                            double distance);

} // namespace rt::app
