#include "Common/App/Interactive/ObjectSelection.h"

#include <algorithm>
#include <utility>

namespace rt::app {

using scene::ObjectPath;

bool ObjectSelection::contains(const ObjectPath& path) const {
    return std::binary_search(paths_.begin(), paths_.end(), path);
}

void ObjectSelection::repair() {
    ++serial_;
    std::sort(paths_.begin(), paths_.end());
    std::vector<ObjectPath> paths;
    for (ObjectPath& path : paths_) { // a group comes before what is in it
        const bool isCovered = !paths.empty() && (path == paths.back() || path.isWithin(paths.back()));
        if (!isCovered) paths.push_back(std::move(path));
    }
    paths_ = std::move(paths);
    if (active_ && contains(*active_)) return;
    const std::optional<ObjectPath> before = std::exchange(active_, std::nullopt);
    if (paths_.empty()) return;
    active_ = paths_.back();
    for (const ObjectPath& path : paths_)
        if (before && before->isWithin(path)) active_ = path;
}

void ObjectSelection::set(std::optional<ObjectPath> path) {
    if (size() == (path ? 1u : 0u) && active_ == path) return;
    paths_.clear();
    if (path) paths_.push_back(*path);
    active_ = std::move(path);
    repair();
}

void ObjectSelection::set(std::vector<ObjectPath> paths, const ObjectPath& active) {
    paths_ = std::move(paths);
    active_ = active;
    repair();
}

void ObjectSelection::toggle(const ObjectPath& path) {
    const bool isRemoved = contains(path);
    std::erase_if(
        paths_, [&](const ObjectPath& other) { return other == path || path.isWithin(other) || other.isWithin(path); });
    if (!isRemoved) {
        paths_.push_back(path);
        active_ = path;
    }
    repair();
}

void ObjectSelection::follow(const scene::SceneEdit& edit) {
    if (paths_.empty() || !changesStructure(edit)) return;
    if (active_) active_ = placeAfter(edit, *active_);
    std::vector<ObjectPath> paths;
    for (ObjectPath& path : paths_)
        if (auto after = placeAfter(edit, std::move(path))) paths.push_back(std::move(*after));
    paths_ = std::move(paths);
    repair();
}

void ObjectSelection::keepExisting(const scene::SceneDesc& scene) {
    const auto isGone = [&](const ObjectPath& path) { return findObject(scene, path) == nullptr; };
    if (std::erase_if(paths_, isGone) > 0) repair();
}

} // namespace rt::app
