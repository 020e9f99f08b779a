// The comparison in both windows, by the mouse, and what there is to see of it.
#include <algorithm>
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

class ComparisonTest : public WindowTest {
  protected:
    static constexpr int kFirstRow = 726, kRow = 19; // of the table
    static constexpr int kBeside = 386;              // between its edge and its text

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
            for (int i = 0; i < 15 && !condition(); ++i) pause(100);
            return condition();
        });
    }
    void clickRow(int row) {
        click(kBeside, kFirstRow + row * kRow);
        act("mousemove 1000 300"); // nothing is pointed at
    }
    // Where no text of the row is.
    std::uint32_t rowColor(int row) const { return screenshot().at(kBeside, kFirstRow + row * kRow); }
    bool isRowThere(int row) const {
        const Screenshot shot = screenshot();
        std::set<std::uint32_t> colors;
        const int y = kFirstRow + row * kRow;
        for (int x = 400; x < 520; ++x)
            for (int dy = -5; dy <= 5; ++dy) colors.insert(shot.at(x, y + dy));
        return colors.size() > 1; // letters
    }
    bool isAt(int x, int y, const ImVec4& color) const { return screenshot().at(x, y) == bytesOf(color); }
    static ImVec4 popupColor() {
        ImGuiStyle style;
        gui::applyTheme(style, app::ColorMode::Dark);
        return style.Colors[ImGuiCol_PopupBg];
    }
};
INSTANTIATE_TEST_SUITE_P(, ComparisonTest, kBothPrograms, nameOfProgram);

class SharedComparisonTest : public ComparisonTest {};
INSTANTIATE_TEST_SUITE_P(, SharedComparisonTest, kFirstProgram, nameOfProgram);
INSTANTIATE_TEST_SUITE_P(Nightly, SharedComparisonTest, kSecondProgram, nameOfProgram);

class NightlyComparisonTest : public ComparisonTest {};
INSTANTIATE_TEST_SUITE_P(, NightlyComparisonTest, kBothPrograms, nameOfProgram);

// Two runs of equal work and one of another.
TEST_P(NightlyComparisonTest, RunsAreShownMarkedSelectedHiddenAndDeleted) {
    const std::string cpu = "ray-tracing-cpu", gpu = "ray-tracing-gpu";
    keep({run(cpu, "bsdf", "2026-01-01T00:00:01Z"), run(cpu, "mis", "2026-01-01T00:00:02Z"),
          run(gpu, "mis", "2026-01-01T00:00:03Z")});
    startAndPause();
    ASSERT_FALSE(HasFatalFailure());
    const ImVec4 cpuColor = gui::engineColor(false, app::ColorMode::Dark);
    const ImVec4 gpuColor = gui::engineColor(true, app::ColorMode::Dark);
    const bool isGpu = GetParam() == gpu;
    EXPECT_TRUE(eventually([&] { return isAt(394, 54, isGpu ? gpuColor : cpuColor); })); // the chip of the picture
    key("F3");
    EXPECT_TRUE(eventually([&] { return isAt(384, 591, cpuColor) && isAt(616, 591, gpuColor); })); // the cards
    ASSERT_TRUE(eventually([&] { return isRowThere(2); }));
    const std::uint32_t plain = rowColor(2);
    EXPECT_EQ(rowColor(0), plain); // it is not of what is in view
    const auto isSelected = [&] {
        pause(700); // a row that was pointed at is not stressed any more
        return rowColor(2) != plain;
    };
    const auto select = [&] { // again where the machine was too busy to see it
        return eventually([&] {
            if (!isSelected()) clickRow(2);
            return isSelected();
        });
    };
    EXPECT_TRUE(select());
    EXPECT_TRUE(clickUntil(541, 659, [&] { return !isRowThere(2); })); // Hide
    EXPECT_TRUE(isRowThere(1));
    EXPECT_TRUE(clickUntil(602, 659, [&] { return isRowThere(2); })); // Unhide
    EXPECT_EQ(estimatorsInHistory(), (std::multiset<std::string>{"bsdf", "mis", "mis"}));
    EXPECT_TRUE(select());
    const auto isAsked = [this] { return isAt(900, 701, popupColor()); };
    EXPECT_TRUE(clickUntil(671, 659, isAsked)); // Delete
    EXPECT_EQ(estimatorsInHistory().size(), 3u);
    EXPECT_TRUE(clickUntil(707, 703, [&] { // yes
        return estimatorsInHistory() == std::multiset<std::string>{"mis", "mis"};
    }));
    EXPECT_TRUE(clickUntil(734, 659, isAsked));                                       // Clear
    EXPECT_TRUE(clickUntil(770, 703, [&] { return estimatorsInHistory().empty(); })); // yes
    EXPECT_TRUE(eventually([&] { return !isRowThere(0); }));
    expectCleanEnd();
}

