// Every kind of error ends in its exit code and one line.
#include <filesystem>
#include <iostream>
#include <new>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Core/MemoryReserve.h"
#include "Common/Core/RunMain.h"

namespace rt {
namespace {

struct Ending {
    int code;
    std::string err;
};

Ending endOf(const std::function<int()>& body) {
    testing::internal::CaptureStderr();
    const int code = runMain("program", body);
    return {code, testing::internal::GetCapturedStderr()};
}

TEST(RunMain, ReturnsWhatTheBodyReturns) {
    EXPECT_EQ(endOf([] { return 0; }).code, 0);
    EXPECT_EQ(endOf([] { return 5; }).code, 5);
    EXPECT_EQ(endOf([] { return 5; }).err, "");
}

TEST(RunMain, MapsErrorsToExitCodes) {
    EXPECT_EQ(endOf([]() -> int { throw UsageError("x"); }).code, 2);
    EXPECT_EQ(endOf([]() -> int { throw InputError("x"); }).code, 3);
    EXPECT_EQ(endOf([]() -> int { throw RenderError("x"); }).code, 1);
    EXPECT_EQ(endOf([]() -> int { throw Error(ExitCode::NoDevice, "x"); }).code, 4);
    EXPECT_EQ(endOf([]() -> int { throw std::bad_alloc(); }).err, "program: not enough memory\n");
    EXPECT_EQ(endOf([]() -> int { throw std::runtime_error("odd"); }).code, 1);
    const auto error = std::make_error_code(std::errc::permission_denied);
    EXPECT_EQ(endOf([&]() -> int { throw std::filesystem::filesystem_error("x", "a/b", error); }).err,
              "program: a/b: " + error.message() + "\n");
}

// The first allocation that fails has the reserve given back; the next one throws, until it is kept again.
TEST(RunMain, KeepsMemoryForTheWayOut) {
    endOf([] { return 0; });
    const std::new_handler handler = std::get_new_handler();
    ASSERT_NE(handler, nullptr);
    for (int round = 0; round < 2; ++round) {
        EXPECT_NO_THROW(handler());
        EXPECT_THROW(handler(), std::bad_alloc);
        EXPECT_NO_THROW(requireMemoryReserve());
        keepMemoryReserve(); // is held already
    }
}

TEST(RunMain, PrintsOneLine) {
    EXPECT_EQ(endOf([]() -> int { throw InputError("a.json: bad\nvalue"); }).err, "program: a.json: bad\\nvalue\n");
    const Ending lengthy = endOf([]() -> int { throw InputError(std::string(3'000'000, 'x')); });
    EXPECT_LT(lengthy.err.size(), 1200u);
}

TEST(RunMain, NoticesWhenStandardOutputIsLost) {
    std::cout.setstate(std::ios::badbit);
    const Ending ending = endOf([] { return 0; });
    std::cout.clear();
    EXPECT_EQ(ending.code, 1);
    EXPECT_EQ(ending.err, "program: cannot write to standard output\n");
}

} // namespace
} // namespace rt
