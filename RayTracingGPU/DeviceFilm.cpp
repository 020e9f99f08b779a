#include "RayTracingGPU/DeviceFilm.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <span>

#include "Common/Core/Interruption.h"
#include "Common/Vulkan/Pipelines.h"

namespace rt::gpu {
namespace {

using image::Film;
using shared::FilmSum;
using shared::kTilePixels;
using shared::vec3;

static_assert(Film::kBlock == shared::kBlock && Film::kTile == shared::kTile && Film::kTilePixels == kTilePixels);

constexpr std::uint32_t kChunk = 1u << 14; // slots that are converted at a time

// Exact for what a StateReader returned. In vectors, because GCC 12's vectorizer gets a loop over the components wrong.
FilmSum toPair(const double* values) {
    const glm::dvec3 exact(values[0], values[1], values[2]);
    FilmSum sum;
    sum.high = vec3(exact);
    sum.low = vec3(exact - glm::dvec3(sum.high));
    return sum;
}

void appendPairs(std::span<const double> values, std::vector<FilmSum>& pairs) {
    for (std::size_t i = 0; i < values.size(); i += 3) pairs.push_back(toPair(&values[i]));
}

void appendTriples(std::span<const float> values, std::vector<vec3>& triples) {
    for (std::size_t i = 0; i < kTileValues; i += 3) {
        triples.push_back(values.empty() ? vec3(0.0f) : vec3(values[i], values[i + 1], values[i + 2]));
    }
}

} // namespace

DeviceFilm::DeviceFilm(vulkan::VulkanContext& context, const image::FilmDesc& desc, std::uint32_t tiles,
                       bool sharesPaths)
    : context_(context),
      desc_(desc),
      tilesX_((desc.width + shared::kTile - 1) / shared::kTile),
      capacity_(tiles * desc.replicates),
      sharesPaths_(sharesPaths) {
    const VkDeviceSize pixels = VkDeviceSize{capacity_} * kTilePixels;
    const auto make = [&](VkDeviceSize bytes) {
        interruptionPoint(); // a large film takes seconds, in which its user may want something else
        return vulkan::Buffer(context.memory(), bytes, 0, vulkan::Memory::Device, "the film");
    };
    samplesBuffer_ = make((VkDeviceSize{capacity_} + tiles) * sizeof(std::uint32_t));
    sums_ = make(pixels * sizeof(FilmSum));
    if (desc.secondMoments || desc.adaptive) squares_ = make(pixels * sizeof(FilmSum));
}

void DeviceFilm::reserveOpenBlocks() {
    if (open_) return;
    const VkDeviceSize bytes = VkDeviceSize{capacity_} * kTilePixels * sizeof(vec3);
    open_ = vulkan::Buffer(context_.memory(), bytes, 0, vulkan::Memory::Device, "the film");
}

void DeviceFilm::load(const Film& film, const image::TileList& tiles, std::size_t first) {
    const std::size_t count = std::min<std::size_t>(capacity_ / desc_.replicates, tiles.size() - first);
    const auto begin = tiles.begin() + static_cast<std::ptrdiff_t>(first);
    tiles_.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
    first_ = first;
    isWhole_ = count == tiles.size();
    samples_.assign(count * desc_.replicates, 0);
    stepSamples_ = 0;
    for (std::uint32_t slot = 0; slot < slotCount(); ++slot) stepSamples_ += pixelsInside(slot);
    if (film.hasPlan()) loadPlan(film);
    bool fresh = true;
    for (const std::uint32_t tile : tiles_) fresh = fresh && film.samples(tile) == 0;
    if (fresh) return clear();
    std::vector<FilmSum> sums;
    std::vector<FilmSum> squares;
    std::vector<vec3> open;
    bool anyOpen = false;
    for (std::uint32_t slot = 0; slot < slotCount(); ++slot) {
        if (slot % kChunk == 0) interruptionPoint();
        const Film::TileState state = film.state(tiles_[slot / desc_.replicates], slot % desc_.replicates);
        samples_[slot] = state.samples;
        anyOpen = anyOpen || !state.open.empty();
        appendPairs(state.sums, sums);
        appendPairs(state.squares, squares);
        appendTriples(state.open, open);
        if ((slot + 1) % kChunk != 0 && slot + 1 != slotCount()) continue;
        const VkDeviceSize firstPixel = VkDeviceSize{slot / kChunk * kChunk} * kTilePixels;
        vulkan::upload(context_, sums_, std::as_bytes(std::span(sums)), firstPixel * sizeof(FilmSum));
        vulkan::upload(context_, squares_, std::as_bytes(std::span(squares)), firstPixel * sizeof(FilmSum));
        if (anyOpen) {
            reserveOpenBlocks();
            vulkan::upload(context_, open_, std::as_bytes(std::span(open)), firstPixel * sizeof(vec3));
        }
        sums.clear();
        squares.clear();
        open.clear();
    }
    uploadCounts();
}

void DeviceFilm::uploadCounts() {
    std::vector<std::uint32_t> counts = samples_;
    for (const std::uint32_t tile : tiles_) counts.push_back(shared::packTile(tile % tilesX_, tile / tilesX_));
    vulkan::upload(context_, samplesBuffer_, std::as_bytes(std::span(counts)));
}

// Of the tiles that it holds. The pilot's squares have served.
void DeviceFilm::loadPlan(const Film& film) {
    squares_ = {};
    plan_.clear();
    for (std::uint32_t slot = 0; slot < slotCount(); ++slot) {
        if (slot % kChunk == 0) interruptionPoint();
        const auto plan = film.plan(tiles_[slot / desc_.replicates], slot % desc_.replicates);
        plan_.insert(plan_.end(), plan.begin(), plan.end());
    }
    if (!planBuffer_) {
        const VkDeviceSize bytes = VkDeviceSize{capacity_} * kTilePixels * sizeof(std::uint32_t);
        planBuffer_ = vulkan::Buffer(context_.memory(), bytes, 0, vulkan::Memory::Device, "the film");
        starts_ = vulkan::Buffer(context_.memory(), bytes, 0, vulkan::Memory::Device, "the film");
    }
    vulkan::upload(context_, planBuffer_, std::as_bytes(std::span(plan_)));
}

void DeviceFilm::clear() {
    const VkDeviceSize bytes = VkDeviceSize{slotCount()} * kTilePixels * sizeof(FilmSum);
    context_.run([&](VkCommandBuffer commands) {
        for (const vulkan::Buffer* buffer : {&sums_, &squares_}) {
            if (*buffer && bytes > 0) vkCmdFillBuffer(commands, buffer->get(), 0, bytes, 0);
        }
        vulkan::barrier(commands, vulkan::kTransferWrite, context_.bufferUses());
    });
    uploadCounts();
}

void DeviceFilm::store(Film& film) const {
    std::vector<FilmSum> sums;
    std::vector<FilmSum> squares;
    std::vector<vec3> open;
    if (open_) film.reserveOpenBlocks();
    for (std::uint32_t first = 0; first < slotCount(); first += kChunk) {
        const std::uint32_t count = std::min(kChunk, slotCount() - first);
        const VkDeviceSize firstPixel = VkDeviceSize{first} * kTilePixels;
        const auto fetch = [&](const vulkan::Buffer& from, auto& values) {
            if (!from) return;
            values.resize(std::size_t{count} * kTilePixels);
            vulkan::download(context_, from, std::as_writable_bytes(std::span(values)), firstPixel * sizeof values[0]);
        };
        fetch(sums_, sums);
        fetch(squares_, squares);
        fetch(open_, open);
        StateReader reader({sums, squares, open});
        for (std::uint32_t slot = first; slot < first + count; ++slot)
            film.assign(tiles_[slot / desc_.replicates], slot % desc_.replicates,
                        reader.read(slot - first, samples_[slot]));
    }
}

app::TilesToPack DeviceFilm::take(ReadBackPool& readBacks) const {
    const std::size_t pixels = std::size_t{slotCount()} * kTilePixels;
    const std::size_t sumBytes = pixels * sizeof(FilmSum);
    const std::size_t squareBytes = squares_ ? sumBytes : 0;
    const std::size_t openBytes = open_ ? pixels * sizeof(vec3) : 0;
    const auto memory = readBacks.take(sumBytes + squareBytes + openBytes);
    context_.run([&](VkCommandBuffer commands) {
        const auto copy = [&](const vulkan::Buffer& from, std::size_t offset, std::size_t bytes) {
            const VkBufferCopy region{0, offset, bytes};
            if (bytes > 0) vkCmdCopyBuffer(commands, from.get(), memory->get(), 1, &region);
        };
        copy(sums_, 0, sumBytes);
        copy(squares_, sumBytes, squareBytes);
        copy(open_, sumBytes + squareBytes, openBytes);
        vulkan::barrier(commands, vulkan::kTransferWrite, vulkan::kHostRead);
    });
    const std::byte* const bytes = memory->mapped<const std::byte>().data();
    const auto* const squares = reinterpret_cast<const FilmSum*>(bytes + sumBytes);
    const auto* const open = reinterpret_cast<const vec3*>(bytes + sumBytes + squareBytes);
    const FilmCopy film{{reinterpret_cast<const FilmSum*>(bytes), pixels},
                        {squares, squareBytes / sizeof(FilmSum)},
                        {open, openBytes / sizeof(vec3)}};
    return [memory, film, samples = samples_, tiles = tiles_, plan = plan_, replicates = desc_.replicates] {
        StateReader reader(film);
        const auto stateOf = [&](std::size_t slot) {
            Film::TileState state = reader.read(slot, samples[slot]);
            if (!plan.empty()) state.plan = std::span(plan).subspan(slot * kTilePixels, kTilePixels);
            return state;
        };
        const std::size_t size = samples.empty() ? 0 : image::TilePacker::packedSize(stateOf(0));
        image::TilePacker packer(samples.size() * size);
        for (std::size_t slot = 0; slot < samples.size(); ++slot)
            packer.add(tiles[slot / replicates], static_cast<std::uint32_t>(slot % replicates), stateOf(slot));
        return packer.take();
    };
}

void DeviceFilm::describe(shared::FilmLaunch& launch, std::uint32_t first, std::uint32_t width) const {
    launch.samples = samplesBuffer_.address();
    launch.plan = planBuffer_.address();
    launch.starts = starts_.address();
    launch.replicates = desc_.replicates;
    launch.filmSlots = slotCount();
    launch.bandSlots = bandSlots();
    launch.firstSlot = first;
    launch.bandWidth = width;
    launch.slotCount = width * bands();
    launch.flags = !plan_.empty()   ? shared::kIsPlanned
                   : desc_.adaptive ? shared::kKeepsSampleSquares
                   : squares_       ? shared::kKeepsBlockSquares
                                    : 0u;
    if (sharesPaths_) launch.flags |= shared::kSharesPaths;
}

shared::ReduceLaunch DeviceFilm::reductionOf(const shared::FilmLaunch& launch) const {
    return {.film = launch, .sums = sums_.address(), .squares = squares_.address(), .open = open_.address()};
}

bool DeviceFilm::isImage() const {
    return slotCount() == tilesX_ * ((desc_.height + shared::kTile - 1) / shared::kTile) * desc_.replicates;
}

std::uint32_t DeviceFilm::bandSlots() const {
    constexpr std::uint32_t kBands = 37; // a prime, so that the bands of hardly any image begin all at one column
    return isWhole() ? (slotCount() + kBands - 1) / kBands : slotCount();
}

std::uint32_t DeviceFilm::pixelsInside(std::uint32_t slot) const {
    const std::uint32_t tile = tiles_[slot / desc_.replicates];
    return std::min(shared::kTile, desc_.width - tile % tilesX_ * shared::kTile) *
           std::min(shared::kTile, desc_.height - tile / tilesX_ * shared::kTile);
}

std::uint64_t DeviceFilm::tileSamples(std::uint32_t tile) const {
    const auto first = samples_.begin() + std::ptrdiff_t{tile} * desc_.replicates;
    return std::accumulate(first, first + desc_.replicates, std::uint64_t{0});
}

// Of `count` of a slot, the samples that its pixels have and those that the launch takes them to.
template <class Count>
std::uint64_t DeviceFilm::sumOverSlots(const shared::FilmLaunch& launch, const Count& count) const {
    std::uint64_t sum = 0;
    for (std::uint32_t i = 0; i < launch.slotCount; ++i) {
        const std::uint32_t slot = shared::launchSlot(launch, i);
        if (slot >= slotCount()) continue;
        sum += count(slot, samples_[slot], shared::samplesAfter(launch, slot % launch.replicates, samples_[slot]));
    }
    return sum;
}

std::uint64_t DeviceFilm::samplesOf(const shared::FilmLaunch& launch) const {
    return sumOverSlots(launch, [this](auto... slot) { return samplesBetween(slot...); });
}

std::uint32_t DeviceFilm::numbersOf(const shared::FilmLaunch& launch) const {
    if (!hasPlan()) return shared::sampleAt(launch, launch.slotCount, 0, 0);
    return static_cast<std::uint32_t>(sumOverSlots(launch, [this](auto... slot) { return numbersBetween(slot...); }));
}

// Of the slot's pixels inside of the image, of the indices from `from` to `to`, that excluded.
std::uint64_t DeviceFilm::samplesBetween(std::uint32_t slot, std::uint32_t from, std::uint32_t to) const {
    if (plan_.empty()) return std::uint64_t{to - from} * pixelsInside(slot);
    std::uint64_t samples = 0;
    const auto first = plan_.begin() + std::ptrdiff_t{slot} * kTilePixels;
    std::for_each(first, first + kTilePixels, [&](std::uint32_t end) { samples += std::clamp(end, from, to) - from; });
    return samples;
}

// As SampleList.comp counts them: of a group that shares, each pixel has as many as any of them.
std::uint64_t DeviceFilm::numbersBetween(std::uint32_t slot, std::uint32_t from, std::uint32_t to) const {
    if (!sharesPaths_) return samplesBetween(slot, from, to);
    std::uint64_t numbers = 0;
    const std::uint32_t* const plan = &plan_[std::size_t{slot} * kTilePixels];
    for (std::uint32_t group = 0; group < kTilePixels; group += shared::kReuseGroup) {
        std::uint32_t end = 0;
        for (std::uint32_t i = group; i < group + shared::kReuseGroup; ++i)
            end = std::max(end, plan[shared::groupedPixel(i)]);
        numbers += std::uint64_t{shared::kReuseGroup} * (std::clamp(end, from, to) - from);
    }
    return numbers;
}

std::uint64_t DeviceFilm::stepSamples() const {
    if (plan_.empty()) return stepSamples_;
    std::uint64_t samples = 0;
    for (std::uint32_t slot = 0; slot < slotCount(); ++slot)
        samples += samplesBetween(slot, samples_[slot], samples_[slot] + 1);
    return std::max<std::uint64_t>(samples, 1);
}

void DeviceFilm::advance(const shared::FilmLaunch& launch) {
    for (std::uint32_t i = 0; i < launch.slotCount; ++i) {
        const std::uint32_t slot = shared::launchSlot(launch, i);
        if (slot < slotCount()) samples_[slot] = shared::samplesAfter(launch, slot % launch.replicates, samples_[slot]);
    }
}

shared::ResolveLaunch DeviceFilm::resolution() const {
    shared::ResolveLaunch launch{};
    launch.samples = samplesBuffer_.address();
    launch.sums = sums_.address();
    launch.open = open_.address();
    launch.width = desc_.width;
    launch.height = desc_.height;
    launch.replicates = desc_.replicates;
    launch.plan = planBuffer_.address();
    launch.isPlanned = plan_.empty() ? 0 : 1;
    launch.halves = plan_.empty() ? 1 : 2;
    launch.filmSlots = slotCount();
    return launch;
}

app::Snapshot DeviceFilm::snapshot(FilmResolver& resolver) const {
    app::Snapshot result{resolver.resolve(resolution()), std::vector<std::uint64_t>(tileCount())};
    for (std::uint32_t tile = 0; tile < tileCount(); ++tile) result.tileSamples[tiles_[tile]] = tileSamples(tile);
    return result;
}

std::uint64_t DeviceFilm::resolveHalves(FilmResolver& resolver, const vulkan::Buffer& to) const {
    if (!isImage() || desc_.replicates < 2) return 0;
    const std::uint64_t samples = *std::min_element(samples_.begin(), samples_.end());
    if (samples > 0) resolver.resolveHalves(resolution(), to);
    return samples * (desc_.replicates / 2);
}

std::uint64_t DeviceFilm::resolveOne(FilmResolver& resolver, const vulkan::Buffer& to) const {
    if (!isImage() || desc_.replicates > 1) return 0;
    const std::uint64_t samples = *std::min_element(samples_.begin(), samples_.end());
    if (samples > 0) resolver.resolveOne(resolution(), to);
    return samples;
}

// ---- pipelines -----------------------------------------------------------------------------------------------------

FilmPipeline::FilmPipeline(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache, Shader shader,
                           std::uint32_t pushBytes) {
    const VkDevice device = context.device();
    constexpr const char* kWhat = "Creating the film's pipeline";
    const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, pushBytes};
    layout_ = vulkan::makePipelineLayout(device, push, VK_NULL_HANDLE, kWhat);
    const auto module = vulkan::makeShaderModule(device, shaderCode(shader));
    pipeline_ = vulkan::makeComputePipeline(device, cache.get(), layout_.get(), module.get(), nullptr, kWhat);
}

