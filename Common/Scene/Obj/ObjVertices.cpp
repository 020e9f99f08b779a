#include "Common/Scene/Obj/ObjVertices.h"

#include "Common/Shared/Base/Types.h"

namespace rt::scene {

// The finalizer of MurmurHash3 (A. Appleby), twice.
std::size_t VertexTable::Hash::operator()(const glm::uvec3& v) const {
    const auto mixed = [](std::uint64_t x) {
        x = (x ^ x >> 33) * 0xff51afd7ed558ccdu;
        x = (x ^ x >> 33) * 0xc4ceb9fe1a85ec53u;
        return x ^ x >> 33;
    };
    return static_cast<std::size_t>(mixed(mixed(std::uint64_t{v.x} << 32 | v.y) + v.z));
}

std::uint32_t VertexTable::append(const glm::uvec3& combination) {
    combinations_.push_back(combination);
    next_.push_back(shared::kNone);
    return static_cast<std::uint32_t>(combinations_.size() - 1);
}

std::uint32_t VertexTable::indexOf(const glm::uvec3& combination) {
    constexpr int kLongestChain = 8;
    if (combination.x >= first_.size()) {
        if (combination.x >= first_.capacity()) first_.reserve(2 * std::size_t{combination.x} + 1);
        first_.resize(std::size_t{combination.x} + 1, shared::kNone);
    }
    std::uint32_t* link = &first_[combination.x];
    int length = 0;
    for (; *link != shared::kNone; link = &next_[*link], ++length) {
        if (combinations_[*link] == combination) return *link;
        if (length < kLongestChain) continue;
        const auto [entry, isNew] = further_.try_emplace(combination, 0);
        if (isNew) entry->second = append(combination);
        return entry->second;
    }
    const auto index = static_cast<std::uint32_t>(combinations_.size());
    *link = index; // before the vector of links grows
    append(combination);
    return index;
}

} // namespace rt::scene
