// The files that a program with a window was asked for on its command line.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/App/Interactive/InteractiveSession.h"
#include "Common/Image/ImageIo.h"
#include "tests/TempFolder.h"
#include "tests/unit/FakeEngine.h"

namespace rt::app {
namespace {

using namespace std::chrono_literals;

class WindowFilesTest : public ::testing::Test {
  protected:
    void SetUp() override {
        request_.files = {path("a.exr")};
        request_.aovs = {Aov::Samples};
        request_.stats = path("a.json");
    }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::unique_ptr<InteractiveSession> start(std::uint32_t spp) const {
        InteractiveSession::Setup setup;
        setup.options.program = "ray-tracing-cpu";
        setup.makeEngine = [](const EngineChoice&) { return std::make_unique<FakeEngine>(); };
        setup.request.size.width = 8;
        setup.request.settings.spp = spp;
        setup.scene = {"cornell-box-lights", true};
        setup.atEnd = request_;
        return std::make_unique<InteractiveSession>(std::move(setup));
    }
    // The time only ends a test that fails.
    template <class Condition>
    static bool reaches(const InteractiveSession& session, Condition condition) {
        for (int i = 0; i < 20'000; ++i) {
            if (condition(session.state())) return true;
            std::this_thread::sleep_for(1ms);
        }
        return false;
    }
    nlohmann::json statistics() const {
        std::ifstream in(path("a.json"));
        return nlohmann::json::parse(in, nullptr, false);
    }

    test::TempFolder folder_;
    SaveRequest request_;
};

TEST_F(WindowFilesTest, AreWrittenWhenTheFirstRenderEnds) {
    const auto session = start(5);
    ASSERT_TRUE(reaches(*session, [](const SessionState& s) { return s.activity == Activity::Finished; }));
    ASSERT_TRUE(reaches(*session, [](const SessionState& s) { return s.messageSerial == 1; }));
    EXPECT_NE(session->state().message.find("a.samples.exr"), std::string::npos); // each of them is named
    EXPECT_EQ(image::readImage(path("a.exr")).width, 8u);
    EXPECT_EQ(image::readImage(path("a.samples.exr")).data.front(), 5);
    const nlohmann::json json = statistics();
    EXPECT_EQ(json["stopped_by"], "spp");
    EXPECT_EQ(json["spp_done"], 5);
    EXPECT_EQ(json["width"], 8);
    EXPECT_TRUE(json["window"].contains("longest_turn_seconds"));

    // Once: what is rendered next does not replace them.
    std::filesystem::remove(path("a.exr"));
    session->reset();
    ASSERT_TRUE(reaches(*session, [](const SessionState& s) { return s.picture.serial > 1; }));
    EXPECT_TRUE(session->close().failures.empty());
    EXPECT_FALSE(std::filesystem::exists(path("a.exr")));
}

TEST_F(WindowFilesTest, AreWrittenAtTheLatestWhenTheWindowCloses) {
    const auto session = start(0x7fffffff);
    ASSERT_TRUE(reaches(*session, [](const SessionState& s) { return s.status.samplesDone > 0; }));
    EXPECT_TRUE(session->close().failures.empty());
    EXPECT_EQ(statistics()["stopped_by"], "interrupted");
    EXPECT_GT(statistics()["spp_done"], 0);
    EXPECT_TRUE(std::filesystem::exists(path("a.exr")));
}

TEST_F(WindowFilesTest, ThatCannotBeWrittenAreTold) {
    request_.files = {path("missing/a.exr")};
    const auto session = start(5);
    ASSERT_TRUE(reaches(*session, [](const SessionState& s) { return s.errorSerial > 0; }));
    EXPECT_NE(session->state().errors.back().text.find("missing/a."), std::string::npos);
    const auto failures = session->close().failures;
    ASSERT_EQ(failures.size(), 2u); // the image, and what lies beside it
    EXPECT_NE(failures.front().find("missing/a.exr"), std::string::npos);
    EXPECT_EQ(statistics()["outputs"].size(), 0u); // those that can be written are
}

TEST_F(WindowFilesTest, NothingRenderedIsAFailure) {
    InteractiveSession::Setup setup;
    setup.makeEngine = [](const EngineChoice&) { return std::make_unique<FakeEngine>(); };
    setup.scene = {"no-such-scene", true};
    InteractiveSession session(std::move(setup));
    session.writeAtEnd(request_);
    const EndFiles files = session.close();
    EXPECT_FALSE(files.hasFilm);
    EXPECT_EQ(files.failures.size(), 1u);
}

} // namespace
} // namespace rt::app
