// The objects of a scene as the rows of a tree, of which a window draws those in sight.
#pragma once
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "Common/Scene/Edit/ObjectPath.h"

namespace rt::app {

const char* kindName(const scene::ObjectDesc& object); // "Sphere"
std::string labelOf(const scene::ObjectDesc& object);  // with what tells it from others: "Sphere  gold"

class ObjectList {
  public:
    // What is in closed groups has no rows. With a search there are those objects alone whose label contains it, in
    // whatever case, and none is closed.
    void build(const scene::SceneDesc& scene, const std::set<scene::ObjectPath>& open, const std::string& search);

    std::size_t size() const { return rows_.size(); }
    scene::ObjectPath path(std::size_t row) const;
    std::uint32_t depth(std::size_t row) const { return rows_[row].depth; }
    // Of the row of an object, or of where it would be; size(): it has none.
    std::size_t find(const scene::ObjectPath& path) const;

  private:
    struct Row {
        std::uint32_t index, depth; // in its list; of groups around it
        std::uint32_t group;        // the row of the group that it is in, where depth is not 0
    };
    struct Building;
    void add(const std::vector<scene::ObjectDesc>& objects, Building& building);

    std::vector<Row> rows_;
    std::vector<scene::ObjectPath> found_; // by a search, in place of rows that lead to them
};

} // namespace rt::app
