// The part of a film that is on the device: the sums of some tiles; and what is done with them there.
#pragma once
#include <cstdint>
#include <vector>

#include "Common/Image/Film.h"
#include "Common/Image/FilmTiles.h"
#include "Common/Render/Engine.h"
#include "Common/Vulkan/PipelineCache.h"
#include "Common/Vulkan/StagingRing.h"
#include "RayTracingGPU/EmbeddedShaders.h"
#include "RayTracingGPU/FilmCopy.h"
#include "Shaders/Records.h"

namespace rt::gpu {

// A compute pipeline with a group for each of some slots or tiles.
class FilmPipeline {
  public:
    // `pushBytes` is the size of its push constants.
    FilmPipeline(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache, Shader shader,
                 std::uint32_t pushBytes);
    template <class Push>
    void run(VkCommandBuffer commands, const Push& push, std::uint32_t groups) const {
        static_assert(sizeof(Push) <= 128, "Vulkan guarantees 128 bytes");
        record(commands, &push, sizeof push, groups);
    }

  private:
    void record(VkCommandBuffer commands, const void* push, std::uint32_t bytes, std::uint32_t groups) const;

    vulkan::Handle<VkPipelineLayout> layout_;
    vulkan::Handle<VkPipeline> pipeline_;
};

// Makes pictures of films.
class FilmResolver {
  public:
    FilmResolver(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache);
    // launch.pixels need not be set.
    image::Image resolve(shared::ResolveLaunch launch);
    // Both halves, to the buffer; likewise.
    void resolveHalves(shared::ResolveLaunch launch, const vulkan::Buffer& to);
    // The picture, to the buffer; likewise.
    void resolveOne(shared::ResolveLaunch launch, const vulkan::Buffer& to);

  private:
    void run(const shared::ResolveLaunch& launch, vulkan::Access uses);

    vulkan::VulkanContext& context_;
    FilmPipeline pipeline_;
    vulkan::Buffer pixels_; // of the host, of the largest so far
};

// A slot is a tile in one replicate; slots are counted from the first tile on the device.
class DeviceFilm {
  public:
    // Room for `tiles` tiles of such a film, not initialised: load() comes first. `sharesPaths` where groups of pixels
    // share their paths. Both throw Interrupted where the thread's work is called off (Interruption.h); load() may come
    // again then.
    DeviceFilm(vulkan::VulkanContext& context, const image::FilmDesc& desc, std::uint32_t tiles, bool sharesPaths);

    // Whether it can hold `tiles` tiles of the film; one that has followed a plan cannot hold a pilot again.
    bool fits(const image::Film& film, std::uint32_t tiles, bool sharesPaths) const {
        return film.desc() == desc_ && tiles * desc_.replicates <= capacity_ && (plan_.empty() || film.hasPlan()) &&
               sharesPaths == sharesPaths_;
    }
    // Replaces the contents by as many of these tiles of the film as there is room for, from position `first` on.
    void load(const image::Film& film, const image::TileList& tiles, std::size_t first);
    // Copies the contents into the film.
    void store(image::Film& film) const;
    // Copies the contents, of some tiles at least, to the host.
    app::TilesToPack take(ReadBackPool& readBacks) const;
    // What Film::resolve() would return, and the samples of each tile; isImage() is required.
    app::Snapshot snapshot(FilmResolver& resolver) const;
    // The mean of each half of its samples, as two pictures of three floats a pixel. Returns how many samples of each
    // half a pixel has, at least; 0: it has not both halves everywhere, and nothing was written.
    std::uint64_t resolveHalves(FilmResolver& resolver, const vulkan::Buffer& to) const;
    // The mean of all samples of a film of one replicate, and how many a pixel has at least; likewise.
    std::uint64_t resolveOne(FilmResolver& resolver, const vulkan::Buffer& to) const;
    // Makes room for blocks that stay open.
    void reserveOpenBlocks();

    std::size_t first() const { return first_; }
    std::uint32_t replicates() const { return desc_.replicates; }
    std::uint32_t slotCount() const { return static_cast<std::uint32_t>(samples_.size()); }
    bool isWhole() const { return isWhole_; } // it holds all tiles that there were to load
    bool isImage() const;                     // it holds all tiles of the image
    // Of a step, which is one sample of every slot for each of its pixels inside of the image; with a plan, of the step
    // that comes next, for the pixels that are not done.
    std::uint64_t stepSamples() const;
    bool hasPlan() const { return !plan_.empty(); }
    // The slots are cut into bands. A launch takes `width` slots of each, from `first` < bandSlots() on.
    std::uint32_t bands() const { return (slotCount() + bandSlots() - 1) / bandSlots(); }
    std::uint32_t bandSlots() const; // the last band may lack some
    // Of a step of one slot in each band, pixels outside of the image included.
    std::uint64_t columnSamples() const { return std::uint64_t{bands()} * shared::kTilePixels; }
    // Fills in what such a launch needs to know of the film, but for FilmLaunch::sampleCount.
    void describe(shared::FilmLaunch& launch, std::uint32_t first, std::uint32_t width) const;
    // FilmLaunch::sampleCount of such a launch, if it came now.
    std::uint32_t numbersOf(const shared::FilmLaunch& launch) const;
    // Samples that such a launch would add now, of pixels inside of the image.
    std::uint64_t samplesOf(const shared::FilmLaunch& launch) const;
    // The reduction of such a launch.
    shared::ReduceLaunch reductionOf(const shared::FilmLaunch& launch) const;
    // To be called when a launch adds its samples.
    void advance(const shared::FilmLaunch& launch);

  private:
    shared::ResolveLaunch resolution() const;
    void clear();
    void uploadCounts();
    void loadPlan(const image::Film& film);
    std::uint32_t tileCount() const { return static_cast<std::uint32_t>(tiles_.size()); } // that it holds
    std::uint64_t tileSamples(std::uint32_t tile) const; // counted from the first tile; all replicates
    std::uint32_t pixelsInside(std::uint32_t slot) const;
    std::uint64_t samplesBetween(std::uint32_t slot, std::uint32_t from, std::uint32_t to) const;
    std::uint64_t numbersBetween(std::uint32_t slot, std::uint32_t from, std::uint32_t to) const;
    template <class Count>
    std::uint64_t sumOverSlots(const shared::FilmLaunch& launch, const Count& count) const;

    vulkan::VulkanContext& context_;
    image::FilmDesc desc_;
    std::uint32_t tilesX_;
    image::TileList tiles_; // of the image
    std::size_t first_ = 0; // position of the first in what there was to load
    bool isWhole_ = false;
    std::uint32_t capacity_;             // slots
    std::vector<std::uint32_t> samples_; // per slot, as on the device
    std::uint64_t stepSamples_ = 0;      // without a plan
    std::vector<std::uint32_t> plan_;    // per pixel, 0 outside of the image, as on the device; empty without one
    bool sharesPaths_;                   // groups of pixels, whose samples are numbered together where there is a plan
    vulkan::Buffer samplesBuffer_;       // and the tiles, as FilmLaunch::samples
    vulkan::Buffer sums_;
    vulkan::Buffer squares_; // empty unless kept
    vulkan::Buffer open_;    // empty until reserved
    vulkan::Buffer planBuffer_;
    vulkan::Buffer starts_; // as FilmLaunch::starts
};

} // namespace rt::gpu
