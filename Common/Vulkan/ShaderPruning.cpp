#include "Common/Vulkan/ShaderPruning.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <set>
#include <utility>

namespace rt::vulkan {
namespace {

using Word = std::uint32_t;
using Id = Word;
using Value = std::optional<Word>; // of a 32-bit integer or of a bool, 0 or 1; none: not known

// Of the SPIR-V specification 1.5, "Instructions": those that are told apart here.
enum Op : Word {
    OpName = 5,
    OpEntryPoint = 15,
    OpTypeVoid = 19,
    OpTypeForwardPointer = 39,
    OpConstantTrue = 41,
    OpConstantFalse = 42,
    OpConstant = 43,
    OpSpecConstantTrue = 48,
    OpSpecConstantFalse = 49,
    OpSpecConstant = 50,
    OpSpecConstantOp = 52,
    OpFunction = 54,
    OpFunctionEnd = 56,
    OpFunctionCall = 57,
    OpVariable = 59,
    OpLoad = 61,
    OpStore = 62,
    OpDecorate = 71,
    OpLogicalEqual = 164,
    OpLogicalNotEqual = 165,
    OpLogicalOr = 166,
    OpLogicalAnd = 167,
    OpLogicalNot = 168,
    OpIEqual = 170,
    OpINotEqual = 171,
    OpUGreaterThan = 172,
    OpUGreaterThanEqual = 174,
    OpULessThan = 176,
    OpULessThanEqual = 178,
    OpBitwiseOr = 197,
    OpBitwiseAnd = 199,
    OpPhi = 245,
    OpLoopMerge = 246,
    OpSelectionMerge = 247,
    OpLabel = 248,
    OpBranch = 249,
    OpBranchConditional = 250,
    OpSwitch = 251,
    OpReturnValue = 254,
    OpUnreachable = 255
};
constexpr Word kSpecIdDecoration = 1;
constexpr std::size_t kHeaderWords = 5, kBoundAt = 3;

struct Instruction {
    Op op = OpUnreachable;
    std::span<const Word> words; // the first holds the operation and their number
    Word operator[](std::size_t i) const { return words[i]; }
    std::size_t size() const { return words.size(); }
};

template <class Visit>
void forEachInstruction(std::span<const Word> code, const Visit& visit) {
    for (std::size_t at = 0; at < code.size();) {
        const std::size_t size = std::max<std::size_t>(code[at] >> 16, 1);
        visit(Instruction{static_cast<Op>(code[at] & 0xffff), code.subspan(at, size)});
        at += size;
    }
}

Value both(Value a, Value b, Word (*combine)(Word, Word)) {
    return a && b ? Value(combine(*a, *b)) : Value();
}

// Of the operations on integers and bools that conditions on constants are made of.
Value evaluate(Op op, Value a, Value b) {
    switch (op) {
        case OpLogicalAnd:
            if (a == Value(0) || b == Value(0)) return 0;
            return both(a, b, [](Word x, Word y) { return x & y; });
        case OpLogicalOr:
            if (a == Value(1) || b == Value(1)) return 1;
            return both(a, b, [](Word x, Word y) { return x | y; });
        case OpLogicalNot:
            return a ? Value(1 - *a) : Value();
        case OpBitwiseAnd:
            return both(a, b, [](Word x, Word y) { return x & y; });
        case OpBitwiseOr:
            return both(a, b, [](Word x, Word y) { return x | y; });
        case OpLogicalEqual:
        case OpIEqual:
            return both(a, b, [](Word x, Word y) { return Word{x == y}; });
        case OpLogicalNotEqual:
        case OpINotEqual:
            return both(a, b, [](Word x, Word y) { return Word{x != y}; });
        case OpUGreaterThan:
            return both(a, b, [](Word x, Word y) { return Word{x > y}; });
        case OpUGreaterThanEqual:
            return both(a, b, [](Word x, Word y) { return Word{x >= y}; });
        case OpULessThan:
            return both(a, b, [](Word x, Word y) { return Word{x < y}; });
        case OpULessThanEqual:
            return both(a, b, [](Word x, Word y) { return Word{x <= y}; });
        default:
            return {};
    }
}

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

// Where an instruction stands. 0: outside.
struct Place {
    Id function = 0, block = 0;

