#include "Common/Vulkan/ReachedCode.h"

#include <cstring>

namespace rt::vulkan::spirv {
namespace {

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

} // namespace

ReachedCode::ReachedCode(std::span<const Word> code, const VkSpecializationInfo& constants, const ReachedCode* before)
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

void ReachedCode::countUses(const Instruction& i) {
    if (i.op == OpLoad || i.op == OpVariable) {
        ids_[i[2]].isVariable = i.op == OpVariable && i.size() == 4; // without a first value
        return;
    }
    if (i.op == OpStore) ++ids_[i[1]].stores;
    for (std::size_t at = i.op == OpStore ? 2 : 1; at < i.size(); ++at)
        if (i[at] < ids_.size()) ids_[i[at]].isShared = true;
}

void ReachedCode::readGlobal(const Instruction& i) {
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

void ReachedCode::read(const Instruction& i, const Place& place) {
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

void ReachedCode::readLive(const Instruction& i, Id block, Known& function) {
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
            endSelection(!ids_[i[1]].value);
            if (i[2] != i[3]) {
                ids_[block].condition = i[1];
                ids_[block].onFalse = i[3];
            }
            break;
        case OpSwitch:
            for (std::size_t target = 2; target < i.size(); target += 2) reach(block, i[target]);
            endSelection(true);
            break;
        case OpReturnValue:
            returned_.insert(ids_[i[1]].value);
            break;
        default:
            if (defines(i)) ids_[i[2]].value = evaluate(i.op, valueAt(i, 3), valueAt(i, 4));
    }
}

void ReachedCode::endSelection(bool isKept) {
    const Id merge = std::exchange(merge_, 0);
    if (isKept) ids_[merge].isMerge = true;
}

Value ReachedCode::specialized(Word constant) const {
    for (std::uint32_t k = 0; k < constants_.mapEntryCount; ++k) {
        const VkSpecializationMapEntry& entry = constants_.pMapEntries[k];
        if (entry.constantID != constant || entry.size != sizeof(Word)) continue;
        Word value = 0;
        std::memcpy(&value, static_cast<const char*>(constants_.pData) + entry.offset, sizeof value);
        return value;
    }
    return {};
}

Value ReachedCode::valueAt(const Instruction& i, std::size_t at) const {
    return at < i.size() && i[at] < ids_.size() ? ids_[i[at]].value : Value();
}

Value ReachedCode::valueOnEdge(Id id, Id from, Id to) const {
    const Known& branch = ids_[from];
    if (ids_[id].value || id != branch.condition) return ids_[id].value;
    return to == branch.onFalse ? 0 : 1;
}

Value ReachedCode::valueOfPhi(const Instruction& i, Id block) {
    std::set<Value> values;
    for (std::size_t at = 3; at + 1 < i.size(); at += 2) {
        if (!ids_[i[at + 1]].isRead) hasPhiOfLoop_ = true;
        if (leads(i[at + 1], block)) values.insert(valueOnEdge(i[at], i[at + 1], block));
    }
    return values.size() == 1 ? *values.begin() : Value();
}

void ReachedCode::reach(Id from, Id block) {
    edges_.insert({from, block});
    ids_[block].isLive = true;
}

void ReachedCode::keepCalled(Id function) {
    if (std::exchange(ids_[function].isLive, true)) return;
    for (const Id called : ids_[function].calls) keepCalled(called);
}

} // namespace rt::vulkan::spirv
