// What of a shader its specialization constants leave to be reached.
#pragma once
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <vulkan/vulkan.h>

#include "Common/Vulkan/SpirV.h"

namespace rt::vulkan::spirv {

using Value = std::optional<Word>; // of a 32-bit integer or of a bool, 0 or 1; none: not known

// What is known of an id.
struct Known {
    Value value;       // of a constant or an expression, or of whatever a function returns
    Value specialized; // by the specialization constants
    bool isType = false;
    bool isRead = false;   // a block that stands before the one at hand, or that one
    bool isLive = false;   // a block that may be reached, a function that may be called
    bool isMerge = false;  // a block where a selection or a loop ends
    Id loop = 0;           // of a block where a loop continues: the loop's header
    Id condition = 0;      // of a block: by which it leads on,
    Id onFalse = 0;        // and where to unless that holds
    std::vector<Id> calls; // of a function
    // A variable of a function; in how many places it is stored to; whether it is named for anything else than that
    // and to be loaded.
    bool isVariable = false;
    std::uint32_t stores = 0;
    bool isShared = false;
};

// Finds what may be reached, in one walk, as blocks stand behind the ones by which all ways lead to them, and functions
// before most of those that call them. More is known where it knows which stores are never reached, from a walk before.
class ReachedCode {
  public:
    ReachedCode(std::span<const Word> code, const VkSpecializationInfo& constants, const ReachedCode* before = nullptr);

    const Known& operator[](Id id) const { return ids_[id]; }
    bool isLive(const Place& place) const {
        if (place.function == 0) return true;
        return ids_[place.function].isLive && (place.block == 0 || ids_[place.block].isLive);
    }
    bool leads(Id from, Id to) const { return edges_.contains({from, to}); }
    bool defines(const Instruction& i) const { return i.size() >= 3 && i[1] < ids_.size() && ids_[i[1]].isType; }
    bool hasPhiOfLoop() const { return hasPhiOfLoop_; }

  private:
    // Words that are no ids may be taken for some: the variables they would be are shared then.
    void countUses(const Instruction& i);
    void readGlobal(const Instruction& i);
    void read(const Instruction& i, const Place& place);
    void readLive(const Instruction& i, Id block, Known& function);
    // At the branch behind an OpSelectionMerge, which is kept only where both ways are open.
    void endSelection(bool isKept);
    void reach(Id from, Id block);
    void keepCalled(Id function);

    static bool isKeptApart(const Known& id) { return id.isVariable && !id.isShared && id.stores == 1; }

    Value specialized(Word constant) const;
    Value valueAt(const Instruction& i, std::size_t at) const;
    // Of an id where the block `from` leads to `to`: of a condition, by the way taken, as a && b ends with that of a.
    Value valueOnEdge(Id id, Id from, Id to) const;
    // The one on which all blocks agree from which it is reached.
    Value valueOfPhi(const Instruction& i, Id block);

    const VkSpecializationInfo& constants_;
    std::vector<Known> ids_;
    std::set<std::pair<Id, Id>> edges_; // from block to block
    Id entry_ = 0, merge_ = 0;
    bool isEntered_ = false;   // the function at hand has had a block
    std::set<Value> returned_; // by it
    bool hasPhiOfLoop_ = false;
};

} // namespace rt::vulkan::spirv
