// What a device holds of a film, copied to the host.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "Common/Image/Film.h"
#include "Common/Vulkan/Buffer.h"
#include "Common/Vulkan/VulkanContext.h"
#include "Shaders/Records.h"

namespace rt::gpu {

constexpr std::size_t kTileValues = std::size_t{shared::kTilePixels} * 3; // of its pixels' channels

// Of some slots, their pixels one after the other.
struct FilmCopy {
    std::span<const shared::FilmSum> sums;
    std::span<const shared::FilmSum> squares; // empty unless kept
    std::span<const shared::vec3> open;       // empty unless reserved
};

// From what the device holds to what Film does; exact.
class StateReader {
  public:
    explicit StateReader(const FilmCopy& copy) : copy_(copy) {}
    // Of a slot, counted from the first of the copy, that has so many samples; without plan. Valid until the next call.
    image::Film::TileState read(std::size_t slot, std::uint32_t samples);

  private:
    FilmCopy copy_;
    std::vector<double> sums_;
    std::vector<double> squares_;
};

// Memory that the device writes and the host reads. It is used again, as new memory takes the driver milliseconds.
class ReadBackPool {
  public:
    explicit ReadBackPool(vulkan::VulkanContext& context) : context_(context) {}
    // At least so many bytes. They are in use until the last of the pointers has gone, which other threads may hold.
    // The pool outlives their use. Throws RenderError.
    std::shared_ptr<const vulkan::Buffer> take(VkDeviceSize bytes);

  private:
    vulkan::VulkanContext& context_;
    std::vector<std::shared_ptr<const vulkan::Buffer>> buffers_;
};

} // namespace rt::gpu
