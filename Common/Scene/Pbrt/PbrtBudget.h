// What a file of pbrt's may ask for.
#pragma once
#include <cstdint>
#include <string>

#include "Common/Scene/Pbrt/PbrtPlace.h"

namespace rt::scene {

// Files may include each other, be packed, and subdivide surfaces: those that ask for more elements than kFree, and
// kPerByte for each byte of their files, could fill any memory. An element is a word or number of a text, or an entry
// of a mesh.
class PbrtBudget {
  public:
    void add(std::uint64_t bytesOfFile) {
        bytes_ += bytesOfFile;
        left_ += kPerByte * bytesOfFile;
    }
    // False: these elements, together with those before, are too many.
    bool take(std::uint64_t elements) {
        if (elements > left_) return false;
        left_ -= elements;
        return true;
    }
    // Throws InputError naming `place` instead.
    void spend(std::uint64_t elements, const PbrtPlace& place) {
        if (!take(elements)) refuse(place);
    }
    [[noreturn]] void refuse(const PbrtPlace& place) const {
        place.fail("asks for more than " + std::to_string(kFree + kPerByte * bytes_) +
                   " elements, the most for files of this size");
    }

  private:
    static constexpr std::uint64_t kFree = std::uint64_t{1} << 20;
    static constexpr std::uint64_t kPerByte = 64;

    std::uint64_t bytes_ = 0;
    std::uint64_t left_ = kFree;
};

} // namespace rt::scene
