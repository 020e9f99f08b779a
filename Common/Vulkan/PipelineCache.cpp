#include "Common/Vulkan/PipelineCache.h"

#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "Common/Core/AtomicFile.h"
#include "Common/Core/Hash.h"
#include "Common/Core/Log.h"
#include "Common/Core/Paths.h"
#include "Common/Core/ReadFile.h"
#include "Common/Vulkan/Create.h"

namespace rt::vulkan {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLargestFile = std::uint64_t{256} << 20;

// Whether the data begins with the header that Vulkan prescribes, of this device and driver.
bool isOfDevice(std::span<const std::byte> data, const DeviceLimits& limits) {
    VkPipelineCacheHeaderVersionOne header{};
    if (data.size() < sizeof header) return false;
    std::memcpy(&header, data.data(), sizeof header);
    return header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && header.vendorID == limits.vendor &&
           header.deviceID == limits.deviceId &&
           std::memcmp(header.pipelineCacheUUID, limits.pipelineCacheId, VK_UUID_SIZE) == 0;
}

// The file's payload behind its hash; nothing where it is absent, damaged or another device's.
std::vector<std::byte> readCache(const fs::path& file, const DeviceLimits& limits) {
    std::error_code ignored;
    if (file.empty() || !fs::is_regular_file(file, ignored)) return {};
    try {
        std::vector<std::byte> bytes = readFile(file, kLargestFile);
        std::uint64_t hash = 0;
        if (bytes.size() < sizeof hash) return {};
        std::memcpy(&hash, bytes.data(), sizeof hash);
        bytes.erase(bytes.begin(), bytes.begin() + sizeof hash);
        if (hashBytes(bytes) == hash && isOfDevice(bytes, limits)) return bytes;
    } catch (const Error&) {
    }
    return {};
}

} // namespace

PipelineCache::PipelineCache(VulkanContext& context, fs::path file) : context_(context), file_(std::move(file)) {
    const std::vector<std::byte> bytes = readCache(file_, context.limits());
    VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    info.initialDataSize = bytes.size();
    info.pInitialData = bytes.data();
    cache_ =
        create(context.device(), vkCreatePipelineCache, info, vkDestroyPipelineCache, "Creating the pipeline cache");
    savedBytes_ = bytes.size();
}

void PipelineCache::save() {
    std::size_t size = 0;
    if (file_.empty() || vkGetPipelineCacheData(context_.device(), get(), &size, nullptr) != VK_SUCCESS) return;
    if (size == savedBytes_) return;
    std::vector<std::byte> bytes(size);
    if (vkGetPipelineCacheData(context_.device(), get(), &size, bytes.data()) != VK_SUCCESS) return;
    bytes.resize(size);
    const std::uint64_t hash = hashBytes(bytes);
    try {
        fs::create_directories(file_.parent_path());
        AtomicFile out(file_);
        out.stream().write(reinterpret_cast<const char*>(&hash), sizeof hash);
        out.stream().write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        out.commit();
        savedBytes_ = size;
    } catch (const std::exception& error) {
        logDebug(std::string("the pipeline cache was not saved: ") + error.what());
    }
}

fs::path pipelineCacheFile(const VulkanContext& context) {
    const fs::path folder = userCacheFolder();
    if (folder.empty()) return {};
    constexpr char kDigits[] = "0123456789abcdef";
    std::string name = "pipelines-";
    for (const std::uint8_t byte : context.limits().pipelineCacheId) {
        name += kDigits[byte >> 4];
        name += kDigits[byte & 15];
    }
    return folder / (name + ".bin");
}

} // namespace rt::vulkan
