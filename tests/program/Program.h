// Runs the programs as a user would: arguments in; exit code, standard output and standard error out.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace rt::test {

struct Outcome {
    int exitCode = -1;
    std::string out;
    std::string err;
};

using Arguments = std::vector<std::string>;
using Environment = std::map<std::string, std::string>;

// A folder of its own for each test, and the programs run in it. The user's configuration is empty.
class ProgramTest : public testing::Test {
  protected:
    void SetUp() override;
    void TearDown() override;

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string bytesOf(const std::string& name) const;
    void writeFile(const std::string& name, const std::string& content) const;
    nlohmann::json jsonOf(const std::string& name) const { return nlohmann::json::parse(bytesOf(name)); }

    Outcome run(const std::string& program, const Arguments& arguments, const Environment& environment = {}) const;
    Outcome cpu(const Arguments& arguments, const Environment& environment = {}) const {
        return run("ray-tracing-cpu", arguments, environment);
    }
    // A picture of 32x32 pixels, silently; further arguments may say otherwise.
    Outcome render(const Arguments& arguments, const Environment& environment = {}) const;
    // The picture as the bytes of a PFM file; the render must succeed.
    std::string pixels(const Arguments& arguments) const;

    std::filesystem::path folder_;
    std::uint64_t addressSpace_ = 0; // KiB that a program may take; 0: no limit
};

std::filesystem::path cacheFolder();
std::string programPath(const std::string& program);

// Exactly one line on standard error that begins with the program's name, nothing on standard output, and the exit
// code.
testing::AssertionResult failsWith(const Outcome& outcome, int exitCode, const std::string& mentioning);

} // namespace rt::test
