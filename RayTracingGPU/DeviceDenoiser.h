// The denoiser on the device: the filters of image::denoise() and image::LiveDenoiser, by compute shaders.
// docs/denoising.md has both.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <vulkan/vulkan.h>

#include "Common/Image/Denoise/Denoiser.h"
#include "Common/Image/Image.h"
#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/Handle.h"
#include "Common/Vulkan/PipelineCache.h"
#include "Common/Vulkan/VulkanContext.h"
#include "RayTracingGPU/Launches.h"
#include "Shaders/DenoiseRecords.h"

namespace rt::gpu {

struct HistoryStep;

// In their order, but for means, which are taken of what several of them write. The last four are those of live
// quality, of which Live has the time of all; HistoryMerge that of the history where only that is made.
enum class DenoisePass {
    Depths,
    Prepare,
    Mean,
    Guide,
    Features,
    Fit,
    Errors,
    Choice,
    Mix,
    Blend,
    Coarse,
    GiveBack,
    History,
    HistoryMerge,
    LivePrepare,
    Live
};
inline constexpr std::size_t kDenoisePasses = 16;
inline constexpr std::array<const char*, kDenoisePasses> kDenoisePassNames{
    "depths", "prepare", "mean",   "guide",     "features", "fit",           "errors",       "choice",
    "mix",    "blend",   "coarse", "give_back", "history",  "history_merge", "live_prepare", "live"};

// The compiled shaders, for pictures of any size. Each is compiled when it is first needed.
class DenoisePipelines {
  public:
    // Both must outlive it.
    DenoisePipelines(vulkan::VulkanContext& context, vulkan::PipelineCache& cache);

    // `Launch` is that of the pass.
    template <class Launch>
    void run(VkCommandBuffer commands, DenoisePass pass, const Launch& launch, const VkExtent3D& groups) {
        static_assert(sizeof launch <= 128, "Vulkan guarantees 128 bytes");
        record(commands, pass, &launch, sizeof launch, groups);
    }

  private:
    static constexpr const char* kWhat = "Creating the denoiser's pipelines";
    using Pipelines = std::vector<vulkan::Handle<VkPipeline>>; // of Fit one for each number of features
    const Pipelines& of(DenoisePass pass);
    void record(VkCommandBuffer commands, DenoisePass pass, const void* launch, std::uint32_t bytes,
                const VkExtent3D& groups);

    vulkan::VulkanContext& context_;
    vulkan::PipelineCache& cache_;
    vulkan::Handle<VkPipelineLayout> layout_;
    std::array<Pipelines, kDenoisePasses> pipelines_;
};

// What a picture is filtered with. All memory is taken when it is made.
class DeviceDenoiser {
  public:
    // For pictures of this size. Both must outlive it.
    DeviceDenoiser(vulkan::VulkanContext& context, DenoisePipelines& pipelines, std::uint32_t width,
                   std::uint32_t height);

    // Of the surface in sight; without pixels where they are not known.
    void setSurfaces(const image::Image& albedo, const image::Image& normal, const image::Image& depth);
    // Where they are, kSurfaceValues of each pixel, and to be called when they have been made there.
    const vulkan::Buffer& surfaces() const { return surfaces_; }
    void surfacesChanged() { usualDepth_.reset(); }
    // Where the halves of the picture are to be: radiance as three floats a pixel, row by row, one after the other. A
    // run may use the memory for something else.
    const vulkan::Buffer& halves() const { return halves_; }
    void setHalves(const image::Image& a, const image::Image& b);

    // Filters the halves by final quality, in launches as short as a window needs them. False: cancelled.
    bool run(std::uint64_t samplesOfHalf, std::uint32_t dependentSide, const std::atomic<bool>* cancel = nullptr);
    // What it made; the picture alone, or all details.
    image::Denoised read(bool details);
    // Filters the halves by live quality, in one launch, and what that made. With a history, they take over what the
    // picture before has left, and leave what they have.
    void runLive(const HistoryStep* history = nullptr);
    image::Image readLive() const;
    // Halves whose picture is of final quality leave the same. To be called when that has been read.
    void remember(const HistoryStep& history);

    // Of the device, in the last run.
    std::span<const double, kDenoisePasses> passSeconds() const { return passSeconds_; }

  private:
    VkExtent3D groups() const; // of the image
    std::size_t groupCount() const;
    template <class Launch>
    void runPass(DenoisePass pass, const Launch& launch, const VkExtent3D& groups);
    shared::DenoiseLaunch makeLaunch() const;
    float usualDepth();
    float findUsualDepth();
    bool fit(shared::DenoiseLaunch launch, const std::atomic<bool>* cancel);
    void readSums(std::uint32_t dependentSide);
    void recordHistory(VkCommandBuffer commands, const HistoryStep& step);
    void recordLive(VkCommandBuffer commands, VkDeviceAddress halves);
    VkDeviceAddress mergedAddress() const;
    image::Image read(const vulkan::Buffer& from, std::uint32_t channels, VkDeviceSize firstByte) const;

    vulkan::VulkanContext& context_;
    DenoisePipelines& pipelines_;
    std::uint32_t width_, height_;
    std::size_t pixels_;
    LaunchSize size_;
    vulkan::Buffer halves_; // and, when these have served, the picture of live quality
    vulkan::Buffer surfaces_, radiance_, guides_, axes_, filtered_, values_, means_, kept_, sums_, depthCounts_;
    vulkan::Buffer features_;         // and, when these have served, the pictures of final quality
    std::optional<float> usualDepth_; // of the surfaces, once it was needed
    image::RelMseEstimate relmse_{};
    std::array<double, image::kDenoiseCandidates> shares_{};
    std::array<double, kDenoisePasses> passSeconds_{};
};

} // namespace rt::gpu
