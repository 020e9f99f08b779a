// The arithmetic of the sub-allocator of device memory.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Vulkan/FreeList.h"

namespace rt::vulkan {
namespace {

TEST(FreeListTest, PlacesAreAlignedAndTheLowestOnesThatFit) {
    FreeList list(1000);
    EXPECT_EQ(list.take(10, 1), 0u);
    EXPECT_EQ(list.take(100, 256), 256u);
    EXPECT_EQ(list.take(246, 1), 10u); // what the alignment left
    EXPECT_EQ(list.take(645, 1), std::nullopt);
    EXPECT_EQ(list.take(644, 1), 356u);
    EXPECT_EQ(list.take(1, 1), std::nullopt);
}

TEST(FreeListTest, APlaceThatIsLargeEnoughOnlyUnalignedIsNone) {
    FreeList list(100);
    EXPECT_EQ(list.take(1, 1), 0u);
    EXPECT_EQ(list.take(40, 64), std::nullopt);
    EXPECT_EQ(list.take(36, 64), 64u);
    EXPECT_EQ(list.take(63, 1), 1u);
}

TEST(FreeListTest, NeighboursBecomeOnePlaceAgain) {
    FreeList list(30);
    for (std::uint64_t i = 0; i < 3; ++i) EXPECT_EQ(list.take(10, 1), 10 * i);
    list.give(0, 10);
    list.give(20, 10);
    EXPECT_FALSE(list.isWhole());
    EXPECT_EQ(list.take(11, 1), std::nullopt);
    list.give(10, 10); // joins both sides
    EXPECT_TRUE(list.isWhole());
    EXPECT_EQ(list.take(30, 1), 0u);
}

// Whatever is taken and given back: inside, aligned, apart from all others, and whole at the end.
TEST(FreeListTest, RandomPlacesNeverOverlap) {
    struct Place {
        std::uint64_t begin, size;
    };
    constexpr std::uint64_t kSize = 1u << 16;
    std::mt19937 random(7);
    FreeList list(kSize);
    std::vector<Place> places;
    std::size_t refused = 0;
    for (int i = 0; i < 20'000; ++i) {
        if (!places.empty() && random() % 5 < 2) {
            std::swap(places[random() % places.size()], places.back());
            list.give(places.back().begin, places.back().size);
            places.pop_back();
            continue;
        }
        const std::uint64_t size = 1 + random() % 1000, alignment = std::uint64_t{1} << random() % 10;
        const std::optional<std::uint64_t> at = list.take(size, alignment);
        if (!at) {
            ++refused;
            continue;
        }
        EXPECT_EQ(*at % alignment, 0u);
        EXPECT_LE(*at + size, kSize);
        for (const Place& other : places) EXPECT_TRUE(*at + size <= other.begin || other.begin + other.size <= *at);
        places.push_back({*at, size});
    }
    EXPECT_GT(refused, 100u); // it was full for a while
    for (const Place& place : places) list.give(place.begin, place.size);
    EXPECT_TRUE(list.isWhole());
}

} // namespace
} // namespace rt::vulkan
