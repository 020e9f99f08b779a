// The comparison in both windows, by the mouse, and what there is to see of it.
#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <imgui.h>

#include "Common/App/Interactive/RunHistory.h"
#include "Common/Gui/Theme.h"
#include "tests/gui/WindowTest.h"
#include "tests/unit/RunRecords.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

std::uint32_t bytesOf(const ImVec4& color) {
    const ImU32 packed = ImGui::ColorConvertFloat4ToU32(color);
    const auto byte = [packed](int shift) { return (packed >> shift) & 0xffu; };
    return byte(IM_COL32_R_SHIFT) << 16 | byte(IM_COL32_G_SHIFT) << 8 | byte(IM_COL32_B_SHIFT);
}

app::RunRecord run(const std::string& program, const std::string& estimator, const std::string& time) {
    app::RunRecord r = runRecord(program, estimator, 16);
    r.time = time;
    r.engine = "multi";
    r.scene = "cornell-box-lights";
    r.camera = "{}";
    r.width = r.height = 100;
    r.maxDepth = 50;
    r.threads = 2;
    r.renderSeconds = 1;
    r.samplesPerSecond = 160000;
    r.relmse = 0.1;
    return r;
}

// Of the records that the tests make.
constexpr const char *kCpuRun = "CPU multi, 2 threads", *kGpuRun = "GPU multi, 2 threads";

class ComparisonTest : public WindowTest {
  protected:
    // The runs of the file that a window opens with, the newest last.
    void keep(const std::vector<app::RunRecord>& runs) const {
        fs::create_directories(historyFile().parent_path());
        std::ofstream out(historyFile());
        for (const app::RunRecord& record : runs) out << toJsonLine(record) << '\n';
    }
    fs::path historyFile() const { return folder_ / "config" / "ray-tracing" / "history.jsonl"; }
    // No run is added, and nothing but the window is at work.
    void startAndPause() {
        start({"--spp", "1000000"});
        if (!HasFatalFailure()) key("space");
    }
    std::multiset<std::string> estimatorsInHistory() const {
        std::multiset<std::string> names;
        app::RunHistory history(historyFile());
        for (const app::RunRecord& record : history.records()) names.insert(record.lightSampling);
        return names;
    }
    std::size_t runsOfOther() const {
        std::size_t count = 0;
        app::RunHistory history(historyFile());
        for (const app::RunRecord& record : history.records()) count += record.app != GetParam();
        return count;
    }
    // Again where the machine was too busy to see it: each time only while the condition does not hold.
    bool clickUntil(int x, int y, const std::function<bool()>& condition) {
        return eventually([&] {
            if (condition()) return true;
            click(x, y);
            act("mousemove 1000 300"); // nothing is pointed at
            return eventually(condition, kAnswered);
        });
    }
    // The texts of the table's rows, from the top: below the title of their column.
    std::vector<Place> rows() const {
        const Screenshot shot = screenshot();
        const std::vector<Place> titles = findText(shot, "Engine", {kSide, 0});
        if (titles.empty()) return {};
        const Place below{titles.front().left - 4, titles.front().bottom, titles.front().left + 200, kHeight};
        std::vector<Place> places;
        for (const char* text : {kCpuRun, kGpuRun}) {
            const std::vector<Place> found = findText(shot, text, below);
            places.insert(places.end(), found.begin(), found.end());
        }
        std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.top < b.top; });
        const auto isSameRow = [](const Place& a, const Place& b) {
            return b.top - a.top < 5;
        }; // the two are much alike
        places.erase(std::unique(places.begin(), places.end(), isSameRow), places.end());
        return places;
    }
    bool isRowThere(std::size_t row) const { return rows().size() > row; }
    // Between its mark and its text, where nothing is drawn.
    static int besideText(const Place& text) { return text.left - 3; }
    void clickRow(std::size_t row, bool isAdded = false) {
        const std::vector<Place> places = rows();
        if (places.size() <= row) return;
        if (isAdded) act("keydown ctrl");
        click(besideText(places[row]), places[row].y());
        if (isAdded) act("keyup ctrl");
        pointAtNothing();
    }
    std::uint32_t rowColor(std::size_t row) const {
        const std::vector<Place> places = rows();
        return places.size() > row ? screenshot().at(besideText(places[row]), places[row].y()) : 0;
    }
    // The bar at the left of a card of that title.
    bool hasCard(const std::string& title, const ImVec4& color) const {
        const Screenshot shot = screenshot();
        const std::vector<Place> places = findText(shot, title, {kSide, 0});
        return std::any_of(places.begin(), places.end(),
                           [&](const Place& text) { return shot.at(text.left - 8, text.y()) == bytesOf(color); });
    }
    // Selects or unselects a row, which has another colour then, when nothing points at it any more.
    bool select(std::size_t row, bool isAdded = false) {
        const std::uint32_t plain = rowColor(row);
        return eventually(
            [&] {
                pause(700);
                if (rowColor(row) == plain) clickRow(row, isAdded);
                pause(700);
                return rowColor(row) != plain;
            },
            kSeen);
    }
};

