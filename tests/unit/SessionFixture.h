// The way from options to files with an engine whose samples cost nothing.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "Common/App/Session/Session.h"
#include "tests/Environment.h"
#include "tests/FileBytes.h"
#include "tests/TempFolder.h"
#include "tests/unit/FakeEngine.h"

namespace rt::app {

class SessionFixture : public testing::Test {
  protected:
    void SetUp() override { test::setVariable("XDG_STATE_HOME", path("state")); }
    void TearDown() override { test::setVariable("XDG_STATE_HOME", ""); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    // Of a 20x12 image.
    static Options options(std::vector<std::string> arguments) {
        const auto common = {"--headless", "--no-config", "-q", "--width", "20", "--height", "12"};
        arguments.insert(arguments.begin(), common.begin(), common.end());
        std::ostringstream out;
        return parseOptions("ray-tracing-cpu", std::move(arguments), out).value();
    }

    // Runs a session; the fake engine stays at hand.
    ExitCode run(std::vector<std::string> arguments, std::function<void(std::uint32_t)> onSample = {}) {
        engine_ = nullptr;
        return runSession(options(std::move(arguments)), [&] {
            auto engine = std::make_unique<FakeEngine>();
            engine->onSample = onSample;
            engine_ = engine.get();
            return engine;
        });
    }
    // Message of the error that a session ends with.
    template <class Expected>
    std::string error(std::vector<std::string> arguments, std::function<void(std::uint32_t)> onSample = {}) {
        try {
            run(std::move(arguments), std::move(onSample));
        } catch (const Expected& error) {
            return error.what();
        }
        return "no such error";
    }
    nlohmann::json statistics() const { return nlohmann::json::parse(test::bytesOfFile(path("stats.json"))); }

    test::TempFolder folder_;
    FakeEngine* engine_ = nullptr; // whether one was made; gone once run() returns
};

} // namespace rt::app
