#include "Common/App/Interactive/ObjectList.h"

#include <string_view>

#include "Common/Core/TextSearch.h"

namespace rt::app {
namespace {

struct KindName {
    const char* operator()(const scene::SphereDesc&) const { return "Sphere"; }
    const char* operator()(const scene::SphereSetDesc&) const { return "Spheres"; }
    const char* operator()(const scene::QuadDesc&) const { return "Quad"; }
    const char* operator()(const scene::BoxDesc&) const { return "Box"; }
    const char* operator()(const scene::DiskDesc&) const { return "Disk"; }
    const char* operator()(const scene::CylinderDesc&) const { return "Cylinder"; }
    const char* operator()(const scene::MeshDesc&) const { return "Mesh"; }
    const char* operator()(const scene::MediumDesc&) const { return "Medium"; }
    const char* operator()(const scene::PointLightDesc&) const { return "Point light"; }
    const char* operator()(const scene::SpotLightDesc&) const { return "Spot light"; }
    const char* operator()(const scene::DirectionalLightDesc&) const { return "Directional light"; }
    const char* operator()(const scene::GroupDesc&) const { return "Group"; }
    const char* operator()(const scene::InstanceDesc&) const { return "Instance"; }
};

const std::string* referredName(const scene::ObjectDesc& object) {
    if (const auto* instance = std::get_if<scene::InstanceDesc>(&object.shape)) return &instance->prototype;
    return materialNameOf(object);
}

bool matches(const scene::ObjectDesc& object, std::string_view search) {
    const std::string* name = referredName(object);
    return contains(kindName(object), search) || (name != nullptr && contains(*name, search));
}

} // namespace

const char* kindName(const scene::ObjectDesc& object) {
    return std::visit(KindName{}, object.shape);
}

std::string labelOf(const scene::ObjectDesc& object) {
    const std::string* name = referredName(object);
    std::string label = kindName(object);
    if (name != nullptr && !name->empty()) label += "  " + *name;
    if (const auto* group = std::get_if<scene::GroupDesc>(&object.shape))
        label += "  of " + std::to_string(group->objects.size());
    return label;
}

struct ObjectList::Building {
    const std::set<scene::ObjectPath>& open;
    std::string search;
    scene::ObjectPath list; // that is gone through, without an index of it
    std::uint32_t depth = 0, group = 0;
};

void ObjectList::build(const scene::SceneDesc& scene, const std::set<scene::ObjectPath>& open,
                       const std::string& search) {
    rows_.clear();
    found_.clear();
    Building building{open, search, {}};
    add(scene.objects, building);
}

void ObjectList::add(const std::vector<scene::ObjectDesc>& objects, Building& building) {
    rows_.reserve(rows_.size() + (building.search.empty() ? objects.size() : 0));
    const std::uint32_t group = building.group;
    building.list.indices.push_back(0);
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
        building.list.indices.back() = i;
        const auto* inner = std::get_if<scene::GroupDesc>(&objects[i].shape);
        if (!building.search.empty()) {
            if (matches(objects[i], building.search)) {
                found_.push_back(building.list);
                rows_.push_back({i, 0, 0});
            }
        } else {
            rows_.push_back({i, building.depth, group});
        }
        if (inner == nullptr || (building.search.empty() && !building.open.contains(building.list))) continue;
        building.group = static_cast<std::uint32_t>(rows_.size() - 1);
        ++building.depth;
        add(inner->objects, building);
        --building.depth;
    }
    building.list.indices.pop_back();
    building.group = group;
}

scene::ObjectPath ObjectList::path(std::size_t row) const {
    if (!found_.empty()) return found_[row];
    scene::ObjectPath path;
    path.indices.resize(rows_[row].depth + 1);
    for (std::size_t depth = rows_[row].depth;; --depth) {
        path.indices[depth] = rows_[row].index;
        if (depth == 0) return path;
        row = rows_[row].group;
    }
}

// Rows are in the order of their paths.
std::size_t ObjectList::find(const scene::ObjectPath& path) const {
    std::size_t low = 0, high = size();
    while (low < high) {
        const std::size_t middle = low + (high - low) / 2;
        if (this->path(middle).indices < path.indices)
            low = middle + 1;
        else
            high = middle;
    }
    return low < size() && this->path(low) == path ? low : size();
}

} // namespace rt::app
