#include "RayTracingGPU/DeviceDenoiser.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "Common/Image/Denoise/DenoiseFilter.h"
#include "Common/Image/Metrics.h"
#include "Common/Shared/Denoise/DenoiseChoice.h"
#include "Common/Shared/Denoise/DenoiseMix.h"
#include "Common/Vulkan/Barrier.h"
#include "Common/Vulkan/Pipelines.h"
#include "Common/Vulkan/StagingRing.h"
#include "RayTracingGPU/EmbeddedShaders.h"

namespace rt::gpu {
namespace {

using shared::DenoiseLaunch;
using shared::DepthLaunch;
using shared::HistoryLaunch;
using shared::kDenoiseBandwidths;
using shared::LiveLaunch;

static_assert(shared::kDenoiseRelativeFloor == static_cast<float>(image::kRelativeFloor));
static_assert(shared::kDenoiseCell % shared::kDenoiseColumns == 0 && shared::kDenoiseCell % shared::kDenoiseRows == 0,
              "cells are whole work groups");
static_assert(image::kDenoiseCandidates <= 4, "a pixel of a plane has all candidates");

constexpr std::size_t kFourFloats = 4 * sizeof(float), kThreeFloats = 3 * sizeof(float);

constexpr std::uint32_t groupsFor(std::uint32_t size, int groupSize) {
    return (size + static_cast<std::uint32_t>(groupSize) - 1) / static_cast<std::uint32_t>(groupSize);
}

Shader shaderOf(DenoisePass pass) {
    switch (pass) {
        case DenoisePass::Depths:
            return Shader::DenoiseDepths;
        case DenoisePass::Prepare:
            return Shader::DenoisePrepare;
        case DenoisePass::Mean:
            return Shader::DenoiseMean;
        case DenoisePass::Guide:
            return Shader::DenoiseGuide;
        case DenoisePass::Features:
            return Shader::DenoiseFeatures;
        case DenoisePass::Fit:
            return Shader::DenoiseFit;
        case DenoisePass::Errors:
            return Shader::DenoiseErrors;
        case DenoisePass::Choice:
            return Shader::DenoiseChoice;
        case DenoisePass::Mix:
            return Shader::DenoiseMix;
        case DenoisePass::Blend:
            return Shader::DenoiseBlend;
        case DenoisePass::Coarse:
            return Shader::DenoiseCoarse;
        case DenoisePass::GiveBack:
            return Shader::DenoiseGiveBack;
        case DenoisePass::History:
            return Shader::DenoiseHistory;
        case DenoisePass::HistoryMerge:
            return Shader::DenoiseHistoryMerge;
        case DenoisePass::LivePrepare:
            return Shader::DenoiseLivePrepare;
        case DenoisePass::Live:
            break;
    }
    return Shader::DenoiseLive;
}

} // namespace

// ---- pipelines -----------------------------------------------------------------------------------------------------

DenoisePipelines::DenoisePipelines(vulkan::VulkanContext& context, vulkan::PipelineCache& cache)
    : context_(context), cache_(cache) {
    constexpr std::size_t kBytes =
        std::max({sizeof(DenoiseLaunch), sizeof(HistoryLaunch), sizeof(LiveLaunch), sizeof(DepthLaunch)});
    const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, kBytes};
    layout_ = vulkan::makePipelineLayout(context.device(), push, VK_NULL_HANDLE, kWhat);
}

const DenoisePipelines::Pipelines& DenoisePipelines::of(DenoisePass pass) {
    Pipelines& pipelines = pipelines_[static_cast<std::size_t>(pass)];
    if (!pipelines.empty()) return pipelines;
    const auto module = vulkan::makeShaderModule(context_.device(), shaderCode(shaderOf(pass)));
    const auto make = [&](const VkSpecializationInfo* constants) {
        return vulkan::makeComputePipeline(context_.device(), cache_.get(), layout_.get(), module.get(), constants,
                                           kWhat);
    };
    Pipelines made;
    if (pass != DenoisePass::Fit) made.push_back(make(nullptr));
    for (std::int32_t features = 3; pass == DenoisePass::Fit && features <= shared::kDenoiseFeatures; ++features) {
        const VkSpecializationMapEntry entry{0, 0, sizeof features};
        const VkSpecializationInfo constants{1, &entry, sizeof features, &features};
        made.push_back(make(&constants));
    }
    cache_.save();
    return pipelines = std::move(made);
}

