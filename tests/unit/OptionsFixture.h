// Flags as a user gives them who has no configuration, and the one line that an error is.
#pragma once
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Options/Options.h"
#include "Common/Core/Error.h"
#include "tests/Environment.h"

namespace rt::app {

// A user without configuration whose environment says nothing.
class OptionsFixture : public testing::Test {
  protected:
    void SetUp() override {
        const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
        home_ = std::filesystem::path(testing::TempDir()) / ("options-" + test);
        std::filesystem::remove_all(home_);
        std::filesystem::create_directories(home_ / "ray-tracing");
        test::setVariable("XDG_CONFIG_HOME", home_.string());
        test::setVariable("RT_THREADS", "");
    }
    void TearDown() override {
        test::setVariable("RT_THREADS", "");
        std::filesystem::remove_all(home_);
    }

    static std::optional<Options> read(std::vector<std::string> arguments) {
        std::ostringstream out;
        return parseOptions("ray-tracing-cpu", std::move(arguments), out);
    }
    // Of a headless render.
    static Options render(std::vector<std::string> arguments) {
        arguments.emplace_back("--headless");
        return read(std::move(arguments)).value();
    }
    static Options sized(std::vector<std::string> arguments, double sceneAspect = 1) {
        Options options = render(std::move(arguments));
        settleImageSize(options, "scene", sceneAspect);
        return options;
    }
    // The message of the usage error, which is one line.
    static std::string error(std::vector<std::string> arguments) {
        arguments.emplace_back("--headless");
        try {
            Options options = read(std::move(arguments)).value();
            settleImageSize(options, "scene", 1);
        } catch (const UsageError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            return error.what();
        }
        return "no error";
    }
    std::string writeFile(const std::string& name, const std::string& text) const {
        const std::filesystem::path path = home_ / name;
        std::ofstream(path) << text;
        return path.string();
    }

    std::filesystem::path home_;
};

} // namespace rt::app
