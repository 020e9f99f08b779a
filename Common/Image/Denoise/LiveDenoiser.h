// A picture with less noise within milliseconds: docs/denoising.md.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "Common/Image/Denoise/Denoiser.h"
#include "Common/Image/Denoise/LiveKernel.h"

namespace rt::image {

// Keeps its memory from one picture to the next.
class LiveDenoiser {
  public:
    // The mean of both filtered halves. The same bits for any number of threads (0: as many as the machine has).
    // Whoever may call this thread's work off (Interruption.h) interrupts it.
    Image filter(const DenoiseInput& input, std::size_t threads = 0);

  private:
    // One channel, whose rows have a margin at both ends.
    class MarginPlane {
      public:
        void resize(std::size_t width, std::size_t height, float outside);
        float* row(std::size_t y) { return data_.data() + y * pitch_ + kLiveMargin; }
        const float* row(std::size_t y) const { return data_.data() + y * pitch_ + kLiveMargin; }
        std::size_t pitch() const { return pitch_; }

      private:
        std::size_t width_ = 0, height_ = 0, pitch_ = 0;
        std::vector<float> data_;
    };
    struct Half { // as LiveHalf
        std::array<MarginPlane, 3> radiance, tones;
        MarginPlane variance;
    };

    void load(const DenoiseInput& input, std::size_t threads);
    void loadRow(const DenoiseInput& input, std::uint32_t y);
    void loadFeatures(const DenoiseInput& input, std::uint32_t y);
    LiveRow describe(int level, std::size_t y);

    std::size_t width_ = 0, height_ = 0;
    int featureCount_ = 0;
    std::array<MarginPlane, kLiveFeatures> features_;
    std::array<std::array<Half, 2>, 2> levels_; // of even levels and of odd ones: before and after, in turn
};

} // namespace rt::image