class SharedComparisonTest : public ComparisonTest {};
INSTANTIATE_TEST_SUITE_P(, SharedComparisonTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, SharedComparisonTest, kSecondProgram, nameOfProgram);

class NightlyComparisonTest : public ComparisonTest {};
INSTANTIATE_TEST_SUITE_P(, NightlyComparisonTest, kBothPrograms, nameOfProgram);

// Two runs of equal work and one of another.
TEST_P(SharedComparisonTest, RunsAreShownMarkedSelectedHiddenAndDeleted) {
    const std::string cpu = "ray-tracing-cpu", gpu = "ray-tracing-gpu";
    keep({run(cpu, "bsdf", "2026-01-01T00:00:01Z"), run(cpu, "mis", "2026-01-01T00:00:02Z"),
          run(gpu, "mis", "2026-01-01T00:00:03Z")});
    startAndPause();
    ASSERT_FALSE(HasFatalFailure());
    const ImVec4 cpuColor = gui::engineColor(false, app::ColorMode::Dark);
    const ImVec4 gpuColor = gui::engineColor(true, app::ColorMode::Dark);
    key("F3");
    EXPECT_TRUE(eventually([&] { return hasCard("CPU", cpuColor) && hasCard("GPU", gpuColor); }, kSeen));
    ASSERT_TRUE(eventually([&] { return isRowThere(2); }, kSeen));
    pointAtNothing();
    EXPECT_EQ(rowColor(0), rowColor(2)); // neither is of what is in view
    EXPECT_TRUE(select(2));
    EXPECT_TRUE(clickText("Hide", [&] { return !isRowThere(2); }));
    EXPECT_TRUE(isRowThere(1));
    EXPECT_TRUE(clickText("Unhide", [&] { return isRowThere(2); }));
    EXPECT_EQ(estimatorsInHistory(), (std::multiset<std::string>{"bsdf", "mis", "mis"}));
    EXPECT_TRUE(select(2));
    const std::string question = "Delete 1 run from the history of both programs?";
    EXPECT_TRUE(clickText("Delete", [&] { return isShown(question); }));
    EXPECT_EQ(estimatorsInHistory().size(), 3u);
    const auto confirm = [&](const std::string& asked, const std::function<bool()>& isDone) {
        return eventually(
            [&] { // the button below the question, which goes with it
                const std::vector<Place> text = placesOf(asked);
                const Place below{text.empty() ? 0 : text[0].left - 10, text.empty() ? 0 : text[0].bottom,
                                  text.empty() ? 0 : text[0].right, text.empty() ? 0 : text[0].bottom + 40};
                if (!isDone() && !text.empty()) clickText("Delete", below, isDone);
                return isDone();
            },
            kSeen);
    };
    EXPECT_TRUE(confirm(question, [&] { return estimatorsInHistory() == std::multiset<std::string>{"mis", "mis"}; }));
    const std::string all = "Delete 2 runs from the history of both programs?";
    EXPECT_TRUE(clickText("Clear", [&] { return isShown(all); }));
    EXPECT_TRUE(confirm(all, [&] { return estimatorsInHistory().empty(); }));
    EXPECT_TRUE(eventually([&] { return !isRowThere(0); }, kSeen));
    expectCleanEnd();
}

// Whatever they are of; without a selection the cards are about what is in view, of which there is no run.
TEST_P(SharedComparisonTest, TwoSelectedRowsAreCompared) {
    const std::string cpu = "ray-tracing-cpu";
    keep({run(cpu, "bsdf", "2026-01-01T00:00:01Z"), run(cpu, "mixture", "2026-01-01T00:00:02Z"),
          run("ray-tracing-gpu", "mis", "2026-01-01T00:00:03Z")});
    startAndPause();
    ASSERT_FALSE(HasFatalFailure());
    key("F3");
    ASSERT_TRUE(eventually([&] { return isRowThere(2); }, kSeen));
    EXPECT_TRUE(appears("No run of this work yet"));
    EXPECT_TRUE(select(1));
    EXPECT_TRUE(select(2, true));
    EXPECT_TRUE(appears("Second against first"));
    EXPECT_TRUE(eventually([&] { return !isShown("No run of this work yet"); }, kSeen));
    key("b"); // pins
    pause(700);
    key("b"); // unpins, which clears the comparison
    EXPECT_TRUE(eventually([&] { return !isShown("Second against first"); }, kSeen));
    expectCleanEnd();
}