void DenoisePipelines::record(VkCommandBuffer commands, DenoisePass pass, const void* launch, std::uint32_t bytes,
                              const VkExtent3D& groups) {
    vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, bytes, launch);
    for (const auto& pipeline : of(pass)) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
        vkCmdDispatch(commands, groups.width, groups.height, groups.depth);
    }
}

// ---- memory --------------------------------------------------------------------------------------------------------

DeviceDenoiser::DeviceDenoiser(vulkan::VulkanContext& context, DenoisePipelines& pipelines, std::uint32_t width,
                               std::uint32_t height)
    : context_(context),
      pipelines_(pipelines),
      width_(width),
      height_(height),
      pixels_(std::size_t{width} * height),
      size_(context.info().isSoftware(), 1) {
    const auto make = [&](std::size_t bytes) {
        return vulkan::Buffer(context.memory(), bytes, 0, vulkan::Memory::Device, "the denoiser");
    };
    const std::size_t bordered = static_cast<std::size_t>(shared::denoisePitch(width)) *
                                 static_cast<std::size_t>(shared::denoisePlaneRows(height));
    const std::size_t tiles =
        std::size_t{groupsFor(width, shared::kDenoiseTile)} * groupsFor(height, shared::kDenoiseTile);
    const std::size_t inReach = tiles * shared::kDenoiseTileReach * shared::kDenoiseTileReach;
    halves_ = make(2 * pixels_ * kThreeFloats);
    surfaces_ = make(pixels_ * shared::kSurfaceValues * sizeof(float));
    radiance_ = make(2 * bordered * kFourFloats);
    guides_ = make(2 * bordered * kFourFloats);
    features_ = make(std::max(inReach * kFourFloats, 3 * pixels_ * kThreeFloats));
    axes_ = make(tiles * sizeof(std::uint32_t));
    filtered_ = make(2 * std::max(bordered, kDenoiseBandwidths * pixels_) * kFourFloats);
    values_ = make(pixels_ * kFourFloats);
    means_ = make(pixels_ * kFourFloats);
    kept_ = make(2 * pixels_ * sizeof(float));
    depthCounts_ = make(shared::kDepthDigits * sizeof(std::uint32_t));
    sums_ = make(groupCount() * (shared::kDenoiseSums + shared::kDenoiseMixSums) * sizeof(float));
}

void DeviceDenoiser::setSurfaces(const image::Image& albedo, const image::Image& normal, const image::Image& depth) {
    usualDepth_ = image::usualDepth(depth);
    std::vector<float> values(pixels_ * shared::kSurfaceValues);
    const auto copy = [&](const image::Image& from, std::size_t first) {
        if (from.data.empty()) return;
        for (std::size_t i = 0; i < pixels_; ++i)
            std::copy_n(&from.data[i * from.channels], from.channels, &values[i * shared::kSurfaceValues + first]);
    };
    copy(albedo, 0);
    copy(normal, 3);
    copy(depth, 6);
    vulkan::upload(context_, surfaces_, std::as_bytes(std::span(values)));
}

void DeviceDenoiser::setHalves(const image::Image& a, const image::Image& b) {
    vulkan::upload(context_, halves_, std::as_bytes(std::span(a.data)));
    vulkan::upload(context_, halves_, std::as_bytes(std::span(b.data)), pixels_ * kThreeFloats);
}

