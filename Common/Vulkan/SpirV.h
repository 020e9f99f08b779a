// What of SPIR-V is read here: instructions one after the other, and where they stand (SPIR-V specification 1.5).
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace rt::vulkan::spirv {

using Word = std::uint32_t;
using Id = Word;

// Section "Instructions": those that are told apart here.
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
inline constexpr Word kSpecIdDecoration = 1;
inline constexpr std::size_t kHeaderWords = 5, kBoundAt = 3;

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

} // namespace rt::vulkan::spirv