// The points of two runs are far from each other, so that each is found by its colour.
TEST_P(SharedComparisonTest, TableAndChartAreLinked) {
    app::RunRecord cpuRun = run("ray-tracing-cpu", "mis", "2026-01-01T00:00:01Z");
    app::RunRecord gpuRun = run("ray-tracing-gpu", "mis", "2026-01-01T00:00:02Z");
    cpuRun.renderSeconds = 7;
    cpuRun.relmse = gpuRun.relmse = 0.5;
    gpuRun.renderSeconds = 2;
    cpuRun.hasReference = gpuRun.hasReference = true; // points that are filled
    keep({cpuRun, gpuRun});
    startAndPause();
    ASSERT_FALSE(HasFatalFailure());
    key("F3");
    ASSERT_TRUE(eventually([&] { return isRowThere(1); }, kSeen));
    constexpr std::size_t kCpuRow = 1; // the newest is the first
    struct Point {
        int x = 0, y = 0, size = 0; // its middle, and the number of its pixels
    };
    const auto pointOfCpu = [&] { // left of "seconds", which ends the plot, and below the legend's "CPU"
        const std::uint32_t color = bytesOf(gui::engineColor(false, app::ColorMode::Dark));
        const Screenshot shot = screenshot();
        const std::vector<Place> axis = findText(shot, "seconds", {kWidth / 2, kHeight / 2});
        Point point;
        if (axis.empty()) return point;
        const std::vector<Place> legend = findText(shot, "CPU", {kWidth / 2, kHeight / 2, kWidth, axis.back().top});
        if (legend.empty()) return point;
        for (int y = legend.back().bottom; y < axis.back().top; ++y)
            for (int x = legend.back().left - 40; x < axis.back().right; ++x) {
                if (shot.at(x, y) != color) continue;
                point.x += x, point.y += y, ++point.size;
            }
        if (point.size > 0) point.x /= point.size, point.y /= point.size;
        return point;
    };
    pointAtNothing();
    ASSERT_TRUE(eventually([&] { return pointOfCpu().size > 0; }, kSeen));
    pause(500);
    const Point plain = pointOfCpu();
    const std::uint32_t row = rowColor(kCpuRow);
    act("mousemove " + std::to_string(plain.x) + " " + std::to_string(plain.y));
    EXPECT_TRUE(eventually([&] { return rowColor(kCpuRow) != row; }, kSeen));
    pointAtNothing();
    EXPECT_TRUE(eventually([&] { return rowColor(kCpuRow) == row; }, kSeen));
    const std::vector<Place> places = rows();
    ASSERT_GT(places.size(), kCpuRow);
    act("mousemove " + std::to_string(besideText(places[kCpuRow])) + " " + std::to_string(places[kCpuRow].y()));
    EXPECT_TRUE(eventually([&] { return pointOfCpu().size > 1.3 * plain.size; }, kSeen));
    pointAtNothing();
    EXPECT_TRUE(eventually([&] { return pointOfCpu().size == plain.size; }, kSeen));
    EXPECT_TRUE(eventually( // again where the machine was too busy to see it
        [&] {
            click(plain.x, plain.y); // selects it
            pause(700);
            pointAtNothing();
            pause(700);
            return rowColor(kCpuRow) != row && pointOfCpu().size > 1.3 * plain.size;
        },
        kSeen));
    expectCleanEnd();
}

// By a right click on their titles.
TEST_P(SharedComparisonTest, ColumnsCanBeChosen) {
    keep(
        {run("ray-tracing-cpu", "mis", "2026-01-01T00:00:01Z"), run("ray-tracing-gpu", "mis", "2026-01-01T00:00:02Z")});
    startAndPause();
    ASSERT_FALSE(HasFatalFailure());
    key("F3");
    ASSERT_TRUE(eventually([&] { return isRowThere(1); }, kSeen));
    const std::vector<Place> titles = placesOf("Engine", {kSide, 0});
    ASSERT_FALSE(titles.empty());
    const Place engine = titles.front(), line{engine.left, engine.top - 2, kWidth, engine.bottom + 2};
    const auto isMenuThere = [this] { return isShown("Size column to fit"); };
    const auto toggleTime = [&] { // again where the machine was too busy to see it
        act("mousemove " + std::to_string(engine.x()) + " " + std::to_string(engine.y()) +
            " sleep 0.5 mousedown 3 sleep 0.2 mouseup 3");
        eventually(isMenuThere, kAnswered);
        for (const Place& time : placesOf("Time", {kSide, 0}))
            if (isMenuThere() && std::abs(time.y() - engine.y()) > 8) click(time.x(), time.y());
        key("Escape");
        pointAtNothing();
        pause(700);
    };
    EXPECT_TRUE(isShown("Time", line));
    EXPECT_TRUE(eventually(
        [&] {
            toggleTime();
            return !isMenuThere() && !isShown("Time", line);
        },
        kSeen));
    EXPECT_TRUE(eventually(
        [&] {
            toggleTime();
            return !isMenuThere() && isShown("Time", line);
        },
        kSeen));
    expectCleanEnd();
}

