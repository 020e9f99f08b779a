#include "Common/Scene/Obj/Polygon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace rt::scene {

namespace {

using Outline = std::vector<glm::dvec2>;

// Newell's: twice the vector area.
glm::dvec3 vectorArea(const std::vector<glm::dvec3>& corners) {
    glm::dvec3 area(0);
    for (std::size_t i = 0; i < corners.size(); ++i)
        area += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
    return area;
}

// As seen along the axis that the polygon faces most, counter-clockwise.
Outline projected(const std::vector<glm::dvec3>& corners) {
    const glm::dvec3 area = vectorArea(corners), size = glm::abs(area);
    const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (area[axis] < 0) std::swap(u, v);
    Outline outline;
    outline.reserve(corners.size());
    for (const glm::dvec3& corner : corners) outline.emplace_back(corner[u], corner[v]);
    return outline;
}

// Twice the area of a triangle; negative: clockwise.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// A left turn at every corner, and no more than one round in all: x grows along one chain and falls along the other.
bool isConvex(const Outline& outline) {
    const std::size_t n = outline.size();
    std::size_t reversals = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec2 &a = outline[i], &b = outline[(i + 1) % n], &c = outline[(i + 2) % n];
        if (!(turn(a, b, c) > 0)) return false;
        reversals += (b.x < a.x) != (c.x < b.x);
    }
    return reversals <= 2;
}

// ---- a grid of points ----------------------------------------------------------------------------------------------

// Of about as many cells as points.
class PointGrid {
  public:
    PointGrid(const Outline& outline, const std::vector<std::uint32_t>& points) {
        lower_ = upper_ = outline[points.front()];
        for (const std::uint32_t i : points) {
            lower_ = glm::min(lower_, outline[i]);
            upper_ = glm::max(upper_, outline[i]);
        }
        constexpr double kMax = 2048;
        size_ = static_cast<int>(std::clamp(std::sqrt(static_cast<double>(points.size())), 1.0, kMax));
        starts_.resize(static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_) + 1);
        for (const std::uint32_t i : points) ++starts_[cellOf(outline[i])];
        std::size_t sum = 0;
        for (std::uint32_t& start : starts_) start = static_cast<std::uint32_t>(sum += start);
        points_.resize(points.size());
        for (const std::uint32_t i : points) points_[--starts_[cellOf(outline[i])]] = i;
    }

    // Calls visit(point) for all that may be in the triangle until it returns true, which is returned then. Takes the
    // cells and points that it looks at off `effort`.
    template <class Visit>
    bool anyIn(const std::array<glm::dvec2, 3>& triangle, std::int64_t& effort, const Visit& visit) const {
        const double low = std::min({triangle[0].y, triangle[1].y, triangle[2].y});
        const double high = std::max({triangle[0].y, triangle[1].y, triangle[2].y});
        if (!(low <= upper_.y && high >= lower_.y)) return false;
        const int lastRow = indexOf(high, 1);
        for (int row = indexOf(low, 1); row <= lastRow; ++row) {
            const auto [left, right] = widthIn(triangle, row);
            if (!(left <= upper_.x && right >= lower_.x)) continue;
            const int first = indexOf(left, 0), last = indexOf(right, 0);
            const std::size_t begin = starts_[cell(first, row)], end = starts_[cell(last, row) + 1];
            effort -= 1 + static_cast<std::int64_t>(end - begin);
            for (std::size_t i = begin; i < end; ++i)
                if (visit(points_[i])) return true;
        }
        return false;
    }

  private:
    double edgeOf(int index, int axis) const { // lower one of a row or column
        return lower_[axis] + (upper_[axis] - lower_[axis]) * index / size_;
    }
    int indexOf(double at, int axis) const {
        const double extent = upper_[axis] - lower_[axis];
        const double place = extent > 0 ? (at - lower_[axis]) / extent * size_ : 0;
        return place > 0 ? static_cast<int>(std::min(place, size_ - 1.0)) : 0;
    }
    std::size_t cell(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(column);
    }
    std::size_t cellOf(const glm::dvec2& p) const { return cell(indexOf(p.x, 0), indexOf(p.y, 1)); }

    // Leftmost and rightmost place of a triangle in a row, which is taken a little higher than it is.
    std::pair<double, double> widthIn(const std::array<glm::dvec2, 3>& triangle, int row) const {
        constexpr double kNowhere = std::numeric_limits<double>::infinity();
        const double margin = 1e-6 * (upper_.y - lower_.y) / size_;
        const double low = edgeOf(row, 1) - margin, high = edgeOf(row + 1, 1) + margin;
        double left = upper_.x, right = lower_.x;
        bool isEmpty = true;
        const auto take = [&](double x) {
            left = isEmpty ? x : std::min(left, x);
            right = isEmpty ? x : std::max(right, x);
            isEmpty = false;
        };
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec2 &a = triangle[i], &b = triangle[(i + 1) % 3];
            if (a.y >= low && a.y <= high) take(a.x);
            for (const double y : {low, high})
                if ((a.y < y) != (b.y < y)) take(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)));
        }
        const double slack = 1e-6 * (upper_.x - lower_.x) / size_;
        return isEmpty ? std::pair(kNowhere, -kNowhere) : std::pair(left - slack, right + slack);
    }

    glm::dvec2 lower_{0}, upper_{0};
    int size_ = 1;                      // cells along each axis
    std::vector<std::uint32_t> starts_; // of each cell in points_, and their end
    std::vector<std::uint32_t> points_;
};

