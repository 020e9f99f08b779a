// From results to files and back, and two results side by side.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include <gtest/gtest.h>

#include "Common/Bench/Chart.h"
#include "Common/Bench/Comparison.h"
#include "Common/Bench/Efficiency.h"
#include "Common/Bench/Pictures.h"
#include "Common/Bench/Report.h"
#include "Common/Bench/ReportParts.h"
#include "Common/Bench/ResultsJson.h"
#include "Common/Core/Error.h"
#include "Common/Image/Convergence.h"

namespace rt::bench {
namespace {

Row rowWith(double spp, double seconds, double mse) {
    Row row;
    row.experiment = "e";
    row.config.settings.height = 600;
    row.device = "a \"processor\", fast";
    row.kernel = "box";
    row.spp = spp;
    row.repeats = 3;
    row.seconds = seconds;
    row.secondsMin = 0.99 * seconds;
    row.secondsMax = 1.01 * seconds;
    row.samplesPerSecond = 360000 * spp / seconds;
    row.mse = mse;
    row.mseCi = 0.03 * mse;
    row.relmse = 0.1 / 3;
    row.efficiency = 1 / (mse * seconds);
    return row;
}

Results someResults() {
    Results results;
    results.suite = "s";
    results.title = "A title";
    results.facts = {{"processor", "x"}, {"date", "today"}};
    results.notices = {"One thing is missing."};
    results.rows = {rowWith(4, 0.1, 0.3), rowWith(16, 0.4, 0.07)};
    results.rows[1].config.settings.sampler = app::SamplerKind::Independent;
    results.rows[1].config.settings.features = shared::kFeatureAll;
    return results;
}

Row rowWith(const std::string& scene, app::SamplerKind sampler, double spp, double mse, double mseUpTo1) {
    Row row = rowWith(spp, spp, mse);
    row.config.scene = scene;
    row.config.settings.sampler = sampler;
    row.efficiency = image::efficiency(mse, spp);
    row.mseUpTo1 = mseUpTo1;
    row.mseUpTo1Ci = 0.05 * mseUpTo1;
    row.efficiencyUpTo1 = image::efficiency(mseUpTo1, spp);
    row.shareUpTo1 = 0.9;
    return row;
}

const app::SamplerKind kUsual = app::RenderSettings().sampler, kOther = app::SamplerKind::Independent;

// At 16 samples; what the last rows of "a" have alone counts nowhere.
std::vector<Row> competition() {
    std::vector<Row> rows;
    for (const double spp : {4.0, 16.0}) {
        const auto add = [&](const char* scene, app::SamplerKind sampler, double mse, double mseUpTo1) {
            rows.push_back(rowWith(scene, sampler, spp, mse * 16 / spp, mseUpTo1 * 16 / spp));
        };
        add("a", kUsual, 0.2, 0.01);
        add("a", kOther, 0.1, 0.04); // twice as efficient by all pixels, a quarter by those up to 1
        add("b", kUsual, 0.1, 0.02);
        add("b", kOther, 0.4, 0.02);
        add("exact default", kUsual, 0.0, 0.0);
        add("exact default", kOther, 0.1, 0.1);
        add("exact other", kUsual, 0.1, 0.1);
        add("exact other", kOther, 0.0, 0.0);
    }
    rows.push_back(rowWith("a", kUsual, 64, 1, 1));
    return rows;
}

TEST(BenchEfficiency, DefaultsAreComparedWithTheBestOfEachSceneByAllPixelsAndByThoseUpTo1) {
    const std::vector<Row> rows = competition();
    const std::vector<DefaultsRow> found = compareDefaults(rows);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_STREQ(found[0].pixels->name, "all");
    EXPECT_EQ(found[0].places, 4);
    EXPECT_EQ(found[0].reach.places, 2);
    EXPECT_NEAR(*found[0].reach.mean, std::sqrt(0.5), 1e-9);
    EXPECT_NEAR(*found[0].reach.minimum, 0.5, 1e-9);
    EXPECT_NEAR(*found[0].reach.minCi, 0.5 * std::hypot(0.03, 0.03), 1e-9);
    EXPECT_EQ(found[0].reach.minBest->config.scene, "a");
    EXPECT_EQ(found[0].reach.minBest->config.settings.sampler, kOther);
    EXPECT_STREQ(found[1].pixels->name, "up to 1");
    EXPECT_NEAR(*found[1].reach.mean, 1, 1e-9);
    EXPECT_NEAR(*found[1].reach.minimum, 1, 1e-9);
}

// What renders another image competes with nothing.
TEST(BenchEfficiency, SettingsCompeteAtOnePlace) {
    std::vector<Row> rows = {rowWith("a", kUsual, 4, 0.2, 0.2), rowWith("a", kOther, 4, 0.1, 0.1)};
    for (const auto change : {+[](Config& c) { c.settings.width = 7; }, +[](Config& c) { c.settings.maxDepth = 3; },
                              +[](Config& c) { c.threads = 1; }, +[](Config& c) { c.engine = "single"; }}) {
        rows[1].config = rowWith("a", kOther, 4, 0.1, 0.1).config;
        EXPECT_EQ(compareDefaults(rows).size(), 2u);
        change(rows[1].config);
        EXPECT_TRUE(compareDefaults(rows).empty());
    }
}

TEST(BenchEfficiency, TimeBudgetsAreStepsToo) {
    std::vector<Row> rows = {rowWith("a", kUsual, 900, 0.2, 0.2), rowWith("a", kOther, 1000, 0.1, 0.1)};
    EXPECT_TRUE(compareDefaults(rows).empty()); // no number of samples in common
    for (Row& row : rows) row.timeBudget = 4;
    EXPECT_EQ(compareDefaults(rows).size(), 2u);
}

std::vector<std::string> fieldsOf(const std::string& line) { // of RFC 4180
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
            fields.back() += line[i++];
        else if (line[i] == '"')
            quoted = !quoted;
        else if (line[i] == ',' && !quoted)
            fields.emplace_back();
        else
            fields.back() += line[i];
    }
    return fields;
}

TEST(BenchResults, JsonReadsBackToTheSame) {
    const Results results = someResults();
    const Results back = parseResults(toJson(results), "r.json");
    EXPECT_EQ(back.title, results.title);
    EXPECT_EQ(back.notices, results.notices);
    ASSERT_EQ(back.rows.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(keyOf(back.rows[i].config), keyOf(results.rows[i].config));
        EXPECT_EQ(back.rows[i].device, results.rows[i].device);
        for (const auto& column : rowColumns())
            EXPECT_EQ(back.rows[i].*column.value, results.rows[i].*column.value) << column.name; // to the last bit
    }
    EXPECT_EQ(toJson(back).find("nan"), std::string::npos);
}

TEST(BenchResults, DamagedJsonIsAnError) {
    const std::string json = toJson(someResults());
    EXPECT_THROW(parseResults(json.substr(0, json.size() / 2), "r.json"), InputError);
    EXPECT_THROW(parseResults("{}", "r.json"), InputError);
    EXPECT_THROW(parseResults(R"({"version": 7})", "r.json"), InputError);
    std::string wrong = json;
    wrong.replace(wrong.find("\"independent\""), 13, "\"halton\"     ");
    EXPECT_THROW(parseResults(wrong, "r.json"), InputError);
}

TEST(BenchResults, CsvHasTheSameFigures) {
    const Results results = someResults();
    std::istringstream csv(toCsv(results));
    std::string line;
    ASSERT_TRUE(std::getline(csv, line));
    const std::vector<std::string> names = fieldsOf(line);
    for (const Row& row : results.rows) {
        ASSERT_TRUE(std::getline(csv, line));
        const std::vector<std::string> fields = fieldsOf(line);
        ASSERT_EQ(fields.size(), names.size());
        const auto field = [&](std::string_view name) {
            return fields[static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin())];
        };
        for (const Axis& axis : axes()) EXPECT_EQ(field(axis.name), axis.get(row.config));
        EXPECT_EQ(field("device"), row.device);
        for (const auto& column : rowColumns()) {
            const Figure& figure = row.*column.value;
            EXPECT_EQ(field(column.name).empty(), !figure) << column.name;
            EXPECT_EQ(figure ? std::stod(field(column.name)) : 0.0, figure.value_or(0)) << column.name;
        }
    }
    EXPECT_FALSE(std::getline(csv, line));
}