    void enter(const Instruction& i) {
        if (i.op == OpFunction) *this = {i[2], 0};
        if (i.op == OpLabel) block = i[1];
        if (i.op == OpFunctionEnd) block = 0;
    }
    void leave(const Instruction& i) {
        if (i.op == OpFunctionEnd) *this = {};
    }
};

template <class Visit> // visit(instruction, place)
void forEachPlaced(std::span<const Word> code, const Visit& visit) {
    Place place;
    forEachInstruction(code, [&](const Instruction& i) {
        place.enter(i);
        visit(i, place);
        place.leave(i);
    });
}

// Finds what may be reached, in one walk, as blocks stand behind the ones by which all ways lead to them, and functions
// before most of those that call them. More is known where it knows which stores are never reached, from a walk before.
class ReachedCode {
  public:
    ReachedCode(std::span<const Word> code, const VkSpecializationInfo& constants, const ReachedCode* before = nullptr)
        : constants_(constants), ids_(code[kBoundAt]) {
        const std::span<const Word> body = code.subspan(kHeaderWords);
        forEachPlaced(body, [this, before](const Instruction& i, const Place& place) {
            if (place.block != 0 && (before == nullptr || before->isLive(place))) countUses(i);
        });
        forEachPlaced(body, [this](const Instruction& i, const Place& place) {
            if (place.function == 0) {
                readGlobal(i);
            } else {
                read(i, place);
            }
        });
        keepCalled(entry_);
    }

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
    void countUses(const Instruction& i) {
        if (i.op == OpLoad || i.op == OpVariable) {
            ids_[i[2]].isVariable = i.op == OpVariable && i.size() == 4; // without a first value
            return;
        }
        if (i.op == OpStore) ++ids_[i[1]].stores;
        for (std::size_t at = i.op == OpStore ? 2 : 1; at < i.size(); ++at)
            if (i[at] < ids_.size()) ids_[i[at]].isShared = true;
    }

    void readGlobal(const Instruction& i) {
        if (i.op == OpEntryPoint) entry_ = i[2];
        if (i.op >= OpTypeVoid && i.op < OpTypeForwardPointer) ids_[i[1]].isType = true;
        if (i.op == OpDecorate && i[2] == kSpecIdDecoration) ids_[i[1]].specialized = specialized(i[3]);
        if (i.op == OpConstantTrue || i.op == OpSpecConstantTrue) ids_[i[2]].value = 1;
        if (i.op == OpConstantFalse || i.op == OpSpecConstantFalse) ids_[i[2]].value = 0;
        if ((i.op == OpConstant || i.op == OpSpecConstant) && i.size() == 4) ids_[i[2]].value = i[3];
        if (i.op >= OpSpecConstantTrue && i.op <= OpSpecConstant && ids_[i[2]].specialized)
            ids_[i[2]].value = ids_[i[2]].specialized;
        if (i.op == OpSpecConstantOp) ids_[i[2]].value = evaluate(static_cast<Op>(i[3]), valueAt(i, 4), valueAt(i, 5));
    }

    void read(const Instruction& i, const Place& place) {
        Known& function = ids_[place.function];
        if (i.op == OpFunction) {
            isEntered_ = false;
            returned_.clear();
        } else if (i.op == OpFunctionEnd) {
            if (returned_.size() == 1) function.value = *returned_.begin();
        } else if (i.op == OpLabel) {
            ids_[place.block].isRead = true;
            if (!std::exchange(isEntered_, true)) ids_[place.block].isLive = true;
        } else if (place.block != 0 && ids_[place.block].isLive) {
            readLive(i, place.block, function);
        }
    }

    void readLive(const Instruction& i, Id block, Known& function) {
        switch (i.op) {
            case OpPhi:
                ids_[i[2]].value = valueOfPhi(i, block);
                break;
            case OpFunctionCall:
                function.calls.push_back(i[3]);
                ids_[i[2]].value = ids_[i[3]].value;
                break;
            case OpStore: // the only one: whoever loads before that, loads nothing
                if (isKeptApart(ids_[i[1]])) ids_[i[1]].value = ids_[i[2]].value;
                break;
            case OpLoad:
                if (isKeptApart(ids_[i[3]])) ids_[i[2]].value = ids_[i[3]].value;
                break;
            case OpSelectionMerge:
                merge_ = i[1];
                break;
            case OpLoopMerge:
                ids_[i[1]].isMerge = true;
                ids_[i[2]].loop = block;
                break;
            case OpBranch:
                reach(block, i[1]);
                break;
            case OpBranchConditional:
                if (ids_[i[1]].value != Value(0)) reach(block, i[2]);
                if (ids_[i[1]].value != Value(1)) reach(block, i[3]);
                if (!ids_[i[1]].value) ids_[merge_].isMerge = true;
                if (i[2] != i[3]) {
                    ids_[block].condition = i[1];
                    ids_[block].onFalse = i[3];
                }
                break;
            case OpSwitch:
                for (std::size_t target = 2; target < i.size(); target += 2) reach(block, i[target]);
                ids_[merge_].isMerge = true;
                break;
            case OpReturnValue:
                returned_.insert(ids_[i[1]].value);
                break;
            default:
                if (defines(i)) ids_[i[2]].value = evaluate(i.op, valueAt(i, 3), valueAt(i, 4));
        }
    }

    static bool isKeptApart(const Known& id) { return id.isVariable && !id.isShared && id.stores == 1; }

