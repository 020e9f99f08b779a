// What a file of glTF may ask for.
#pragma once
#include <cstdint>
#include <string>

#include "Common/Scene/Gltf/GltfFile.h"

namespace rt::scene {

// Primitives may share arrays, each having its own copy here, and a mesh is copied for each of its poses: files that
// ask for more elements than kFree, and kPerByte for each byte, could fill any memory.
class GltfBudget {
  public:
    explicit GltfBudget(const GltfFile& file) : file_(file), left_(kFree + kPerByte * file.bytes) {}

    // Throws InputError naming `place` when the elements, together with those before, are too many.
    void spend(std::uint64_t elements, const std::string& place) {
        if (elements > left_)
            file_.fail(place, "asks for more than " + std::to_string(kFree + kPerByte * file_.bytes) +
                                  " elements, the most for a file of this size");
        left_ -= elements;
    }

  private:
    static constexpr std::uint64_t kFree = std::uint64_t{1} << 20;
    static constexpr std::uint64_t kPerByte = 64;

    const GltfFile& file_;
    std::uint64_t left_;
};

} // namespace rt::scene
