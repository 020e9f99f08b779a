// Turns by measured time.
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Interactive/TurnTaking.h"

namespace rt::app {
namespace {

TEST(Turns, WhoTakesLongTurnsGetsFewer) {
    Turns turns;
    for (int i = 0; i < 3; ++i) turns.add();
    const std::vector<double> lengths{0.1, 0.02, 0.05}; // of a turn of each
    std::vector<int> counts(3);
    for (int i = 0; i < 800; ++i) {
        const std::size_t next = *turns.next({true, true, true});
        turns.spend(next, lengths[next]);
        ++counts[next];
    }
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(counts[i] * lengths[i], turns.seconds(0), 0.11) << i;
    EXPECT_GT(counts[1], 4 * counts[0]);
}

TEST(Turns, OnlyThoseWhoWaitAreNext) {
    Turns turns;
    turns.add();
    turns.add();
    EXPECT_EQ(turns.next({false, false}), std::nullopt);
    EXPECT_EQ(turns.next({false, true}), 1u);
    turns.spend(1, 100);
    EXPECT_EQ(turns.next({false, true}), 1u); // there is nobody else
}

// Else one that was finished, or has just been opened, would keep all others from theirs.
TEST(Turns, RestGivesNoClaimToWhatOthersHad) {
    Turns turns;
    turns.add();
    turns.add();
    for (int i = 0; i < 100; ++i) turns.spend(*turns.next({true, false}), 1);
    EXPECT_EQ(turns.seconds(1), 0);
    int second = 0;
    for (int i = 0; i < 100; ++i) {
        const std::size_t next = *turns.next({true, true});
        turns.spend(next, 1);
        second += next == 1 ? 1 : 0;
    }
    EXPECT_NEAR(second, 50, 1);
    turns.add(); // opened now
    EXPECT_EQ(turns.next({true, true, true}), 0u);
    EXPECT_GE(turns.seconds(2), 49);
    turns.remove(0);
    EXPECT_EQ(turns.count(), 2u);
    EXPECT_GE(turns.seconds(1), 49);
}

// Else the one that was there first would be the last to follow a camera that all follow.
TEST(Turns, WhatOneHadAloneIsNoDebt) {
    Turns turns;
    for (int i = 0; i < 3; ++i) turns.add();
    for (int i = 0; i < 100; ++i) turns.spend(*turns.next({true, false, false}), 1);
    for (int i = 0; i < 3; ++i) turns.spend(*turns.next({false, true, false}), 1);
    EXPECT_EQ(turns.next({false, false, false}), std::nullopt); // all rest, and go on together
    std::vector<int> counts(3);
    for (int i = 0; i < 30; ++i) {
        const std::size_t next = *turns.next({true, true, true});
        turns.spend(next, 1);
        ++counts[next];
    }
    EXPECT_EQ(counts, (std::vector<int>{10, 10, 10}));
}

// What somebody has had too much stays with him.
TEST(Turns, RestPaysNoDebt) {
    Turns turns;
    turns.add();
    turns.add();
    (void)turns.next({true, true});
    turns.spend(0, 10);
    EXPECT_EQ(turns.next({false, true}), 1u);
    turns.spend(1, 1);
    EXPECT_EQ(turns.next({true, true}), 1u);
}

} // namespace
} // namespace rt::app
