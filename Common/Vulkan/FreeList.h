// Which places of a block are free: the arithmetic of a sub-allocator, whatever the block holds.
#pragma once
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>

namespace rt::vulkan {

// First fit: the lowest place that is large enough. Offsets and sizes in any one unit.
class FreeList {
  public:
    explicit FreeList(std::uint64_t size) : size_(size) { free_[0] = size; }

    // The offset of a place of `size` > 0 at a multiple of `alignment`, a power of two; nothing where none is free.
    std::optional<std::uint64_t> take(std::uint64_t size, std::uint64_t alignment) {
        for (auto range = free_.begin(); range != free_.end(); ++range) {
            const auto [begin, length] = *range;
            const std::uint64_t at = (begin + alignment - 1) & ~(alignment - 1);
            const std::uint64_t skipped = at - begin;
            if (length < skipped || length - skipped < size) continue;
            free_.erase(range);
            if (skipped > 0) free_[begin] = skipped;
            if (const std::uint64_t rest = length - skipped - size; rest > 0) free_[at + size] = rest;
            return at;
        }
        return std::nullopt;
    }

    // Gives back a place that take() returned for `size`, which becomes one with free ones beside it.
    void give(std::uint64_t offset, std::uint64_t size) {
        auto range = free_.emplace(offset, size).first;
        if (const auto next = std::next(range); next != free_.end() && offset + size == next->first) {
            range->second += next->second;
            free_.erase(next);
        }
        if (range == free_.begin()) return;
        if (const auto before = std::prev(range); before->first + before->second == offset) {
            before->second += range->second;
            free_.erase(range);
        }
    }

    bool isWhole() const { return free_.size() == 1 && free_.begin()->second == size_; } // nothing is taken

  private:
    std::uint64_t size_;
    std::map<std::uint64_t, std::uint64_t> free_; // lengths by offset; no two of them touch
};

} // namespace rt::vulkan
