// What live pictures of one scene leave for each other on the device: docs/denoising.md, "Live".
#pragma once
#include <cstdint>
#include <optional>

#include "Common/Render/Settings.h"
#include "Common/Shared/Base/Types.h"
#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/VulkanContext.h"

namespace rt::gpu {

// What a picture was made of.
struct HistoryPicture {
    vulkan::Buffer planes; // shared::kHistoryPlanes
    std::uint32_t width = 0, height = 0;
    shared::Camera camera{};
    bool isMade = false;
};

// For one picture.
struct HistoryStep {
    const HistoryPicture* last = nullptr; // none: nothing is known from before
    HistoryPicture& next;
    const vulkan::Buffer& views; // the two cameras
    float samples = 0;           // that a pixel of a half is the mean of
    // Of a film without halves, whose picture is where half A is to be: the half that its first pixel belongs to.
    std::optional<std::uint32_t> firstHalfOfOne;
};

// Films have one camera each. The pictures of a film take over what the last picture of the film before has left, not
// what they leave each other, which would count samples twice.
class LiveHistory {
  public:
    explicit LiveHistory(vulkan::VulkanContext& context) : context_(context) {}

    // A film. Where settings are others, the expectation of its light may be another, too, and all is forgotten.
    void begin(const shared::Camera& camera, const app::RenderSettings& settings);
    // For another scene.
    void forget();
    bool isInUse() const { return next_->isMade || last_->isMade; } // since there was a live picture

    // For a picture of the film that has so many samples in each half, or, as one, in all. Memory is taken when it is
    // first needed.
    HistoryStep step(std::uint32_t width, std::uint32_t height, std::uint64_t samples, bool isOne);

  private:
    vulkan::VulkanContext& context_;
    vulkan::Buffer views_;
    HistoryPicture pictures_[2];
    HistoryPicture* last_ = &pictures_[0];
    HistoryPicture* next_ = &pictures_[1];
    shared::Camera camera_{};
    app::RenderSettings settings_; // but for those that change no expectation
    std::uint32_t films_ = 0;
};

} // namespace rt::gpu
