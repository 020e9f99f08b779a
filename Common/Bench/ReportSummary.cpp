#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "Common/Bench/Cells.h"
#include "Common/Bench/ReportParts.h"

namespace rt::bench {
namespace {

constexpr std::size_t kMaxSentences = 8;
constexpr std::size_t kMaxOthers = 4; // that a sentence compares the first with

// What competes for one picture, quickest first.
struct Contest {
    const Experiment* experiment;
    std::vector<const Series*> series;
};

bool isOfOnePicture(const Config& a, const Config& b) {
    return a.scene == b.scene && a.settings.width == b.settings.width && a.settings.height == b.settings.height &&
           a.settings.maxDepth == b.settings.maxDepth;
}

std::vector<Contest> contestsOf(const Suite& suite, const Results& results) {
    std::vector<Contest> contests;
    for (const Experiment& experiment : suite.experiments) {
        const std::size_t first = contests.size();
        for (const Series& series : results.series) {
            if (series.experiment != experiment.name || !series.secondsAtEqualError) continue;
            const auto found =
                std::find_if(contests.begin() + static_cast<std::ptrdiff_t>(first), contests.end(),
                             [&](const Contest& c) { return isOfOnePicture(c.series.front()->config, series.config); });
            (found == contests.end() ? contests.emplace_back(Contest{&experiment, {}}) : *found)
                .series.push_back(&series);
        }
    }
    std::erase_if(contests, [](const Contest& contest) { return contest.series.size() < 2; });
    for (Contest& contest : contests)
        std::stable_sort(contest.series.begin(), contest.series.end(), [](const Series* a, const Series* b) {
            return *a->secondsAtEqualError < *b->secondsAtEqualError;
        });
    return contests;
}

std::string nameIn(const Contest& contest, const Series& series) {
    std::vector<const Config*> configs;
    for (const Series* one : contest.series) configs.push_back(&one->config);
    return nameOf(series.config, configs,
                  [](const Axis& axis) { return axis.name != "scene" && axis.name != "height"; });
}

std::string sentenceOf(const Contest& contest) {
    const Series& best = *contest.series.front();
    const app::RenderSettings& settings = best.config.settings;
    std::string text = sceneName(best.config.scene) + ", " + std::to_string(settings.width) + "×" +
                       std::to_string(settings.height) + ": " + nameIn(contest, best) +
                       " is the first at an error of " + threeDigits(best.equalError) + ", after " +
                       threeDigits(best.secondsAtEqualError) + " s.";
    const std::size_t others = std::min(contest.series.size() - 1, kMaxOthers);
    for (std::size_t i = 1; i <= others; ++i) {
        // The slowest ends the sentence, whatever is left out before it.
        const Series& other = *(i < others ? contest.series[i] : contest.series.back());
        text += (i == 1 ? " " : "; ") + nameIn(contest, other) + (i == 1 ? " needs " : " ") +
                threeDigits(other.secondsAtEqualError) + " s, " +
                threeDigits(*other.secondsAtEqualError / *best.secondsAtEqualError) + " times as long";
    }
    return text + ".";
}

// Of each experiment and picture the configuration that comes first to the error that all reach.
Table firstOnes(const std::vector<Contest>& contests) {
    Table table{{"experiment", "scene", "least time to equal relMSE", "relmse", "seconds", "gain over baseline"}, {}};
    for (const Contest& contest : contests) {
        const Series& best = *contest.series.front();
        table.rows.push_back({contest.experiment->name, sceneName(best.config.scene), nameIn(contest, best),
                              threeDigits(best.equalError), threeDigits(best.secondsAtEqualError),
                              threeDigits(best.gain)});
    }
    return table;
}

} // namespace

Document summaryBlocks(const Suite& suite, const Results& results) {
    const std::vector<Contest> contests = contestsOf(suite, results);
    if (contests.empty()) return {};
    Document document{
        Heading{2, "In short"},
        Paragraph{
            "A picture is noisy at first and gets cleaner with every sample of its pixels. How far it is from the "
            "true picture is its error, relMSE: the mean squared difference, relative to the true picture's own "
            "brightness. Here stands who came first to an error that all reached, and how long the others took; "
            "seconds are those of rendering alone."}};
    for (std::size_t i = 0; i < std::min(contests.size(), kMaxSentences); ++i)
        document.push_back(Paragraph{sentenceOf(contests[i])});
    document.push_back(firstOnes(contests));
    return document;
}

} // namespace rt::bench