    Value specialized(Word constant) const {
        for (std::uint32_t k = 0; k < constants_.mapEntryCount; ++k) {
            const VkSpecializationMapEntry& entry = constants_.pMapEntries[k];
            if (entry.constantID != constant || entry.size != sizeof(Word)) continue;
            Word value = 0;
            std::memcpy(&value, static_cast<const char*>(constants_.pData) + entry.offset, sizeof value);
            return value;
        }
        return {};
    }
    Value valueAt(const Instruction& i, std::size_t at) const {
        return at < i.size() && i[at] < ids_.size() ? ids_[i[at]].value : Value();
    }

    // Of an id where the block `from` leads to `to`: of a condition, by the way taken, as a && b ends with that of a.
    Value valueOnEdge(Id id, Id from, Id to) const {
        const Known& branch = ids_[from];
        if (ids_[id].value || id != branch.condition) return ids_[id].value;
        return to == branch.onFalse ? 0 : 1;
    }

    // The one on which all blocks agree from which it is reached.
    Value valueOfPhi(const Instruction& i, Id block) {
        std::set<Value> values;
        for (std::size_t at = 3; at + 1 < i.size(); at += 2) {
            if (!ids_[i[at + 1]].isRead) hasPhiOfLoop_ = true;
            if (leads(i[at + 1], block)) values.insert(valueOnEdge(i[at], i[at + 1], block));
        }
        return values.size() == 1 ? *values.begin() : Value();
    }

    void reach(Id from, Id block) {
        edges_.insert({from, block});
        ids_[block].isLive = true;
    }
    void keepCalled(Id function) {
        if (std::exchange(ids_[function].isLive, true)) return;
        for (const Id called : ids_[function].calls) keepCalled(called);
    }

    const VkSpecializationInfo& constants_;
    std::vector<Known> ids_;
    std::set<std::pair<Id, Id>> edges_; // from block to block
    Id entry_ = 0, merge_ = 0;
    bool isEntered_ = false;   // the function at hand has had a block
    std::set<Value> returned_; // by it
    bool hasPhiOfLoop_ = false;
};

class PrunedCode {
  public:
    PrunedCode(std::span<const Word> code, const ReachedCode& reached) : reached_(reached), isRemoved_(code[kBoundAt]) {
        const std::span<const Word> body = code.subspan(kHeaderWords);
        forEachPlaced(body, [this](const Instruction& i, const Place& place) {
            if (reached_.isLive(place) || isStub(i, place)) return;
            if (i.op == OpLabel) isRemoved_[i[1]] = true;
            if (reached_.defines(i)) isRemoved_[i[2]] = true;
        });
        words_.assign(code.begin(), code.begin() + kHeaderWords);
        forEachPlaced(body, [this](const Instruction& i, const Place& place) { write(i, place); });
    }

    std::vector<Word> take() { return std::move(words_); }

  private:
    // A block that is not reached, but named: what ends or continues there does so nowhere else.
    bool isStub(const Instruction& i, const Place& place) const {
        return i.op == OpLabel && reached_[place.function].isLive && !reached_[place.block].isLive &&
               (reached_[place.block].isMerge || reached_[place.block].loop != 0);
    }

    void write(const Instruction& i, const Place& place) {
        if (isStub(i, place)) {
            add(i.words);
            const Id loop = reached_[place.block].loop;
            if (loop != 0) {
                add(OpBranch, {loop});
            } else {
                add(OpUnreachable, {});
            }
        } else if (reached_.isLive(place) && !isOfRemoved(i)) {
            writeLive(i, place.block);
        }
    }

    void writeLive(const Instruction& i, Id block) {
        if (i.op == OpSelectionMerge) {
            merge_ = i.words;
        } else if (i.op == OpBranchConditional && reached_[i[1]].value) {
            add(OpBranch, {*reached_[i[1]].value == 1 ? i[2] : i[3]});
            merge_ = {};
        } else if (i.op == OpPhi) {
            std::vector<Word> operands{i[1], i[2]};
            for (std::size_t at = 3; at + 1 < i.size(); at += 2)
                if (reached_.leads(i[at + 1], block)) operands.insert(operands.end(), {i[at], i[at + 1]});
            add(OpPhi, operands);
        } else {
            add(std::exchange(merge_, {}));
            add(i.words);
        }
    }

    bool isOfRemoved(const Instruction& i) const { return (i.op == OpName || i.op == OpDecorate) && isRemoved_[i[1]]; }

    void add(std::span<const Word> words) { words_.insert(words_.end(), words.begin(), words.end()); }
    void add(Op op, const std::vector<Word>& operands) {
        words_.push_back(static_cast<Word>(operands.size() + 1) << 16 | op);
        add(operands);
    }

    const ReachedCode& reached_;
    std::vector<bool> isRemoved_; // ids
    std::vector<Word> words_;
    std::span<const Word> merge_; // that waits for the branch after it
};

} // namespace

std::vector<std::uint32_t> prunedShader(std::span<const std::uint32_t> code, const VkSpecializationInfo& constants) {
    const ReachedCode first(code, constants), reached(code, constants, &first);
    if (reached.hasPhiOfLoop()) return {code.begin(), code.end()};
    return PrunedCode(code, reached).take();
}

} // namespace rt::vulkan