// ---- ears ----------------------------------------------------------------------------------------------------------

// Cuts off ears: corners with a left turn whose triangle holds no other corner (G. Meisters, Polygons have ears, 1975).
// Only one without a left turn can be the first in a triangle, and a cut changes the neighbours alone.
class EarCutter {
  public:
    explicit EarCutter(const Outline& outline)
        : outline_(outline),
          count_(static_cast<std::uint32_t>(outline.size())),
          before_(count_),
          after_(count_),
          isCut_(count_, 0),
          effort_(kEffort * count_) {
        for (std::uint32_t i = 0; i < count_; ++i) {
            before_[i] = (i + count_ - 1) % count_;
            after_[i] = (i + 1) % count_;
        }
    }

    std::vector<glm::uvec3> cut() {
        std::vector<std::uint32_t> reflex;
        for (std::uint32_t i = 0; i < count_; ++i)
            if (!isLeft(i)) reflex.push_back(i);
        if (reflex.empty()) reflex.push_back(0); // it goes around twice
        const PointGrid grid(outline_, reflex);
        triangles_.reserve(count_ - 2);
        while (triangles_.size() + 3 < count_ && cutRound(grid)) {
        }
        cutFan();
        return std::move(triangles_);
    }

  private:
    // Looks at cells and points for each corner, far beyond what polygons need that somebody drew.
    static constexpr std::int64_t kEffort = 2048;

    bool isLeft(std::uint32_t i) const { return turn(outline_[before_[i]], outline_[i], outline_[after_[i]]) > 0; }
    bool isEar(std::uint32_t i, const PointGrid& grid) {
        if (!isLeft(i)) return false;
        if (--effort_ < 0) return true;
        const glm::dvec2 &a = outline_[before_[i]], &b = outline_[i], &c = outline_[after_[i]];
        return !grid.anyIn({a, b, c}, effort_, [&](std::uint32_t k) {
            const glm::dvec2& p = outline_[k];
            return isCut_[k] == 0 && p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 &&
                   turn(c, a, p) >= 0;
        });
    }
    // Every corner is looked at, and the neighbours of what is cut again. False: no corner is an ear.
    bool cutRound(const PointGrid& grid) {
        const std::size_t before = triangles_.size();
        std::vector<std::uint32_t> queue;
        for (std::uint32_t i = 0; i < count_; ++i)
            if (isCut_[i] == 0) queue.push_back(i);
        for (std::size_t next = 0; next < queue.size() && triangles_.size() + 3 < count_; ++next) {
            const std::uint32_t i = queue[next];
            if (isCut_[i] != 0 || !isEar(i, grid)) continue;
            triangles_.emplace_back(before_[i], i, after_[i]);
            isCut_[i] = 1;
            after_[before_[i]] = after_[i];
            before_[after_[i]] = before_[i];
            queue.push_back(before_[i]);
            queue.push_back(after_[i]);
        }
        return triangles_.size() > before;
    }
    // What is left.
    void cutFan() {
        const auto first = static_cast<std::uint32_t>(std::ranges::find(isCut_, 0) - isCut_.begin());
        for (std::uint32_t i = after_[first]; after_[i] != first; i = after_[i])
            triangles_.emplace_back(first, i, after_[i]);
    }

    const Outline& outline_;
    const std::uint32_t count_;
    std::vector<std::uint32_t> before_, after_; // of each corner, among those that are left
    std::vector<std::uint8_t> isCut_;
    std::int64_t effort_; // left
    std::vector<glm::uvec3> triangles_;
};

} // namespace

std::vector<glm::uvec3> cutPolygon(const std::vector<glm::dvec3>& corners) {
    const Outline outline = projected(corners);
    if (!isConvex(outline)) return EarCutter(outline).cut();
    const auto last = static_cast<std::uint32_t>(corners.size() - 1);
    std::vector<glm::uvec3> triangles;
    triangles.reserve(corners.size() - 2);
    for (std::uint32_t i = 0; i + 2 < last; ++i) triangles.emplace_back(last, i, i + 1);
    triangles.emplace_back(last - 2, last - 1, last);
    return triangles;
}

} // namespace rt::scene
