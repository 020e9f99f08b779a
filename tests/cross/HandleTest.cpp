// Who destroys Vulkan objects, and when.
#include <cstdint>

#include <gtest/gtest.h>

#include "Common/Vulkan/Handle.h"

namespace rt::vulkan {
namespace {

int destroyed = 0;
VKAPI_ATTR void VKAPI_CALL destroy(VkDevice, VkFence, const VkAllocationCallbacks*) {
    ++destroyed;
}

// Any that are not null: nothing asks them.
VkDevice fakeDevice(std::uintptr_t number) {
    return reinterpret_cast<VkDevice>(number);
}
Handle<VkFence> fakeFence(VkDevice device) {
    return {device, reinterpret_cast<VkFence>(std::uintptr_t{1}), destroy};
}

TEST(HandleTest, ObjectsOfAbandonedDevicesAreLeftAlone) {
    destroyed = 0;
    {
        const Handle<VkFence> ofTheFirst = fakeFence(fakeDevice(1)), ofTheSecond = fakeFence(fakeDevice(2)),
                              ofTheThird = fakeFence(fakeDevice(3));
        abandon(fakeDevice(1));
        abandon(fakeDevice(2));
    }
    EXPECT_EQ(destroyed, 1);
    static_cast<void>(fakeFence(fakeDevice(3))); // destroyed at once
    EXPECT_EQ(destroyed, 2);
}

} // namespace
} // namespace rt::vulkan
