// Shared code run on the device with arguments of its own making, to be compared with the same code on the host.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace rt::test {

using Words = std::array<std::uint32_t, 4>;

struct Probe {
    std::span<const std::uint32_t> shader;
    // Values of its constant 0, one pipeline each: compilers of drivers do not take all of the shared code in one.
    std::vector<std::uint32_t> families;
    std::uint32_t parts;  // in the second dimension of the groups; each family answers for those that are its own
    std::uint32_t count;  // of answers in a part
    bool isPruned = true; // as the program's own shaders are
};

// parts * count answers of the test's device, those of a part together.
std::vector<Words> answersOf(const Probe& probe);

} // namespace rt::test