TEST(BenchReport, MarkdownAndHtmlShowTheRows) {
    const Suite suite =
        parseSuite(R"({"version": 1, "experiments": [{"name": "e", "title": "The <first>", "spp": 4}]})", "s");
    const Document document = makeReport(someResults(), suite);
    const std::string markdown = toMarkdown(document, [](std::size_t) { return "plot.svg"; });
    EXPECT_NE(markdown.find("## The <first>"), std::string::npos);
    EXPECT_NE(markdown.find("independent"), std::string::npos);
    EXPECT_NE(markdown.find("](plot.svg)"), std::string::npos);
    const std::string html = toHtml(document, "t");
    EXPECT_NE(html.find("The &lt;first&gt;"), std::string::npos);
    EXPECT_NE(html.find("<svg"), std::string::npos);
    EXPECT_NE(html.find(".wide{overflow-x:auto}"), std::string::npos); // wide tables scroll by themselves
    EXPECT_NE(html.find("<div class=\"wide\"><table>"), std::string::npos);
}

TEST(BenchReport, WhatWasPublishedStandsBesideRowsOfItsSize) {
    const Suite suite = parseSuite(R"({"version": 1, "experiments": [{"name": "e", "spp": 4}], "published":
        [{"name": "they", "scene": "a", "width": 600, "height": 600, "seconds": {"4": 12}}]})",
                                   "s");
    Results results;
    results.rows = {rowWith("a", kUsual, 4, 0.1, 0.1)};
    const auto report = [&] { return toMarkdown(makeReport(results, suite), [](std::size_t) { return ""; }); };
    EXPECT_NE(report().find("they / multi"), std::string::npos);
    EXPECT_NE(report().find("|   4 |      12 |"), std::string::npos) << report();
    results.rows[0].config.settings.width = 40;
    EXPECT_EQ(report().find("they"), std::string::npos);
}

