#include "Common/Vulkan/Submission.h"

#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "Common/Vulkan/Check.h"
#include "Common/Vulkan/Create.h"
#include "Common/Vulkan/VulkanContext.h"

namespace rt::vulkan {
namespace {

constexpr std::uint32_t kBegin = 0; // the two timestamps of a run
constexpr std::uint32_t kEnd = 1;
// All that is run takes far less: launches are cut to hundredths of a second.
constexpr std::chrono::duration<std::uint64_t, std::nano> kPatience = std::chrono::seconds(60);

} // namespace

Run::Run(VulkanContext& context) : context_(context) {
    const VkDevice device = context.device();
    const VkFenceCreateInfo fenceInfo{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    fence_ = create(device, vkCreateFence, fenceInfo, vkDestroyFence, "Creating a fence");

    VkQueryPoolCreateInfo queries{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
    queries.queryCount = 2;
    timestamps_ = create(device, vkCreateQueryPool, queries, vkDestroyQueryPool, "Creating timestamps");

    VkCommandBufferAllocateInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    buffer.commandPool = context.commandPool_.get();
    buffer.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device, &buffer, &commands_), "Creating a command buffer");
}

Run::~Run() {
    if (isAbandoned(context_.device())) return;
    vkFreeCommandBuffers(context_.device(), context_.commandPool_.get(), 1, &commands_);
}

// What an abandoned device was given may still be in use, and would be waited for in vain.
void Run::requireDevice() const {
    if (isAbandoned(context_.device())) {
        throw DeviceLostError("Running on " + context_.info().name + ": the device was lost before");
    }
}

void Run::begin(const Record& record) {
    requireDevice();
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands_, &begin), "Recording commands");
    const bool clock = context_.limits().timestampSeconds > 0;
    // At the bottom of the pipe also the first: what was begun before belongs to another run.
    const auto stamp = [&](std::uint32_t which) {
        if (clock) vkCmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps_.get(), which);
    };
    if (clock) vkCmdResetQueryPool(commands_, timestamps_.get(), 0, 2);
    stamp(kBegin);
    record(commands_);
    stamp(kEnd);
    check(vkEndCommandBuffer(commands_), "Recording commands");
    begun_ = std::chrono::steady_clock::now();
    context_.submit(commands_, fence_.get());
}

double Run::finish() {
    await();
    const DeviceLimits& limits = context_.limits();
    if (limits.timestampSeconds <= 0) {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
    }
    std::array<std::uint64_t, 2> ticks{};
    check(vkGetQueryPoolResults(context_.device(), timestamps_.get(), 0, 2, sizeof ticks, ticks.data(), sizeof ticks[0],
                                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "Reading timestamps");
    return static_cast<double>((ticks[kEnd] - ticks[kBegin]) & limits.timestampMask) * limits.timestampSeconds;
}

void Run::await() {
    requireDevice();
    const std::string what = "Running on " + context_.info().name;
    const bool patient = context_.info().isSoftware();
    const VkFence fence = fence_.get();
    VkResult result = context_.wait(fence, patient ? std::numeric_limits<std::uint64_t>::max() : kPatience.count());
    if (result == VK_SUCCESS) result = vkResetFences(context_.device(), 1, &fence);
    if (result == VK_SUCCESS) return;
    // Nobody knows what the device still works at: it gets no more work, with this fence or another.
    abandon(context_.device());
    if (result == VK_TIMEOUT) throw DeviceLostError(what + ": no answer for a minute; a newer driver may help");
    if (result != VK_ERROR_DEVICE_LOST) throw DeviceLostError(what + ": waiting failed: " + resultName(result));
    check(result, what);
}

} // namespace rt::vulkan
