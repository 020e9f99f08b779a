// Large pages where the system offers them: the first touch of a small page costs several times what filling it does,
// and jumping about between many of them costs address translation.
#pragma once
#include <cstddef>

namespace rt {

inline constexpr std::size_t kLargePage = std::size_t{1} << 21;

// A wish for memory that nobody has touched yet, of which whole large pages are meant; may do nothing.
void preferLargePages(void* memory, std::size_t bytes) noexcept;

// Room for `count` elements in a vector or string, likewise.
template <class Container>
void reserveLarge(Container& container, std::size_t count) {
    container.reserve(count);
    preferLargePages(container.data(), count * sizeof(*container.data()));
}

// The same with the elements, which are values.
template <class Container>
void resizeLarge(Container& container, std::size_t count) {
    reserveLarge(container, count);
    container.resize(count);
}

} // namespace rt
