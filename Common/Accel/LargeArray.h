// A fixed number of uninitialised records, on large pages where the system offers them: a ray that jumps about in a
// large tree otherwise spends much of its time on address translation.
#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <vector>

namespace rt::accel {

// `bytes` of memory, aligned to a cache line; throws std::bad_alloc.
void* allocateLarge(std::size_t bytes);
void freeLarge(void* memory, std::size_t bytes) noexcept;

template <class T>
class LargeArray {
    static_assert(std::is_trivially_destructible_v<T> && std::is_trivially_copyable_v<T>);

  public:
    LargeArray() = default;
    explicit LargeArray(std::size_t count)
        : data_(count == 0 ? nullptr : static_cast<T*>(allocateLarge(count * sizeof(T))), Free{count * sizeof(T)}),
          size_(count) {}

    explicit LargeArray(const std::vector<T>& records) : LargeArray(records.size()) {
        std::copy(records.begin(), records.end(), data());
    }

    T* data() const { return data_.get(); }
    std::size_t size() const { return size_; }
    std::size_t bytes() const { return size_ * sizeof(T); }
    T& operator[](std::size_t i) const { return data_.get()[i]; }

  private:
    struct Free {
        std::size_t bytes = 0;
        void operator()(T* memory) const noexcept { freeLarge(memory, bytes); }
    };
    std::unique_ptr<T, Free> data_;
    std::size_t size_ = 0;
};

} // namespace rt::accel