// The points of two runs are far from each other, so that each is found by its colour.
TEST_P(NightlyComparisonTest, TableAndChartAreLinked) {
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
    ASSERT_TRUE(eventually([&] { return isRowThere(1); }));
    constexpr int kCpuRow = 1; // the newest is the first
    struct Point {
        int x = 0, y = 0, size = 0; // its middle, and the number of its pixels
    };
    const auto pointOfCpu = [&] {
        const std::uint32_t color = bytesOf(gui::engineColor(false, app::ColorMode::Dark));
        const Screenshot shot = screenshot();
        Point point;
        for (int y = 724; y < 800; ++y) // below the legend
            for (int x = 1005; x < 1260; ++x) {
                if (shot.at(x, y) != color) continue;
                point.x += x, point.y += y, ++point.size;
            }
        if (point.size > 0) point.x /= point.size, point.y /= point.size;
        return point;
    };
    act("mousemove 1000 300"); // nothing is pointed at
    ASSERT_TRUE(eventually([&] { return pointOfCpu().size > 0; }));
    pause(500);
    const Point plain = pointOfCpu();
    const std::uint32_t row = rowColor(kCpuRow);
    act("mousemove " + std::to_string(plain.x) + " " + std::to_string(plain.y));
    EXPECT_TRUE(eventually([&] { return rowColor(kCpuRow) != row; }));
    act("mousemove 1000 300");
    EXPECT_TRUE(eventually([&] { return rowColor(kCpuRow) == row; }));
    act("mousemove " + std::to_string(kBeside) + " " + std::to_string(kFirstRow + kCpuRow * kRow));
    EXPECT_TRUE(eventually([&] { return pointOfCpu().size > 1.3 * plain.size; }));
    act("mousemove 1000 300");
    EXPECT_TRUE(eventually([&] { return pointOfCpu().size == plain.size; }));
    EXPECT_TRUE(eventually([&] { // again where the machine was too busy to see it
        click(plain.x, plain.y); // selects it
        pause(700);
        act("mousemove 1000 300");
        pause(700);
        return rowColor(kCpuRow) != row && pointOfCpu().size > 1.3 * plain.size;
    }));
    expectCleanEnd();
}

// By a right click on their titles; the last of the menu's rows stands at the window's lower end.
TEST_P(SharedComparisonTest, ColumnsCanBeChosen) {
    constexpr int kColumns = 9, kTime = 1, kLastItem = 840, kItem = 21;
    keep(
        {run("ray-tracing-cpu", "mis", "2026-01-01T00:00:01Z"), run("ray-tracing-gpu", "mis", "2026-01-01T00:00:02Z")});
    startAndPause();
    ASSERT_FALSE(HasFatalFailure());
    key("F3");
    ASSERT_TRUE(eventually([&] { return isRowThere(1); }));
    const auto titles = [this] {
        const Screenshot shot = screenshot();
        std::vector<std::uint32_t> colors;
        for (int y = 701; y < 714; ++y)
            for (int x = 536; x < 940; ++x) colors.push_back(shot.at(x, y));
        return colors;
    };
    const auto isMenuThere = [this] { return isAt(690, 852, popupColor()); };
    const auto toggleTime = [&] { // again where the machine was too busy to see it
        act("mousemove 600 707 sleep 0.5 mousedown 3 sleep 0.2 mouseup 3");
        pause(700);
        if (isMenuThere()) click(660, kLastItem - (kColumns - 1 - kTime) * kItem);
        pause(700);
        key("Escape");
        act("mousemove 1000 300");
        pause(700);
    };
    act("mousemove 1000 300");
    pause(500);
    const auto all = titles();
    EXPECT_TRUE(eventually([&] {
        toggleTime();
        return !isMenuThere() && titles() != all;
    }));
    EXPECT_TRUE(eventually([&] {
        toggleTime();
        return !isMenuThere() && titles() == all;
    }));
    expectCleanEnd();
}

TEST_P(ComparisonTest, TheOtherEngineRendersTheSameAtOneClick) {
    constexpr int kLine = 557, kRun = 900, kCancel = 1030; // of the button, which gives way to progress and Cancel
    start({"--spp", "1000000"});
    ASSERT_FALSE(HasFatalFailure());
    key("F3");
    EXPECT_TRUE(eventually([&] {
        key("F12"); // too early where there is no sample yet
        pause(500);
        return !fs::is_empty(folder_ / "pictures");
    })) << log();
    pause(1500);                                                            // what the other one is to do takes as long
    const auto colorOfRun = [this] { return screenshot().at(851, kLine); }; // left of its text
    const std::uint32_t ready = colorOfRun();
    const auto isReady = [&] { return colorOfRun() == ready; };
    EXPECT_TRUE(clickUntil(kRun, kLine, [&] { return !isReady(); }));
    EXPECT_TRUE(clickUntil(kCancel, kLine, isReady));                     // it has waited for this render to end
    const auto colorOfStop = [this] { return screenshot().at(176, 16); }; // of its icon, which fades
    const std::uint32_t rendering = colorOfStop();
    EXPECT_TRUE(clickUntil(176, 16, [&] { return colorOfStop() != rendering; }));
    EXPECT_FALSE(hasChild());
    if (std::string(GetParam()) == "ray-tracing-cpu") { // where software traces for the GPU, the CPU ends at once
        EXPECT_TRUE(clickUntil(kRun, kLine, [&] { return hasChild(); })) << log();
        EXPECT_TRUE(clickUntil(kCancel, kLine, [&] { return !hasChild(); }));
    }
    EXPECT_EQ(runsOfOther(), 0u);
    const std::uint32_t before = screenshot().at(826, 300);
    EXPECT_TRUE(eventually([&] {
        if (runsOfOther() == 0 && !hasChild()) click(kRun, kLine); // again where the machine was too busy to see it
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
    EXPECT_TRUE(clickUntil(1117, 557, [&] { return isAt(1230, 581, popupColor()); })) << log(); // Reference...
    click(1123, 580);                                                                           // Render reference
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
