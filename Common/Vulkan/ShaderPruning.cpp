#include "Common/Vulkan/ShaderPruning.h"

#include <utility>

#include "Common/Vulkan/ReachedCode.h"
#include "Common/Vulkan/SpirV.h"

namespace rt::vulkan {
namespace {

using namespace spirv;

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