float DeviceDenoiser::usualDepth() {
    if (!usualDepth_) usualDepth_ = findUsualDepth();
    return *usualDepth_;
}

// As image::usualDepth() has it, digit by digit: 1 kB of each comes to the host instead of all depths.
float DeviceDenoiser::findUsualDepth() {
    constexpr std::uint32_t kPixelsOfLane = 16, kBitsOfDigit = 8;
    DepthLaunch launch{};
    launch.surfaces = surfaces_.address();
    launch.counts = depthCounts_.address();
    launch.pixels = static_cast<std::uint32_t>(pixels_);
    std::array<std::uint32_t, shared::kDepthDigits> counts;
    std::uint64_t rank = 0; // of the one that is looked for, of those that are counted
    for (launch.shift = 32; launch.shift > 0;) {
        launch.shift -= kBitsOfDigit;
        counts.fill(0);
        vulkan::upload(context_, depthCounts_, std::as_bytes(std::span(counts)));
        runPass(DenoisePass::Depths, launch, {groupsFor(launch.pixels, kPixelsOfLane * shared::kDepthDigits), 1, 1});
        vulkan::download(context_, depthCounts_, std::as_writable_bytes(std::span(counts)));
        if (launch.mask == 0) {
            const std::uint64_t all = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
            if (all == 0) return 1;
            rank = image::usualRank(all);
        }
        std::uint32_t digit = 0;
        for (; rank >= counts[digit]; ++digit) rank -= counts[digit];
        launch.known |= digit << launch.shift;
        launch.mask |= (shared::kDepthDigits - 1) << launch.shift;
    }
    return std::bit_cast<float>(launch.known);
}

// ---- filtering -----------------------------------------------------------------------------------------------------

VkExtent3D DeviceDenoiser::groups() const {
    return {groupsFor(width_, shared::kDenoiseColumns), groupsFor(height_, shared::kDenoiseRows), 1};
}

std::size_t DeviceDenoiser::groupCount() const {
    return std::size_t{groups().width} * groups().height;
}

template <class Launch>
void DeviceDenoiser::runPass(DenoisePass pass, const Launch& launch, const VkExtent3D& groups) {
    passSeconds_[static_cast<std::size_t>(pass)] += context_.runTimed([&](VkCommandBuffer commands) {
        pipelines_.run(commands, pass, launch, groups);
        vulkan::barrier(commands, vulkan::kComputeWrite, context_.bufferUses());
    });
}

DenoiseLaunch DeviceDenoiser::makeLaunch() const {
    DenoiseLaunch launch{};
    launch.halves = halves_.address();
    launch.surfaces = surfaces_.address();
    launch.radiance = radiance_.address();
    launch.guides = guides_.address();
    launch.features = launch.pictures = features_.address();
    launch.axes = axes_.address();
    launch.filtered = filtered_.address();
    launch.values = values_.address();
    launch.means = means_.address();
    launch.kept = kept_.address();
    launch.sums = sums_.address();
    launch.width = width_;
    launch.height = height_;
    return launch;
}

// Some rows of work groups at a time.
bool DeviceDenoiser::fit(DenoiseLaunch launch, const std::atomic<bool>* cancel) {
    const VkExtent3D all = groups();
    const std::uint64_t rowPixels = std::uint64_t{width_} * shared::kDenoiseRows;
    const double& seconds = passSeconds_[static_cast<std::size_t>(DenoisePass::Fit)];
    while (launch.firstRow < all.height) {
        if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) return false;
        const std::uint64_t suggested = std::max<std::uint64_t>(1, size_.suggest() / rowPixels);
        const auto rows = static_cast<std::uint32_t>(std::min<std::uint64_t>(suggested, all.height - launch.firstRow));
        const double before = seconds;
        runPass(DenoisePass::Fit, launch, {all.width, rows, 2});
        size_.measured(rows * rowPixels, seconds - before);
        launch.firstRow += rows;
    }
    return true;
}

