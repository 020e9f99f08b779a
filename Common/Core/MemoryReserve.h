// Memory kept for the way out when memory runs out. Some destructors allocate (those of nlohmann's JSON values do), and
// some libraries wait for ever after an allocation that failed between two steps: what they ask for is little, and must
// not be refused.
#pragma once

namespace rt {

// Takes the reserve, or takes it again after it was given back, where there is memory. From the first call on the
// operator new that finds no memory gives the reserve back and tries again; the next that finds none throws
// std::bad_alloc.
void keepMemoryReserve() noexcept;

// Takes it again if it was given back, and throws std::bad_alloc if it cannot: for loops whose steps are small, which
// would use all of it up and leave nothing to their destructors. Does nothing before the first keepMemoryReserve().
void requireMemoryReserve();

} // namespace rt
