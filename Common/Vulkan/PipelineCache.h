// Compiled pipelines, kept on disk from one run to the next.
#pragma once
#include <filesystem>

#include "Common/Vulkan/VulkanContext.h"

namespace rt::vulkan {

class PipelineCache {
  public:
    // Starts from `file` if it is there, undamaged and of this device and driver; otherwise empty. An empty path: not
    // on disk.
    PipelineCache(VulkanContext& context, std::filesystem::path file);
    VkPipelineCache get() const { return cache_.get(); }
    // Writes the file if the cache has grown. A cache that cannot be written is no error.
    void save();

  private:
    VulkanContext& context_;
    std::filesystem::path file_;
    Handle<VkPipelineCache> cache_;
    std::size_t savedBytes_ = 0;
};

// The place for this device's cache in the user's cache folder; empty where there is none.
std::filesystem::path pipelineCacheFile(const VulkanContext& context);

} // namespace rt::vulkan
