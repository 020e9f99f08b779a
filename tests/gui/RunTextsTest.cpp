// What the comparison says of a run.
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "Common/Gui/Panels/RunTexts.h"
#include "Common/Render/Names.h"

namespace rt::gui {
namespace {

TEST(RunTexts, EstimatesAndMeasurementsAreToldApart) {
    app::RunRecord run;
    EXPECT_EQ(errorKind(run), "");
    EXPECT_EQ(errorText(run.relmse), "-");
    run.relmse = 0.02;
    EXPECT_EQ(errorKind(run), "estimated");
    EXPECT_NE(whatErrorKindMeans(run).find("own estimate"), std::string::npos);
    run.hasReference = true;
    EXPECT_EQ(errorKind(run), "measured");
    EXPECT_EQ(whatErrorKindMeans(run), "Measured against a reference");
}

TEST(RunTexts, AReferenceThatIsTooNoisyIsTold) {
    app::RunRecord run;
    run.relmse = 0.02;
    run.hasReference = true;
    run.referenceError = 0.002;
    EXPECT_EQ(whatErrorKindMeans(run).find("too noisy"), std::string::npos);
    run.referenceError = 0.003;
    EXPECT_NE(whatErrorKindMeans(run).find("too noisy"), std::string::npos);
}

TEST(RunTexts, TheHeadlineSaysMediansSpreadAndWhatIsNotToldApart) {
    app::RunRecord cpu, gpu;
    cpu.app = "ray-tracing-cpu";
    gpu.app = "ray-tracing-gpu";
    cpu.engine = "multi";
    gpu.engine = "compute";
    gpu.isSoftware = true;
    app::RepeatedComparison repeats;
    const auto headline = [&] { return headlineOf({&cpu, &gpu}, repeats); };
    EXPECT_NE(headline().find("not known"), std::string::npos);
    repeats.ratio = 0.5;
    repeats.first = {1, 2e6, 2e6, 2e6};
    repeats.second = {2, 1e6, 1e6, 1e6};
    EXPECT_EQ(headline(),
              "GPU compute (software) is 2\u00d7 slower than CPU multi (samples/s): 1 and 2 runs; three of "
              "each tell how far repeated runs differ");
    repeats.first = {3, 2e6, 1.9e6, 2.1e6};
    repeats.second = {4, 1e6, 0.95e6, 1e6};
    EXPECT_EQ(headline(),
              "GPU compute (software) is 2\u00d7 slower than CPU multi (samples/s): medians of 3 and 4 runs, "
              "which spread over 10 % and 5 %");
    repeats.second.maximum = 1.95e6;
    EXPECT_EQ(headline().find("CPU multi and GPU compute (software) are not told apart (samples/s): medians of"), 0u);
}

TEST(RunTexts, EachEstimatorHasAMarkOfItsOwn) {
    std::set<Mark> marks;
    for (const auto& estimator : app::kLightSamplings) marks.insert(markOf(std::string(estimator.name)));
    EXPECT_EQ(marks.size(), std::size(app::kLightSamplings));
    EXPECT_EQ(marks.count(Mark::Line), 0u);
}

TEST(RunTexts, TimesAreReadable) {
    app::RunRecord run;
    EXPECT_EQ(whenText(run), "");
    run.time = "2026-11-25T04:40:04Z";
    EXPECT_EQ(whenText(run), "2026-11-25 04:40:04");
}

TEST(RunTexts, OldRecordsSayWhatTheyLack) {
    app::RunRecord run;
    EXPECT_NE(runDetails(run).find("the record lacks"), std::string::npos);
}

} // namespace
} // namespace rt::gui
