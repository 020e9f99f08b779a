#include <string>

#include <gtest/gtest.h>

#include "Common/App/Interactive/ErrorList.h"

namespace rt::app {
namespace {

TEST(ErrorList, StaysUntilItIsReadAndIsListedBeyond) {
    ErrorList errors;
    EXPECT_EQ(errors.unread(), nullptr);
    errors.add("no such scene", ErrorSource::Scene);
    errors.add("disk full", ErrorSource::Save);
    ASSERT_NE(errors.unread(), nullptr);
    EXPECT_EQ(errors.unread()->text, "disk full");
    ASSERT_NE(errors.unread(ErrorSource::Scene), nullptr);
    EXPECT_EQ(errors.unread(ErrorSource::Scene)->text, "no such scene");
    EXPECT_EQ(errors.unread(ErrorSource::Camera), nullptr);
    errors.dismiss(*errors.unread());
    EXPECT_EQ(errors.unread()->text, "no such scene");
    EXPECT_EQ(errors.unreadCount(), 1u);
    errors.dismiss(ErrorSource::Scene); // another has loaded
    EXPECT_EQ(errors.unread(), nullptr);
    EXPECT_EQ(errors.all().size(), 2u);
    errors.clear();
    EXPECT_TRUE(errors.all().empty());
}

TEST(ErrorList, TheSameOnceMoreIsCountedAndUnreadAgain) {
    ErrorList errors;
    for (int i = 0; i < 3; ++i) errors.add("disk full", ErrorSource::Save);
    EXPECT_EQ(errors.all().size(), 1u);
    EXPECT_EQ(errors.unread()->count, 3u);
    errors.dismissAll();
    errors.add("disk full", ErrorSource::Save);
    EXPECT_EQ(errors.unreadCount(), 1u);
}

TEST(ErrorList, ForgetsTheOldestOfMany) {
    ErrorList errors;
    for (std::size_t i = 0; i <= ErrorList::kMax; ++i) errors.add(std::to_string(i), ErrorSource::Other);
    EXPECT_EQ(errors.all().size(), ErrorList::kMax);
    EXPECT_EQ(errors.all().front().text, "1");
}

} // namespace
} // namespace rt::app
