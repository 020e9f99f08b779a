// The report as a page: what it says first, where its points lead, what it takes from elsewhere.
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "Common/Bench/Report.h"
#include "Common/Bench/ReportParts.h"

namespace rt::bench {
namespace {

Results twoEngines() {
    Results results;
    results.title = "A title";
    results.facts = {{"processor", "x"}};
    for (const char* engine : {"multi", "single"}) {
        Series series;
        series.experiment = "e";
        series.config.engine = engine;
        series.config.settings.height = 600;
        series.equalError = 0.01;
        series.secondsAtEqualError = series.config.engine == "multi" ? 2.0 : 5.0;
        results.series.push_back(series);
        for (const double spp : {4.0, 16.0}) {
            Row row;
            row.experiment = "e";
            row.config = series.config;
            row.spp = spp;
            row.seconds = spp;
            row.mse = row.relmse = 1 / spp;
            results.rows.push_back(row);
        }
    }
    return results;
}

Suite pageSuite() {
    return parseSuite(R"({"version": 1, "experiments": [{"name": "e", "spp": 4}]})", "s");
}

std::size_t countOf(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

TEST(BenchPage, BeginsWithWhatWasFound) {
    const Results results = twoEngines();
    const std::string text = toMarkdown(makeReport(results, pageSuite()), [](std::size_t) { return ""; });
    const std::size_t sentence = text.find(
        "cornell-box-lights, 600×600: multi is the first at an error of 0.01, after "
        "2 s. single needs 5 s, 2.5 times as long.");
    ASSERT_NE(sentence, std::string::npos) << text;
    EXPECT_LT(sentence, text.find("| processor"));
    EXPECT_LT(sentence, text.find("| scene"));
}

TEST(BenchPage, SentencesCompareTheFirstWithFourAtMostAndTheSlowest) {
    Results results = twoEngines();
    results.series.clear();
    for (std::uint32_t threads = 1; threads <= 9; ++threads) {
        Series series;
        series.experiment = "e";
        series.config.threads = threads;
        series.equalError = 0.01;
        series.secondsAtEqualError = 10 - threads;
        results.series.push_back(series);
    }
    const std::string text = toMarkdown(summaryBlocks(pageSuite(), results), [](std::size_t) { return ""; });
    EXPECT_NE(text.find(": 9 is the first at an error of 0.01, after 1 s. 8 needs 2 s, 2 times as long; 7 3 s, 3 times "
                        "as long; 6 4 s, 4 times as long; 1 9 s, 9 times as long."),
              std::string::npos)
        << text;
    results.series.resize(1);
    EXPECT_TRUE(summaryBlocks(pageSuite(), results).empty()); // nothing competes
}

TEST(BenchPage, ScenesFromFilesAreCalledByTheirNames) {
    Results results = twoEngines();
    for (Series& series : results.series) series.config.scene = "/some/folder/room.json";
    const std::string text = toMarkdown(summaryBlocks(pageSuite(), results), [](std::size_t) { return ""; });
    EXPECT_NE(text.find("\n\nroom.json, 600×600: multi"), std::string::npos) << text;
    EXPECT_EQ(text.find("/some"), std::string::npos) << text;
}

TEST(BenchPage, EachPointLeadsToItsRow) {
    const Results results = twoEngines();
    const std::string html = toHtml(makeReport(results, pageSuite()), "t");
    EXPECT_EQ(countOf(html, "<a href=\"#row-"), 2 * results.rows.size()); // over samples, over seconds
    std::size_t found = 0;
    for (std::size_t at = html.find("<a href=\"#"); at != std::string::npos; at = html.find("<a href=\"#", at + 1)) {
        const std::size_t begin = at + std::string("<a href=\"#").size();
        const std::string id = html.substr(begin, html.find('"', begin) - begin);
        ASSERT_EQ(countOf(html, "<tr id=\"" + id + "\">"), 1u) << id;
        // The point's title and the row say the same.
        const std::string title = html.substr(html.find("<title>", at) + 7, 60);
        const std::string row = html.substr(html.find("<tr id=\"" + id + "\">"), 200);
        const std::string engine = title.substr(0, title.find(','));
        EXPECT_NE(row.find("<td>" + engine + "</td>"), std::string::npos) << title << row;
        const std::string spp = title.substr(title.find(", ") + 2, title.find(" spp") - title.find(", ") - 2);
        EXPECT_NE(row.find("<td class=\"n\">" + spp + "</td>"), std::string::npos) << title << row;
        ++found;
    }
    EXPECT_EQ(found, 2 * results.rows.size());
    // A picture of a chart alone leads nowhere.
    EXPECT_EQ(svgsOf(makeReport(results, pageSuite())).front().find("<a "), std::string::npos);
}

TEST(BenchPage, StandsAloneInLightAndDarkAndOnPaper) {
    const std::string html = toHtml(makeReport(twoEngines(), pageSuite()), "t");
    for (const char* loading : {"src=\"http", "href=\"http", "url(", "<script src", "@import", "<link", "fetch("})
        EXPECT_EQ(html.find(loading), std::string::npos) << loading;
    for (const char* part : {"prefers-color-scheme:dark", "@media print", "<thead>", "aria-sort", "name=\"viewport\""})
        EXPECT_NE(html.find(part), std::string::npos) << part;
}

} // namespace
} // namespace rt::bench