bool DeviceDenoiser::run(std::uint64_t samplesOfHalf, std::uint32_t dependentSide, const std::atomic<bool>* cancel) {
    passSeconds_ = {};
    DenoiseLaunch launch = makeLaunch();
    launch.usualDepth = usualDepth();
    launch.candidates = kDenoiseBandwidths + (samplesOfHalf >= shared::kDenoiseRawSamples ? 1 : 0);
    launch.mixed = samplesOfHalf >= shared::kDenoiseMixSamples ? 1 : 0;
    launch.dependentSide = dependentSide;
    const bool hasRawGuides = samplesOfHalf >= shared::kDenoiseRawGuideSamples;
    launch.use = hasRawGuides ? shared::kMeansToGuides : shared::kMeansOfTones;
    const auto pitch = static_cast<std::uint32_t>(shared::denoisePitch(width_));
    const auto rows = static_cast<std::uint32_t>(shared::denoisePlaneRows(height_));
    runPass(DenoisePass::Prepare, launch,
            {groupsFor(pitch, shared::kDenoiseColumns), groupsFor(rows, shared::kDenoiseRows), 1});
    runPass(DenoisePass::Mean, launch, groups());
    if (!hasRawGuides) runPass(DenoisePass::Guide, launch, {groups().width, groups().height, 2});
    runPass(DenoisePass::Features, launch,
            {groupsFor(width_, shared::kDenoiseTile), groupsFor(height_, shared::kDenoiseTile), 1});
    if (!fit(launch, cancel)) return false;
    for (const DenoisePass pass : {DenoisePass::Errors, DenoisePass::Choice, DenoisePass::Mix, DenoisePass::Blend})
        runPass(pass, launch, groups());
    if (samplesOfHalf >= shared::kDenoiseCoarseSamples)
        for (const DenoisePass pass : {DenoisePass::Coarse, DenoisePass::GiveBack}) runPass(pass, launch, groups());
    readSums(dependentSide);
    return true;
}

// ---- results -------------------------------------------------------------------------------------------------------

void DeviceDenoiser::readSums(std::uint32_t dependentSide) {
    std::vector<float> groups(groupCount() * shared::kDenoiseSums);
    vulkan::download(context_, sums_, std::as_writable_bytes(std::span(groups)));
    image::DenoiseErrorSums sums;
    shares_ = {};
    for (std::size_t i = 0; i < groups.size(); i += shared::kDenoiseSums) {
        sums += {groups[i], groups[i + 1], groups[i + 2]};
        for (std::size_t c = 0; c < shares_.size(); ++c)
            shares_[c] += static_cast<double>(groups[i + 4 + c]) / static_cast<double>(pixels_);
    }
    relmse_ = image::denoisedRelMse(sums, pixels_, dependentSide);
}

image::Image DeviceDenoiser::read(const vulkan::Buffer& from, std::uint32_t channels, VkDeviceSize firstByte) const {
    image::Image image(width_, height_, channels);
    vulkan::download(context_, from, std::as_writable_bytes(std::span(image.data)), firstByte);
    return image;
}

image::Denoised DeviceDenoiser::read(bool details) {
    image::Denoised result;
    result.relmse = relmse_;
    result.shares = shares_;
    result.picture = read(features_, 3, 0);
    if (!details) return result;
    result.halfA = read(features_, 3, pixels_ * kThreeFloats);
    result.halfB = read(features_, 3, 2 * pixels_ * kThreeFloats);
    result.bandwidth = read(kept_, 1, 0);
    DenoiseLaunch launch = makeLaunch();
    launch.use = shared::kMeansPositive;
    runPass(DenoisePass::Mean, launch, groups());
    const image::Image errors = read(means_, 4, 0);
    result.error = image::Image(width_, height_);
    for (std::size_t i = 0; i < pixels_; ++i) std::copy_n(&errors.data[4 * i], 3, &result.error.data[3 * i]);
    return result;
}

} // namespace rt::gpu
