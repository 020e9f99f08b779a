// Which objects of a scene are selected: any number, of which none lies within another.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "Common/Scene/Edit/SceneEdit.h"

namespace rt::app {

class ObjectSelection {
  public:
    const std::vector<scene::ObjectPath>& paths() const { return paths_; } // sorted
    std::size_t size() const { return paths_.size(); }
    bool contains(const scene::ObjectPath& path) const;
    // The one that came last, of which details are shown; nothing where none is selected.
    const std::optional<scene::ObjectPath>& active() const { return active_; }
    std::uint64_t serial() const { return serial_; } // grows with each change

    void set(std::optional<scene::ObjectPath> path); // that one alone, or none
    // What is in a selected group counts with the group. `active` is among them, or in a group that is.
    void set(std::vector<scene::ObjectPath> paths, const scene::ObjectPath& active);
    // Adds it, in place of groups around it and of what is in it; or removes it.
    void toggle(const scene::ObjectPath& path);

    // The objects stay selected wherever an edit, which is about to be applied, leads them.
    void follow(const scene::SceneEdit& edit);
    void keepExisting(const scene::SceneDesc& scene);

  private:
    void repair(); // after changes to paths_

    std::vector<scene::ObjectPath> paths_;
    std::optional<scene::ObjectPath> active_;
    std::uint64_t serial_ = 0;
};

} // namespace rt::app
