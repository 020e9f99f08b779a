// Parts of an image: --region, --tiles and ray-tracing-image merge.
#include "Common/Image/ImageIo.h"
#include "tests/program/Program.h"

namespace rt::test {
namespace {

class Parts : public ProgramTest {
  protected:
    Outcome share(const std::string& which, const std::string& file, Arguments more = {}) const {
        more.insert(more.begin(),
                    {"--width", "100", "--height", "52", "--spp", "20", "--tiles", which, "--checkpoint", file});
        return render(more);
    }
    Outcome merge(Arguments arguments) const {
        arguments.insert(arguments.begin(), "merge");
        return run("ray-tracing-image", arguments);
    }
};

TEST_F(Parts, SharesInAnyOrderMakeTheImage) {
    const std::string whole = pixels({"--width", "100", "--height", "52", "--spp", "20"});
    for (const char* which : {"1/3", "2/3", "3/3"})
        ASSERT_EQ(share(which, std::string(1, *which) + ".rtc").exitCode, 0);
    for (const Arguments& order : {Arguments{"1.rtc", "2.rtc", "3.rtc"}, Arguments{"3.rtc", "1.rtc", "2.rtc"}}) {
        Arguments arguments = order;
        arguments.insert(arguments.end(), {"-o", "merged.pfm"});
        const Outcome outcome = merge(arguments);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        EXPECT_TRUE(bytesOf("merged.pfm") == whole);
    }
    // A merged checkpoint is one to go on from.
    EXPECT_EQ(merge({"2.rtc", "1.rtc", "3.rtc", "-o", "all.rtc"}).exitCode, 0);
    const Arguments more = {"--width", "100", "--height", "52", "--spp", "33"};
    Arguments resumed = more;
    resumed.insert(resumed.end(), {"--resume", "all.rtc"});
    EXPECT_TRUE(pixels(resumed) == pixels(more));
}

TEST_F(Parts, WhatDoesNotFitIsNamed) {
    ASSERT_EQ(share("1/2", "1.rtc").exitCode, 0);
    ASSERT_EQ(share("2/2", "2.rtc").exitCode, 0);
    ASSERT_EQ(share("2/2", "seed.rtc", {"--seed", "1"}).exitCode, 0);
    ASSERT_EQ(share("2/2", "replicates.rtc", {"--stats", "s.json"}).exitCode, 0);
    ASSERT_EQ(render({"--width", "100", "--height", "52", "--spp", "2147483647", "--tiles", "2/2", "--time-limit",
                      "0.05", "--checkpoint", "early.rtc"})
                  .exitCode,
              0);
    EXPECT_TRUE(failsWith(merge({"1.rtc", "-o", "a.pfm"}), 3, "lack 44 of 91 tiles"));
    EXPECT_TRUE(failsWith(merge({"1.rtc", "2.rtc", "1.rtc", "-o", "a.pfm"}), 3, "is in 1.rtc as well"));
    EXPECT_TRUE(failsWith(merge({"1.rtc", "seed.rtc", "-o", "a.pfm"}), 3, "seed.rtc: seed is 1 but 0 in 1.rtc"));
    EXPECT_TRUE(failsWith(merge({"1.rtc", "replicates.rtc", "-o", "a.pfm"}), 3, "keeps its film otherwise"));
    EXPECT_TRUE(failsWith(merge({"early.rtc", "-o", "a.pfm"}), 3, "finish it by --resume"));
    EXPECT_TRUE(failsWith(merge({"1.rtc", "none.rtc", "-o", "a.pfm"}), 3, "none.rtc"));
    ASSERT_EQ(render({"--width", "40", "--height", "24", "--spp", "32", "--adaptive", "on", "--checkpoint",
                      "adaptive.rtc", "-o", "adaptive.pfm", "--save-every", "60"})
                  .exitCode,
              0);
    EXPECT_TRUE(failsWith(merge({"adaptive.rtc", "-o", "a.pfm"}), 3, "adaptive.rtc: its samples are adaptive"));
    EXPECT_TRUE(failsWith(merge({"1.rtc", "2.rtc", "-o", "1.rtc"}), 2, "would overwrite"));
    EXPECT_FALSE(std::filesystem::exists(path("a.pfm")));
}

TEST_F(Parts, ARegionIsThatPartOfTheImageAndBlackElsewhere) {
    const Arguments common = {"-q", "--width", "50", "--height", "40", "--spp", "8"};
    const auto draw = [&](Arguments arguments) {
        arguments.insert(arguments.begin(), common.begin(), common.end());
        const Outcome outcome = cpu(arguments);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    };
    draw({"-o", "whole.pfm"});
    draw({"-o", "part.pfm", "--aov", "samples", "--region", "13,5,20,30", "--stats", "s.json"});
    const image::Image whole = image::readImage(path("whole.pfm")), part = image::readImage(path("part.pfm"));
    const image::Image samples = image::readImage(path("part.samples.pfm"));
    for (std::uint32_t y = 0; y < whole.height; ++y) {
        for (std::uint32_t x = 0; x < whole.width; ++x) {
            const bool isInside = x >= 13 && x < 33 && y >= 5 && y < 35;
            EXPECT_EQ(*samples.pixel(x, y), isInside ? 8.0f : 0.0f) << x << ' ' << y;
            for (std::uint32_t c = 0; c < 3; ++c)
                EXPECT_EQ(part.pixel(x, y)[c], isInside ? whole.pixel(x, y)[c] : 0.0f) << x << ' ' << y;
        }
    }
    EXPECT_EQ(jsonOf("s.json")["spp_done"], 8);
}

TEST_F(Parts, WrongPartsAreUsageErrors) {
    EXPECT_TRUE(failsWith(render({"-o", "a.pfm", "--region", "1,2,3"}), 2, "X,Y,W,H"));
    EXPECT_TRUE(failsWith(render({"-o", "a.pfm", "--region", "0,0,0,5"}), 2, "--region"));
    EXPECT_TRUE(failsWith(render({"-o", "a.pfm", "--region", "30,0,5,5"}), 2, "32x32"));
    EXPECT_TRUE(failsWith(share("0/2", "a.rtc"), 2, "--tiles"));
    EXPECT_TRUE(failsWith(share("3/2", "a.rtc"), 2, "--tiles"));
    EXPECT_TRUE(failsWith(share("2", "a.rtc"), 2, "I/N"));
    EXPECT_TRUE(failsWith(share("1000/1000", "a.rtc"), 2, "too few tiles"));
    EXPECT_TRUE(failsWith(render({"--tiles", "1/2"}), 2, "--checkpoint"));
    EXPECT_TRUE(failsWith(render({"-o", "a.pfm", "--tiles", "1/2", "--target-error", "1"}), 2, "--target-error"));
}

} // namespace
} // namespace rt::test
