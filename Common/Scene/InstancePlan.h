// Which prototypes appear where, once nested groups and instances are resolved, and which of them become real
// instances.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "Common/Scene/Affine.h"
#include "Common/Scene/MaterialTable.h"
#include "Common/Scene/ModelCache.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// One appearance of a prototype.
struct Occurrence {
    Affine toWorld;
    const MaterialDesc* material;  // replaces those of the surfaces unless null

    // All surfaces emit, and emitters are world primitives.
    bool isBaked() const { return material && emits(*material); }
};

class InstancePlan {
  public:
    struct Prototype {
        const std::vector<ObjectDesc>* objects = nullptr;
        std::vector<Occurrence> occurrences;
        bool isShared = false;  // one geometry for all occurrences, instead of copies
    };

    // Throws InputError for unknown and cyclic prototypes and for more than 2^24 instances or 2^28 primitives.
    InstancePlan(const SceneDesc& desc, const MaterialTable& materials, ModelCache& models, const Affine& toWorld);

    // By name; without those that appear nowhere.
    const std::map<std::string, Prototype>& prototypes() const { return prototypes_; }

  private:
    void find(const std::vector<ObjectDesc>& objects, const Affine& toWorld, const MaterialDesc* material,
              const std::string& place);
    void enter(const InstanceDesc& instance, const Affine& toWorld, const MaterialDesc* material,
               const std::string& place);
    std::size_t primitiveCount(const std::vector<ObjectDesc>& objects);

    const SceneDesc& desc_;
    const MaterialTable& materials_;
    ModelCache& models_;
    std::map<std::string, Prototype> prototypes_;
    std::vector<std::string> open_;  // being entered
    std::size_t count_ = 0;          // of occurrences
};

}  // namespace rt::scene