TEST(BenchReport, AllThreadsAreANumber) {
    Results results;
    for (const std::uint32_t threads : {1u, 0u}) {
        results.rows.push_back(rowWith("a", kUsual, 4, 0.1, 0.1));
        results.rows.back().config.threads = threads;
        results.rows.back().threadsUsed = threads == 0 ? 24 : 1;
    }
    const Suite suite = parseSuite(R"({"version": 1, "experiments": [{"name": "e", "spp": 4}]})", "s");
    const std::string markdown = toMarkdown(makeReport(results, suite), [](std::size_t) { return ""; });
    EXPECT_NE(markdown.find("| scene | engine | threads | spp |"), std::string::npos) << markdown;
    EXPECT_NE(markdown.find("| a     | multi  |      24 |   4 |"), std::string::npos) << markdown;
}

TEST(BenchReport, SettingsStandSideBySide) {
    Results results;
    results.rows = competition();
    const Suite suite = parseSuite(R"({"version": 1, "experiments": [{"name": "e", "spp": 4}]})", "s");
    const std::string markdown = toMarkdown(makeReport(results, suite), [](std::size_t) { return ""; });
    const auto lineWith = [&](std::vector<std::string> parts) {
        std::istringstream lines(markdown);
        for (std::string line; std::getline(lines, line);)
            if (std::all_of(parts.begin(), parts.end(),
                            [&](const std::string& part) { return line.find(part) != std::string::npos; }))
                return line;
        return std::string();
    };
    EXPECT_NE(lineWith({"| a ", "| all ", "16 spp"}).find("| 0.5 ±3 %  | 1 ±3 %"), std::string::npos) << markdown;
    EXPECT_NE(lineWith({"| a ", "| up to 1 ", "16 spp"}).find("| 1 ±5 %    | 0.25 ±5 %"), std::string::npos)
        << markdown;
    EXPECT_NE(lineWith({"| exact other ", "| all ", "16 spp"}).find("| error ~ 0"), std::string::npos) << markdown;
    EXPECT_NE(markdown.find("mse up to 1"), std::string::npos);
    for (Row& row : results.rows) row.shareUpTo1 = 1; // one error, not two
    EXPECT_EQ(toMarkdown(makeReport(results, suite), [](std::size_t) { return ""; }).find("mse up to 1"),
              std::string::npos);
}

