// Memory from a few blocks, and the way of data to and from it.
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/StagingRing.h"
#include "tests/cross/Device.h"

namespace rt::vulkan {
namespace {

std::vector<std::uint32_t> numbers(std::size_t count, std::uint32_t first) {
    std::vector<std::uint32_t> values(count);
    std::iota(values.begin(), values.end(), first);
    return values;
}

std::vector<std::uint32_t> contents(VulkanContext& context, const Buffer& buffer) {
    std::vector<std::uint32_t> values(buffer.bytes() / sizeof(std::uint32_t));
    download(context, buffer, std::as_writable_bytes(std::span(values)));
    return values;
}

TEST(MemoryTest, ManyBuffersShareABlockAndDoNotOverlap) {
    VulkanContext& context = test::device();
    const std::size_t blocks = context.memory().blockCount();
    const VkDeviceSize bytes = context.memory().deviceBytes();
    {
        constexpr std::uint32_t kBuffers = 60;
        std::vector<Buffer> buffers;
        for (std::uint32_t i = 0; i < kBuffers; ++i) {
            buffers.push_back(deviceArray<std::uint32_t>(context, numbers(1 + i % 100, 1000 * i), "a test"));
        }
        EXPECT_LE(context.memory().blockCount(), blocks + 1);
        EXPECT_GT(context.memory().deviceBytes(), bytes);
        for (std::uint32_t i = 0; i < kBuffers; ++i) {
            EXPECT_EQ(contents(context, buffers[i]), numbers(1 + i % 100, 1000 * i)) << i;
        }
    }
    EXPECT_LE(context.memory().blockCount(), blocks);
    EXPECT_EQ(context.memory().deviceBytes(), bytes);
}

TEST(MemoryTest, LargeBuffersHaveMemoryOfTheirOwnWhichEndsWithThem) {
    VulkanContext& context = test::device();
    const std::size_t blocks = context.memory().blockCount();
    {
        const Buffer large(context.memory(), VkDeviceSize{65} << 20, 0, Memory::Device, "a test");
        const Buffer another(context.memory(), VkDeviceSize{65} << 20, 0, Memory::Upload, "a test");
        EXPECT_EQ(context.memory().blockCount(), blocks + 2);
    }
    EXPECT_EQ(context.memory().blockCount(), blocks);
}

TEST(MemoryTest, AddressesAreAsAlignedAsAsked) {
    VulkanContext& context = test::device();
    std::vector<Buffer> buffers;
    for (VkDeviceSize alignment = 1; alignment <= 4096; alignment *= 2) {
        buffers.emplace_back(context.memory(), 4, 0, Memory::Device, "a test", alignment);
        EXPECT_EQ(buffers.back().address() % alignment, 0u);
    }
}

TEST(MemoryTest, MappedMemoryIsThatOfTheBuffer) {
    VulkanContext& context = test::device();
    const Buffer first(context.memory(), 400, 0, Memory::Upload, "a test");
    const Buffer second(context.memory(), 400, 0, Memory::Upload, "a test");
    const auto fill = [](const Buffer& buffer, std::uint32_t from) {
        const std::span<std::uint32_t> values = buffer.mapped<std::uint32_t>();
        ASSERT_EQ(values.size(), 100u);
        std::iota(values.begin(), values.end(), from);
    };
    fill(first, 5);
    fill(second, 1000);
    EXPECT_EQ(contents(context, first), numbers(100, 5));
    EXPECT_EQ(contents(context, second), numbers(100, 1000));
}

// More than the ring holds, and at an offset.
TEST(MemoryTest, UploadsOfAnySizeArriveWhole) {
    VulkanContext& context = test::device();
    constexpr std::size_t kCount = (std::size_t{45} << 18) + 3; // 45 MiB and some
    const std::vector<std::uint32_t> values = numbers(kCount, 7);
    const Buffer buffer(context.memory(), (kCount + 1) * sizeof(std::uint32_t), 0, Memory::Device, "a test");
    const std::uint32_t before = 99;
    upload(context, buffer, std::as_bytes(std::span(&before, 1)));
    upload(context, buffer, std::as_bytes(std::span(values)), sizeof before);
    std::vector<std::uint32_t> expected{before};
    expected.insert(expected.end(), values.begin(), values.end());
    EXPECT_EQ(contents(context, buffer), expected);
}

// ---- failure -------------------------------------------------------------------------------------------------------

class FaultyContext : public VulkanContext {
  public:
    FaultyContext() : VulkanContext({"", true}) {}
    int failingSubmit = 0; // the number of the submission from now on that fails; 0: none does
    VkResult waiting = VK_SUCCESS;
    int submissions = 0;

  protected:
    void submit(VkCommandBuffer commands, VkFence fence) override {
        ++submissions;
        if (failingSubmit > 0 && --failingSubmit == 0) throw RenderError("out of memory");
        VulkanContext::submit(commands, fence);
    }
    VkResult wait(VkFence fence, std::uint64_t nanoseconds) override {
        const VkResult result = VulkanContext::wait(fence, nanoseconds);
        return waiting == VK_SUCCESS ? result : waiting;
    }
};

// Nothing is copied to a buffer that may be gone, and the ring can be used again.
TEST(MemoryTest, AnUploadThatFailsOnItsWayLeavesNothingBehind) {
    FaultyContext context;
    const std::vector<std::uint32_t> values = numbers(std::size_t{20} << 18, 1);
    context.failingSubmit = 3;
    EXPECT_THROW(deviceArray<std::uint32_t>(context, values, "a test"), RenderError);
    EXPECT_EQ(context.submissions, 3);
    EXPECT_EQ(contents(context, deviceArray<std::uint32_t>(context, values, "a test")), values);
    EXPECT_EQ(context.validationMessages(), 0u);
}

// Whether the work has ended is not known then: its fence and its memory are not used again.
TEST(MemoryTest, ADeviceThatCannotBeWaitedForGetsNoMoreWork) {
    for (const VkResult result : {VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_DEVICE_LOST, VK_TIMEOUT}) {
        FaultyContext context;
        context.waiting = result;
        EXPECT_THROW(context.run([](VkCommandBuffer) {}), DeviceLostError) << result;
        context.waiting = VK_SUCCESS;
        EXPECT_TRUE(isAbandoned(context.device()));
        EXPECT_THROW(context.run([](VkCommandBuffer) {}), DeviceLostError) << result;
        EXPECT_EQ(context.submissions, 1);
        EXPECT_EQ(context.validationMessages(), 0u);
    }
    EXPECT_FALSE(isAbandoned(test::device().device())); // several are lost, others go on
}

} // namespace
} // namespace rt::vulkan
