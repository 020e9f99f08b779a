// What the system is asked for beside memory itself. Large pages where it offers them: the first touch of a small page
// costs several times what filling it does, and jumping about between many of them costs address translation.
#pragma once
#include <cstddef>
#include <vector>

namespace rt {

inline constexpr std::size_t kLargePage = std::size_t{1} << 21;

// A wish for memory that nobody has touched yet, of which whole large pages are meant; may do nothing.
void preferLargePages(void* memory, std::size_t bytes) noexcept;

// Room for `count` elements in a vector or string, in large pages if they are many.
template <class Container>
void reserveLarge(Container& container, std::size_t count) {
    container.reserve(count);
    preferLargePages(container.data(), count * sizeof(*container.data()));
}

// As reserveLarge(), with the elements: default ones, or copies of the value.
template <class Container, class... Value>
void resizeLarge(Container& container, std::size_t count, const Value&... value) {
    reserveLarge(container, count);
    container.resize(count, value...);
}

// Has whole pages of memory that nobody has touched yet provided now: by several threads at once this takes a part of
// the time that the first touch of one thread does. May do nothing.
void providePages(void* memory, std::size_t bytes) noexcept;

// Gives back the memory of what is no longer needed: that of large scenes adds up.
template <class T>
void release(std::vector<T>& values) {
    std::vector<T>().swap(values);
}

// Gives the pages back that lie within memory whose contents nobody needs any more; may do nothing. What is in it
// afterwards is not known.
void discard(void* memory, std::size_t bytes) noexcept;

// Gives memory that was freed back to the system, where its allocator keeps that of small and middling pieces.
void releaseFreedMemory();

} // namespace rt