TEST_P(SharedComparisonTest, TheOtherEngineRendersTheSameAtOneClick) {
    const bool isCpu = std::string(GetParam()) == "ray-tracing-cpu";
    const std::string label = std::string("Run on the other engine (") + (isCpu ? "GPU)" : "CPU)");
    start({"--spp", "1000000"});
    ASSERT_FALSE(HasFatalFailure());
    key("F3");
    EXPECT_TRUE(eventually([&] {
        key("F12"); // too early where there is no sample yet
        pause(500);
        return !fs::is_empty(folder_ / "pictures");
    })) << log();
    pause(1500); // what the other one is to do takes as long
    const auto isReady = [&] { return isShown(label); };
    EXPECT_TRUE(clickText(label, [&] { return isShown("Cancel"); }));
    EXPECT_TRUE(clickText("Cancel", isReady));                            // it has waited for this render to end
    const auto colorOfStop = [this] { return screenshot().at(176, 16); }; // of its icon, which fades
    const std::uint32_t rendering = colorOfStop();
    EXPECT_TRUE(clickUntil(176, 16, [&] { return colorOfStop() != rendering; }));
    EXPECT_FALSE(hasChild());
    if (isCpu) { // where software traces for the GPU, the CPU ends at once
        EXPECT_TRUE(clickText(label, [&] { return hasChild(); })) << log();
        EXPECT_TRUE(clickText("Cancel", [&] { return !hasChild(); }));
    }
    EXPECT_EQ(runsOfOther(), 0u);
    const std::uint32_t before = screenshot().at(826, 300);
    EXPECT_TRUE(eventually([&] {
        if (runsOfOther() == 0 && !hasChild()) clickText(label, [&] { return !isReady(); });
        return runsOfOther() == 1;
    })) << log();
    // The pictures are divided by a white line.
    EXPECT_TRUE(eventually([&] {
        const Screenshot shot = screenshot();
        return shot.at(826, 300) == 0xffffff && shot.at(826, 310) == 0xffffff;
    })) << std::hex
        << before;
    expectCleanEnd();
}

// Its run, which the history has, is measured.
TEST_P(NightlyComparisonTest, AReferenceOfOneProgramIsFoundByTheOther) {
    environment_ = {{"XDG_CACHE_HOME", (folder_ / "cache").string()}};
    const bool isGpu = std::string(GetParam()) == "ray-tracing-gpu";
    const auto measured = [this](const std::string& program) {
        app::RunHistory history(historyFile());
        const std::vector<app::RunRecord> records = history.records();
        return std::any_of(records.begin(), records.end(), [&](const app::RunRecord& record) {
            return record.app == program && record.hasReference && record.referenceError > 0;
        });
    };
    start();
    ASSERT_FALSE(HasFatalFailure());
    key("F3");
    EXPECT_TRUE(clickText("Reference...", [&] { return isShown("Render reference"); })) << log();
    EXPECT_TRUE(clickText("Render reference", [&] { return !isShown("Render reference"); })) << log();
    EXPECT_TRUE(eventually([&] { return measured(GetParam()); })) << log(); // the picture's film has begun anew
    expectCleanEnd();
    EXPECT_FALSE(fs::is_empty(folder_ / "cache" / "ray-tracing" / "references"));
    const std::string other = isGpu ? "ray-tracing-cpu" : "ray-tracing-gpu";
    EXPECT_FALSE(measured(other));
    Desktop::start(other, isGpu ? std::vector<std::string>{} : std::vector<std::string>{"--engine", "compute"});
    ASSERT_FALSE(HasFatalFailure());
    EXPECT_TRUE(eventually([&] { return measured(other); })) << log();
    expectCleanEnd();
}

} // namespace
} // namespace rt::test
