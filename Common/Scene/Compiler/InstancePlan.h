// Which prototypes appear where, once nested groups and instances are resolved, and which of them become real
// instances.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "Common/Scene/Affine.h"
#include "Common/Scene/Compiler/MaterialTable.h"
#include "Common/Scene/Compiler/ModelCache.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// One appearance of a prototype.
struct Occurrence {
    Affine toWorld;
    const MaterialDesc* material; // replaces those of the surfaces unless null
    std::uint32_t object;         // the instance of the scene's own lists that it comes from, as Origins counts

    // All surfaces emit, and emitters are world primitives.
    bool isBaked() const { return material && emits(*material); }
};

class InstancePlan {
  public:
    struct Prototype {
        const std::vector<ObjectDesc>* objects = nullptr;
        std::vector<Occurrence> occurrences;
        bool isShared = false; // one geometry for all occurrences, instead of copies
    };

    // Throws InputError for unknown and cyclic prototypes, for prototypes nested deeper than 64, and for more than 2^24
    // instances or 2^28 primitives.
    InstancePlan(const SceneDesc& desc, const MaterialTable& materials, ModelCache& models, const Affine& toWorld);

    // By name; without those that appear nowhere.
    const std::map<std::string, Prototype>& prototypes() const { return prototypes_; }

  private:
    double instanceCount(const std::vector<ObjectDesc>& objects, const std::string& place);
    double instanceCount(const InstanceDesc& instance, const std::string& place);
    void find(const std::vector<ObjectDesc>& objects, const Affine& toWorld, const MaterialDesc* material,
              const std::optional<std::uint32_t>& instance);
    std::size_t primitiveCount(const std::vector<ObjectDesc>& objects);

    const SceneDesc& desc_;
    const MaterialTable& materials_;
    ModelCache& models_;
    std::map<std::string, Prototype> prototypes_;
    std::map<std::string, double> instanceCounts_; // in one appearance of a prototype
    std::vector<std::string> open_;                // prototypes being counted
    std::uint32_t nextObject_ = 0;                 // of the scene's own
};

} // namespace rt::scene
