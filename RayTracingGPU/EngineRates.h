// How fast each engine is, as measured: kept in a file of the user's cache folder from one run to the next.
#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "Common/Render/Engine.h"
#include "Common/Scene/CompiledScene.h"
#include "Common/Vulkan/VulkanContext.h"

namespace rt::gpu {

// What rates hold for: this device with this driver, and scenes with the same features and about as many primitives.
std::string ratesKey(const vulkan::VulkanContext& context, const scene::CompiledScene& scene);

class EngineRates {
  public:
    // An empty path: not on disk. A file that is damaged is one that is not there.
    explicit EngineRates(std::filesystem::path file) : file_(std::move(file)) {}

    // Nothing: they have not been measured. 0 is the rate of an engine that failed.
    std::vector<app::EngineRate> find(const std::string& key) const;
    // Keeps them, unless another program was first: all are to choose alike. Returns those that hold from now on. A
    // file that cannot be written is no error.
    std::vector<app::EngineRate> keep(const std::string& key, const std::vector<app::EngineRate>& rates) const;

  private:
    std::filesystem::path file_;
};

// The place in the user's cache folder; empty where there is none.
std::filesystem::path engineRatesFile();

} // namespace rt::gpu