// Raw, the error is 1 / s; filtered, which takes a second, it is 0.04 / sqrt(s).
TEST(BenchReport, ThePictureOfRawAndDenoisedComesFirst) {
    Results results;
    for (const auto denoise : {Denoise::Off, Denoise::On})
        for (const double spp : {2.0, 8.0, 32.0}) {
            Row row = rowWith("a", kUsual, spp, 0.1, 0.1);
            row.config.denoise = denoise;
            row.relmse = denoise == Denoise::Off ? 1 / spp : 0.04 / std::sqrt(spp);
            row.seconds = denoise == Denoise::Off ? spp : 1 + spp;
            row.flip = denoise == Denoise::Off ? 0.2 : 0.3;
            if (denoise == Denoise::On) row.estimatedRelmse = 2 * *row.relmse;
            results.rows.push_back(row);
        }
    const Suite suite = parseSuite(R"({"version": 1, "experiments": [{"name": "e", "spp": 4}]})", "s");
    const Document document = makeReport(results, suite);
    const auto first = std::find_if(document.begin(), document.end(),
                                    [](const Block& block) { return std::holds_alternative<Chart>(block); });
    ASSERT_NE(first, document.end());
    const Chart& chart = std::get<Chart>(*first);
    EXPECT_EQ(chart.title, "a: relMSE against time, raw and denoised");
    ASSERT_EQ(chart.lines.size(), 2u);
    EXPECT_EQ(chart.lines[0].name, "raw");
    EXPECT_EQ(chart.lines[1].name, "denoised");
    EXPECT_DOUBLE_EQ(chart.lines[1].points[0].x, 3);
    std::vector<Table> tables;
    for (auto block = first; block != document.end() && tables.size() < 3; ++block)
        if (std::holds_alternative<Table>(*block)) tables.push_back(std::get<Table>(*block));
    ASSERT_EQ(tables.size(), 3u);
    // The filtered picture has 0.0283 at its first step, after 3 s, and less than 1/32 as early as 0.0283 / (1/32) of
    // that. The raw one comes to 0.04 / sqrt(32) after the inverse of it: in 141 s.
    EXPECT_EQ(tables[0].rows.at(0), (std::vector<std::string>{"a", "on", "0.0312", "32", "~2.72", "0.0849", "0.00707",
                                                              "33", "~141", "4.29"}));
    EXPECT_EQ(tables[1].rows.at(1), (std::vector<std::string>{"on", "8", "1", "8.84", "8.84", "1", "2", "2", "2"}));
    EXPECT_EQ(tables[2].rows.at(1),
              (std::vector<std::string>{"a", "on", "8", "0.125", "0.0141", "8.84", "0.2", "0.3", "2"}));
    results.rows.resize(3); // raw alone
    EXPECT_TRUE(denoiseBlocks(results.rows).empty());
}

TEST(BenchReport, ATableWithoutTitlesHasNoRowOfThem) {
    Table table{{"", ""}, {{"a", "b"}}};
    EXPECT_EQ(toHtml({table}, "t").find("<th"), std::string::npos);
    table.header = {"", "x"};
    EXPECT_NE(toHtml({table}, "t").find("<th"), std::string::npos);
}

TEST(BenchReport, ChartsOfTooManyLinesAreSplitByEngine) {
    std::vector<Row> rows;
    for (const std::string_view engine : kEngines)
        for (const std::uint32_t depth : {1u, 2u, 3u}) {
            rows.push_back(rowWith("a", kUsual, 4, 0.2, 0.2));
            rows.back().config.engine = engine;
            rows.back().config.settings.maxDepth = depth;
        }
    std::vector<const Row*> some, all;
    for (const Row& row : rows) {
        all.push_back(&row);
        if (some.size() < 6) some.push_back(&row);
    }
    const std::vector<Chart> few = makeCharts(some), many = makeCharts(all);
    ASSERT_EQ(few.size(), 2u); // over samples, over seconds
    EXPECT_EQ(few[0].lines.size(), 6u);
    ASSERT_EQ(many.size(), 2 * std::size(kEngines));
    EXPECT_EQ(many[2].title, "a, multi: relMSE against samples per pixel");
    EXPECT_EQ(many[3].title, "a, multi: relMSE against seconds");
    EXPECT_EQ(many[2].lines.size(), 3u);
}

