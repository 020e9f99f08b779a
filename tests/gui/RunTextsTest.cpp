// What the comparison says of a run.
#include <set>

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
