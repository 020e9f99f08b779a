// The pipeline cache on disk: used when it is whole and this device's, otherwise as if it were not there.
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include "Common/Core/Hash.h"
#include "Common/Vulkan/PipelineCache.h"
#include "RayTracingGPU/DeviceFilm.h"
#include "tests/TempFolder.h"
#include "tests/cross/Device.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class PipelineCacheTest : public ::testing::Test {
  protected:
    // A pipeline through the cache, which is saved.
    void use() const {
        vulkan::PipelineCache cache(device(), file_);
        const gpu::FilmPipeline reducer(device(), cache, gpu::Shader::FilmReduce, sizeof(shared::ReduceLaunch));
        cache.save();
    }
    std::string bytes() const {
        std::ifstream in(file_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void write(const std::string& content) const { std::ofstream(file_, std::ios::binary) << content; }

    TempFolder folder_;
    fs::path file_ = folder_ / "sub" / "cache.bin";
};

std::string withHash(const std::string& payload) {
    const std::uint64_t hash = hashBytes(std::as_bytes(std::span(payload)));
    std::string file(sizeof hash, '\0');
    std::memcpy(file.data(), &hash, sizeof hash);
    return file + payload;
}

TEST_F(PipelineCacheTest, IsSavedAndReadBack) {
    use();
    const std::string saved = bytes();
    EXPECT_GE(saved.size(), sizeof(std::uint64_t) + sizeof(VkPipelineCacheHeaderVersionOne));
    use();
    EXPECT_EQ(bytes(), saved);
}

// Damage, or another device's data with a valid hash, is no error: neither a crash nor a message of the validation
// layers.
TEST_F(PipelineCacheTest, DamageIsIgnored) {
    use();
    const std::string whole = bytes();
    std::string flipped = whole;
    flipped[flipped.size() / 2] = static_cast<char>(flipped[flipped.size() / 2] ^ 1);
    std::string foreign = whole.substr(sizeof(std::uint64_t));
    foreign[offsetof(VkPipelineCacheHeaderVersionOne, pipelineCacheUUID)] ^= 1;
    const std::string broken[] = {"",
                                  "x",
                                  std::string(1000, 'x'),
                                  withHash(""),
                                  withHash(std::string(1000, 'x')),
                                  withHash(foreign),
                                  whole.substr(0, whole.size() - 1),
                                  whole.substr(0, 20),
                                  flipped};
    for (const std::string& content : broken) {
        write(content);
        EXPECT_NO_THROW(use()) << content.size();
        // Written anew; not the very bytes of before, since some drivers' vary.
        EXPECT_NE(bytes(), content);
        EXPECT_GT(bytes().size(), whole.size() / 2) << content.size();
    }
    EXPECT_EQ(device().validationMessages(), 0u);
}

TEST_F(PipelineCacheTest, APlaceThatCannotBeWrittenIsNoError) {
    std::ofstream(folder_ / "sub") << "a file where a folder should be";
    EXPECT_NO_THROW(use());
}

} // namespace
} // namespace rt::test
