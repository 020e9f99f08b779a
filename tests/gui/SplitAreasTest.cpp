// Rectangles of viewports, and their splitters, without a window.
#include <gtest/gtest.h>

#include "Common/App/Interactive/GuiSettings.h"
#include "Common/Gui/SplitAreas.h"

namespace rt::gui {
namespace {

constexpr Rect kAll{100, 40, 906, 606};
constexpr float kGapWidth = 6;

TEST(SplitAreas, OneHasAll) {
    const auto areas = splitAreas(kAll, 1, {0.3f, 0.3f}, kGapWidth);
    ASSERT_EQ(areas.size(), 1u);
    EXPECT_EQ(areas[0].width, 906);
    EXPECT_EQ(areas[0].height, 606);
    EXPECT_FALSE(splitterAt(kAll, 1, {}, kGapWidth, 550, 300));
}

TEST(SplitAreas, TwoAreSideBySide) {
    const auto areas = splitAreas(kAll, 2, {0.25f, 0.5f}, kGapWidth);
    ASSERT_EQ(areas.size(), 2u);
    EXPECT_EQ(areas[0].x, 100);
    EXPECT_EQ(areas[0].width, 225);
    EXPECT_EQ(areas[1].x, 331);
    EXPECT_EQ(areas[1].x + areas[1].width, 1006);
    for (const Rect& area : areas) EXPECT_EQ(area.height, 606);
}

TEST(SplitAreas, FourAreTwoRows) {
    const auto areas = splitAreas(kAll, 4, {0.5f, 0.75f}, kGapWidth);
    ASSERT_EQ(areas.size(), 4u);
    EXPECT_EQ(areas[0].height, 450);
    EXPECT_EQ(areas[2].y, 40 + 450 + 6);
    EXPECT_EQ(areas[3].x, areas[1].x);
    EXPECT_EQ(areas[3].y + areas[3].height, 646);
    // No point is in two of them, and all of the part but the gaps is in one.
    for (float y = 40.5f; y < 646; y += 7)
        for (float x = 100.5f; x < 1006; x += 7) {
            int inside = splitterAt(kAll, 4, {0.5f, 0.75f}, kGapWidth, x, y) ? 1 : 0;
            for (const Rect& area : areas) inside += area.contains(x, y) ? 1 : 0;
            EXPECT_EQ(inside, 1) << x << ' ' << y;
        }
}

TEST(SplitAreas, AreNeverEmpty) {
    for (const float width : {1.0f, 3.0f, 8.0f, 40.0f})
        for (const Rect& area : splitAreas({0, 0, width, width}, 4, {0.1f, 0.9f}, kGapWidth)) {
            EXPECT_GE(area.width, 1);
            EXPECT_GE(area.height, 1);
        }
}

TEST(SplitAreas, SplittersAreDraggedWithinBounds) {
    const Splits even;
    EXPECT_EQ(splitterAt(kAll, 4, even, kGapWidth, 552, 100), (Splitter{true, false}));
    EXPECT_EQ(splitterAt(kAll, 4, even, kGapWidth, 300, 342), (Splitter{false, true}));
    EXPECT_EQ(splitterAt(kAll, 4, even, kGapWidth, 552, 342), (Splitter{true, true}));
    EXPECT_EQ(splitterAt(kAll, 2, even, kGapWidth, 300, 342), Splitter());
    EXPECT_EQ(splitterAt(kAll, 2, even, kGapWidth, 552, 20), Splitter()); // above it
    const Splits moved = movedTo(even, {true, false}, kAll, 100 + 0.25f * 906, 600);
    EXPECT_FLOAT_EQ(moved.x, 0.25f);
    EXPECT_EQ(moved.y, 0.5f);
    const Splits beyond = movedTo(even, {true, true}, kAll, -50, 5000);
    EXPECT_EQ(beyond.x, app::kMinSplit);
    EXPECT_EQ(beyond.y, app::kMaxSplit);
}

} // namespace
} // namespace rt::gui
