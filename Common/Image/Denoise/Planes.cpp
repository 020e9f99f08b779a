#include "Common/Image/Denoise/Planes.h"

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

#include "Common/Core/Parallel.h"
#include "Common/Core/SystemMemory.h"

namespace rt::image {

namespace {

std::size_t toLargePages(std::size_t bytes) {
    return (bytes + kLargePage - 1) / kLargePage * kLargePage;
}

// Zeros; begins with a large page and has whole ones, if it fills one.
std::shared_ptr<float> zeros(std::size_t bytes) {
    const bool isLarge = bytes >= kLargePage;
    std::size_t room = isLarge ? toLargePages(bytes) + kLargePage : std::max<std::size_t>(bytes, 1);
    const std::shared_ptr<void> memory(std::calloc(room, 1), std::free);
    if (!memory) throw std::bad_alloc();
    void* begin = memory.get();
    if (isLarge) preferLargePages(std::align(kLargePage, toLargePages(bytes), begin, room), toLargePages(bytes));
    return {memory, static_cast<float*>(begin)};
}

} // namespace

// Blocks of planes: one at first, then some at a time. It lives as long as any plane that it has given.
class Plane::Memory {
  public:
    explicit Memory(std::size_t pixels) : pixels_(pixels) {}

    float* take() {
        const std::scoped_lock lock(mutex_);
        if (free_.empty()) {
            const std::size_t count = blocks_.empty() ? 1 : kPlanesOfBlock;
            free_.reserve(free_.size() + blocks_.size() * kPlanesOfBlock + count); // giveBack() needs room for all
            blocks_.push_back(zeros(count * pixels_ * sizeof(float)));
            for (std::size_t i = count; i-- > 0;) free_.push_back(blocks_.back().get() + i * pixels_);
        }
        float* const plane = free_.back();
        free_.pop_back();
        return plane;
    }
    void giveBack(float* plane) {
        const std::scoped_lock lock(mutex_);
        free_.push_back(plane);
    }

  private:
    static constexpr std::size_t kPlanesOfBlock = 8;
    std::size_t pixels_;
    std::mutex mutex_;
    std::vector<std::shared_ptr<float>> blocks_;
    std::vector<float*> free_;
};

Plane::Plane(std::size_t width, std::size_t height) : Plane(width, height, std::make_shared<Memory>(width * height)) {}

Plane::Plane(std::size_t width, std::size_t height, std::shared_ptr<Memory> memory)
    : width_(width),
      height_(height),
      memory_(std::move(memory)),
      data_(memory_->take(), [owner = memory_](float* plane) { owner->giveBack(plane); }) {}

Plane Plane::alike() const {
    return Plane(width_, height_, memory_);
}

void addShifted(const float* values, std::ptrdiff_t shift, std::size_t width, float* __restrict sums) {
    const std::size_t distance = static_cast<std::size_t>(shift < 0 ? -shift : shift);
    if (distance >= width) return;
    const std::size_t count = width - distance;
    float* to = sums + (shift < 0 ? distance : 0);
    const float* from = values + (shift < 0 ? 0 : distance);
    for (std::size_t i = 0; i < count; ++i) to[i] += from[i];
}

namespace {

// The pixels of an image of this size, from first to last, that are at most `reach` from one in one direction.
struct InReach {
    std::size_t first, last;
    InReach(std::size_t at, std::size_t reach, std::size_t size)
        : first(at < reach ? 0 : at - reach), last(std::min(at + reach, size - 1)) {}
    std::size_t count() const { return last - first + 1; }
};

void boxMean(const Plane& plane, int reach, std::size_t y, std::vector<float>& columns, float* means) {
    const std::size_t width = plane.width(), distance = static_cast<std::size_t>(reach);
    const InReach rows(y, distance, plane.height());
    const float rowShare = 1.0f / static_cast<float>(rows.count());
    columns.assign(width, 0.0f);
    std::fill_n(means, width, 0.0f);
    for (std::size_t from = rows.first; from <= rows.last; ++from)
        addShifted(plane.row(from), 0, width, columns.data());
    for (int shift = -reach; shift <= reach; ++shift) addShifted(columns.data(), shift, width, means);
    for (std::size_t x = 0; x < width; ++x)
        means[x] = means[x] * (1.0f / static_cast<float>(InReach(x, distance, width).count())) * rowShare;
}

} // namespace

void boxMeans(std::span<Plane> planes, int reach, std::size_t threads) {
    const std::size_t height = planes.front().height();
    std::vector<Plane> means;
    for (const Plane& plane : planes) means.push_back(plane.alike());
    parallelFor(threads, height, [&](std::size_t y) {
        std::vector<float> columns;
        for (std::size_t i = 0; i < planes.size(); ++i) boxMean(planes[i], reach, y, columns, means[i].row(y));
    });
    std::move(means.begin(), means.end(), planes.begin());
}

} // namespace rt::image