void FilmPipeline::record(VkCommandBuffer commands, const void* push, std::uint32_t bytes, std::uint32_t groups) const {
    constexpr std::uint32_t kMaxGroups = 65535; // per dimension, the least that Vulkan guarantees
    const std::uint32_t columns = std::min(groups, kMaxGroups);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    vkCmdPushConstants(commands, layout_.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, bytes, push);
    vkCmdDispatch(commands, columns, (groups + columns - 1) / columns, 1);
}

FilmResolver::FilmResolver(vulkan::VulkanContext& context, const vulkan::PipelineCache& cache)
    : context_(context), pipeline_(context, cache, Shader::FilmResolve, sizeof(shared::ResolveLaunch)) {}

image::Image FilmResolver::resolve(shared::ResolveLaunch launch) {
    image::Image image(launch.width, launch.height);
    const std::size_t bytes = image.data.size() * sizeof image.data[0];
    if (pixels_.bytes() < bytes) {
        pixels_ = {};
        pixels_ = vulkan::Buffer(context_.memory(), bytes, 0, vulkan::Memory::ReadBack, "a picture");
    }
    launch.pixels = pixels_.address();
    run(launch, vulkan::kHostRead);
    std::memcpy(image.data.data(), pixels_.mapped<std::byte>().data(), bytes);
    return image;
}

void FilmResolver::resolveHalves(shared::ResolveLaunch launch, const vulkan::Buffer& to) {
    launch.pixels = to.address();
    launch.halves = 2;
    launch.apart = 1;
    run(launch, context_.bufferUses());
}

void FilmResolver::resolveOne(shared::ResolveLaunch launch, const vulkan::Buffer& to) {
    launch.pixels = to.address();
    run(launch, context_.bufferUses());
}

void FilmResolver::run(const shared::ResolveLaunch& launch, vulkan::Access uses) {
    const auto tilesIn = [](std::uint32_t pixels) { return (pixels + shared::kTile - 1) / shared::kTile; };
    context_.run([&](VkCommandBuffer commands) {
        pipeline_.run(commands, launch, tilesIn(launch.width) * tilesIn(launch.height));
        vulkan::barrier(commands, vulkan::kComputeWrite, uses);
    });
}

} // namespace rt::gpu