TEST(BenchReport, ChartsLeaveOutWhatLogarithmsCannotShow) {
    Chart chart{"t",
                "x",
                "y",
                {{"a<b", {{1, 0.1, 0}, {0, 1, 0}, {10, -1, 0}, {100, 0.001, 0.0005}}}, {"none", {{1, 0, 0}}}},
                true};
    const std::string svg = toSvg(chart);
    std::size_t dots = 0;
    for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) ++dots;
    EXPECT_EQ(dots, 2u);
    EXPECT_NE(svg.find("a&lt;b"), std::string::npos);
    EXPECT_EQ(svg.find("none</text>"), std::string::npos);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_TRUE(toSvg({"t", "x", "y", {}, false}).empty());
}

// 3 bytes give 4 digits; the first of a PNG file are 89 50 4e 47.
TEST(BenchReport, PicturesBecomeDataUris) {
    const std::string uri = dataUri(image::Image(2, 2, 3));
    EXPECT_EQ(uri.rfind("data:image/png;base64,iVBORw0KGgo", 0), 0u) << uri.substr(0, 60);
    EXPECT_EQ((uri.size() - 22) % 4, 0u);
}

TEST(BenchComparison, NoiseIsNoRegression) {
    Results a = someResults(), b = someResults();
    b.rows[0].seconds = 1.04 * *a.rows[0].seconds;
    b.rows[1].mse = 1.02 * *a.rows[1].mse;
    const Comparison same = compareResults(a, b);
    ASSERT_EQ(same.changes.size(), 2u);
    EXPECT_EQ(same.regressions(), 0u);
}

TEST(BenchComparison, WhatIsBeyondNoiseIs) {
    Results a = someResults(), b = someResults();
    b.rows[0].seconds = 1.2 * *a.rows[0].seconds;
    b.rows[1].mse = 1.2 * *a.rows[1].mse;
    b.rows.push_back(rowWith(64, 1, 0.01));
    const Comparison worse = compareResults(a, b);
    ASSERT_EQ(worse.changes.size(), 2u);
    EXPECT_TRUE(worse.changes[0].slower);
    EXPECT_FALSE(worse.changes[0].noisier);
    EXPECT_TRUE(worse.changes[1].noisier);
    EXPECT_EQ(worse.regressions(), 2u);
    EXPECT_EQ(worse.onlyAfter, 1u);
    const Comparison better = compareResults(b, a);
    EXPECT_EQ(better.regressions(), 0u);
    EXPECT_TRUE(better.changes[0].faster);
    EXPECT_TRUE(better.changes[1].lessNoisy);
    EXPECT_EQ(better.onlyBefore, 1u);
    // A machine as restless as this explains the 20 %.
    b.rows[0].secondsMax = 1.6 * *b.rows[0].seconds;
    EXPECT_FALSE(compareResults(a, b).changes[0].slower);
}

TEST(BenchComparison, SaysHowFarAllRowsAreApart) {
    Results a = someResults(), b = someResults();
    a.rows[0].efficiency = a.rows[1].efficiency = 10;
    b.rows[0].efficiency = 8; // a machine that is slower,
    b.rows[1].efficiency = 9.5;
    a.rows[1].gain = b.rows[1].gain = 3; // as a whole
    const std::string text = toMarkdown(describe(compareResults(a, b), a, b), [](std::size_t) { return ""; });
    EXPECT_NE(text.find("Efficiency B/A: median 0.875, from 0.8 to 0.95, 1 of 2 rows within 10 %."), std::string::npos)
        << text;
    EXPECT_NE(text.find("B/A: median 1, from 1 to 1, 1 of 1 rows within 10 %."), std::string::npos) << text;
}

} // namespace
} // namespace rt::bench
