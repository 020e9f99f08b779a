// Vertices of a file that gives positions, texture coordinates and normals indices of their own.
#pragma once
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <glm/vec3.hpp>

namespace rt::scene {

// Combinations of three indices, each once, numbered in the order of their first use.
class VertexTable {
  public:
    std::uint32_t indexOf(const glm::uvec3& combination); // adds it where it is new
    const std::vector<glm::uvec3>& combinations() const { return combinations_; }

  private:
    struct Hash {
        std::size_t operator()(const glm::uvec3& v) const;
    };
    std::uint32_t append(const glm::uvec3& combination);

    std::vector<glm::uvec3> combinations_;
    // Those with one first index are chained, which is fastest as long as they are few; all further ones are hashed.
    std::vector<std::uint32_t> first_; // by first index
    std::vector<std::uint32_t> next_;  // of each combination
    std::unordered_map<glm::uvec3, std::uint32_t, Hash> further_;
};

} // namespace rt::scene
