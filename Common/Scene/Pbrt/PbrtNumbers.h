// The numbers of a parameter, as many as a file holds.
#pragma once
#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace rt::scene {

// Long lists, of single precision, as all numbers of pbrt are: in pieces, so that nothing is copied as they grow, and
// each can be given back as it is used.
class PbrtLongList {
  public:
    void push_back(double value) {
        if (pieces_.empty() || pieces_.back().size() == kPiece) pieces_.emplace_back().reserve(kPiece);
        constexpr double kMost = std::numeric_limits<float>::max();
        pieces_.back().push_back(static_cast<float>(std::clamp(value, -kMost, kMost)));
    }
    std::size_t size() const { return pieces_.empty() ? 0 : (pieces_.size() - 1) * kPiece + pieces_.back().size(); }

    // Hands all over, in order; nothing is left.
    template <class Take>
    void drain(const Take& take) {
        for (std::vector<float>& piece : std::exchange(pieces_, {}))
            for (const float value : std::exchange(piece, {})) take(value);
    }

  private:
    static constexpr std::size_t kPiece = std::size_t{1} << 16;
    std::vector<std::vector<float>> pieces_;
};

} // namespace rt::scene
