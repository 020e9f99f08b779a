// Pictures of other programs beside our own.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Bench/BenchOptions.h"
#include "Common/Bench/Import.h"
#include "Common/Bench/Report.h"
#include "Common/Bench/ReportParts.h"
#include "Common/Bench/ResultsJson.h"
#include "Common/Bench/Runner.h"
#include "Common/Core/Error.h"
#include "Common/Image/ImageIo.h"
#include "tests/TempFolder.h"
#include "tests/unit/FakeEngine.h"

namespace rt::bench {
namespace {

using app::FakeEngine;
using app::kGoOn;
using test::TempFolder;

constexpr std::uint32_t kSide = 16;

// FakeEngine's pixels converge to 0.5: the mean squared error of this is the square of `off`.
std::string pictureOff(const TempFolder& folder, const std::string& name, float off) {
    image::Image picture(kSide, kSide, 3);
    for (float& value : picture.data) value = 0.5f + off;
    std::string file = (folder.path() / name).string();
    image::writeImage(file, picture);
    return file;
}

Suite importSuite(const std::string& axes) {
    return parseSuite(R"({"version": 1, "experiments": [{"name": "e", "scene": "one-weekend-default", "width": 16,
        "height": 16, "sampler": ["sobol", "independent"], "spp": [4, 16]}, {"name": "f", "width": 16, )" +
                          axes + "}]}",
                      "s.json");
}

const char* const kSamePicture = R"("scene": "one-weekend-default", "height": 16, "spp": 4)";

Results runFake(const Suite& suite) {
    Engines engines({{"multi", [](std::uint32_t) { return std::make_unique<FakeEngine>(); }, ""}});
    ReferenceStore store({}, false);
    return runSuite(suite, engines, store, {[](const std::string&) {}, {}}, kGoOn);
}

TEST(BenchImport, APictureBecomesARowOfItsErrorAndSeconds) {
    const TempFolder folder;
    Suite suite = importSuite(kSamePicture);
    suite.imports = {{"Theirs", pictureOff(folder, "b.exr", 0.1f), 4},
                     {"Theirs", pictureOff(folder, "a.exr", 0.2f), 1}};
    const Results results = runFake(suite);
    std::vector<Row> rows;
    for (const Row& row : results.rows)
        if (row.config.imported && row.experiment == "e") rows.push_back(row);
    ASSERT_EQ(rows.size(), 2u); // by seconds
    EXPECT_EQ(rows[0].config.engine, "Theirs");
    EXPECT_EQ(rows[0].seconds, 1);
    EXPECT_NEAR(*rows[0].mse, 0.04, 0.002);
    EXPECT_NEAR(*rows[1].mse, 0.01, 0.001);
    EXPECT_NEAR(*rows[1].efficiency, 1 / (*rows[1].mse * 4), 1e-9);
    EXPECT_FALSE(rows[1].spp || rows[1].samplesPerSecond || rows[1].threadsUsed || rows[1].busy);
    EXPECT_EQ(std::count_if(results.series.begin(), results.series.end(),
                            [](const Series& s) { return s.config.imported && s.secondsAtEqualError; }),
              2);                                       // one in each experiment
    EXPECT_FALSE(results.references.front().verifiedZ); // by another engine of ours

    // The file has what is known and is read back; the report names the program and no sampler of it.
    const Results back = parseResults(toJson(results), "r.json");
    ASSERT_EQ(back.rows.size(), results.rows.size());
    for (std::size_t i = 0; i < back.rows.size(); ++i)
        EXPECT_EQ(keyOf(back.rows[i].config), keyOf(results.rows[i].config));
    const std::string markdown = toMarkdown(makeReport(results, suite), [](std::size_t) { return ""; });
    EXPECT_NE(markdown.find("| Theirs | –           |   – |"), std::string::npos) << markdown;
    EXPECT_NE(toCsv(results).find("one-weekend-default,,Theirs,,,16,16,50,,"), std::string::npos) << toCsv(results);
}

TEST(BenchImport, IsRefusedBeforeAnythingIsMeasured) {
    const TempFolder folder;
    const std::string good = pictureOff(folder, "good.exr", 0);
    const auto refusal = [](const Suite& suite) -> std::string {
        try {
            runFake(suite);
        } catch (const Error& error) {
            return error.what();
        }
        return "none";
    };
    Suite two = importSuite(R"("scene": "furnace", "spp": 4)");
    two.imports = {{"Theirs", good, 1}};
    EXPECT_NE(refusal(two).find("--scene leaves one scene"), std::string::npos) << refusal(two);

    Suite one = importSuite(kSamePicture);
    one.imports = {{"Theirs", (folder.path() / "none.exr").string(), 1}};
    EXPECT_NE(refusal(one).find("none.exr"), std::string::npos) << refusal(one);
    image::Image bad(kSide, kSide, 3);
    bad.pixel(3, 2)[1] = std::nanf("");
    one.imports[0].file = (folder.path() / "bad.pfm").string();
    std::ofstream out(one.imports[0].file, std::ios::binary); // as writeImage writes 0 in its place
    out << "PF\n16 16\n-1.0\n";
    for (std::uint32_t y = kSide; y-- > 0;)
        out.write(reinterpret_cast<const char*>(bad.pixel(0, y)), std::streamsize{kSide} * 3 * sizeof(float));
    out.close();
    EXPECT_NE(refusal(one).find("bad.pfm: pixel 3,2 is no number"), std::string::npos) << refusal(one);
    image::writeImage(folder.path() / "small.exr", image::Image(4, 8, 3));
    one.imports[0].file = (folder.path() / "small.exr").string();
    EXPECT_NE(refusal(one).find("is 4×8, must be 16×16"), std::string::npos) << refusal(one);
}

TEST(BenchImport, FlagsTakeThreeWordsEach) {
    std::ostringstream out;
    const auto options =
        parseBenchOptions({"--import", "A", "a.exr", "2.5", "quick", "--import", "B", "b.exr", "1"}, out);
    ASSERT_EQ(options->imports.size(), 2u);
    EXPECT_EQ(options->suite, "quick");
    EXPECT_EQ(options->imports[0].name, "A");
    EXPECT_EQ(options->imports[0].seconds, 2.5);
    EXPECT_EQ(options->imports[1].file, "b.exr");
    const std::vector<std::vector<std::string>> wrong = {
        {"--import", "A", "a.exr"},        {"--import", "A", "a.exr", "0"},
        {"--import", "A", "a.exr", "-1"},  {"--import", "A", "a.exr", "fast"},
        {"--import", "A", "a.exr", "nan"}, {"--import", "multi", "a.exr", "1"},
        {"--import", "", "a.exr", "1"},    {"--import", "A", "a.exr", "1", "--stability"}};
    for (const auto& arguments : wrong) EXPECT_THROW(parseBenchOptions(arguments, out), UsageError) << arguments.back();
}

} // namespace
} // namespace rt::bench
