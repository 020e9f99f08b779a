// ray-tracing-image probe from the outside: its map integrates to one, its samples follow the map, its strategies agree
// on what they estimate, and what cannot be probed is said in one line.
#include <algorithm>
#include <cmath>
#include <string>

#include "Common/Image/ImageIo.h"
#include "tests/program/Program.h"

namespace rt::test {

namespace {

constexpr double kProbePi = 3.14159265358979;

constexpr const char* kProbeRoom = R"({
  "camera": {"look_from": [0, 1, 4], "look_at": [0, 0, 0], "vertical_fov": 40},
  "materials": {"floor": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]},
                "mirror": {"type": "metal", "albedo": [1, 1, 1], "fuzz": 0},
                "lamp": {"type": "emitter", "emission": [9, 9, 9], "sides": "both"}},
  "objects": [
    {"type": "quad", "corner": [-5, 0, 5], "edge_u": [10, 0, 0], "edge_v": [0, 0, -10], "material": "floor"},
    {"type": "sphere", "center": [-0.8, 0.2, 1.5], "radius": 0.2, "material": "mirror"},
    {"type": "sphere", "center": [2, 2, 0], "radius": 0.7, "material": "lamp"},
    {"type": "quad", "corner": [-3, 2, -1], "edge_u": [2, 0, 0], "edge_v": [0, 0, 2], "material": "lamp"},
    {"type": "point_light", "position": [0, 3, 0], "intensity": [1, 1, 1]}]
})";

} // namespace

class ProbeTool : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        writeFile("room.json", kProbeRoom);
    }
    Outcome probe(const std::string& pixel, const std::string& strategy, const Arguments& more = {}) const {
        Arguments arguments = {"probe", "room.json", pixel, "--width", "40", "--strategy", strategy};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run("ray-tracing-image", arguments);
    }
    nlohmann::json figures(const std::string& strategy) const {
        const Outcome outcome = probe("20,20", strategy, {"--json"});
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        return nlohmann::json::parse(outcome.out);
    }
};

TEST_F(ProbeTool, MapsIntegrateToOneAndSamplesFollowThem) {
    for (const char* strategy : {"bsdf", "0", "1"}) {
        const nlohmann::json found = figures(strategy);
        EXPECT_NEAR(found["integral"].get<double>(), 1, 0.02) << strategy;
        EXPECT_EQ(found["dropped"], 0) << strategy;
        EXPECT_GT(found["chi_square"]["degrees"], 20) << strategy;
        EXPECT_GT(found["chi_square"]["p"], 1e-4) << strategy;
        EXPECT_EQ(found["chi_square"]["resolved"], true) << strategy;
        EXPECT_GT(found["total_p"], 1e-4) << strategy;
        EXPECT_LT(found["integral_error"], 0.001) << strategy;
    }
    // What chooses the point light, which has no directions, is not in the map.
    for (const char* strategy : {"lights", "mixture", "mis"}) {
        const nlohmann::json found = figures(strategy);
        const double dropped = found["dropped"].get<double>() / found["samples"].get<double>();
        EXPECT_GT(dropped, 0.005) << strategy;
        EXPECT_NEAR(found["integral"].get<double>() + dropped, 1, 0.02) << strategy;
        EXPECT_GT(found["chi_square"]["p"], 1e-4) << strategy;
    }
}

TEST_F(ProbeTool, StrategiesEstimateTheSameLight) {
    writeFile("room.json",
              std::string(kProbeRoom)
                  .replace(std::string(kProbeRoom).find(",\n    {\"type\": \"point_light\""), std::string::npos, "]}"));
    const nlohmann::json found = figures("lights");
    EXPECT_NEAR(found["integral"].get<double>(), 1, 0.02);
    EXPECT_GT(found["chi_square"]["p"], 1e-4);
    const nlohmann::json& lights = found["estimates"]["lights"];
    const double samples = found["samples"];
    for (const auto& [name, estimate] : found["estimates"].items()) {
        const double difference = estimate["mean"].get<double>() - lights["mean"].get<double>();
        const double variance = estimate["variance"].get<double>() + lights["variance"].get<double>();
        EXPECT_LT(std::abs(difference), 4.5 * std::sqrt(variance / samples)) << name;
    }
    EXPECT_GT(found["estimates"]["bsdf"]["variance"], found["estimates"]["mis"]["variance"]);
    EXPECT_GT(found["estimates"]["mixture"]["variance"], lights["variance"]);
}

TEST_F(ProbeTool, WritesPicturesAndMaps) {
    EXPECT_EQ(probe("20,20", "0", {"-o", "map.pfm", "--rows", "64"}).exitCode, 0);
    const image::Image map = image::readImage(path("map.pfm"));
    ASSERT_EQ(map.channels, 1u);
    EXPECT_EQ(map.width, 128u);
    EXPECT_EQ(map.height, 64u);
    double sum = 0;
    for (const float density : map.data) sum += density;
    EXPECT_NEAR(sum / static_cast<double>(map.data.size()) * 4 * kProbePi, 1, 0.03);

    EXPECT_EQ(probe("20,20", "mis", {"-o", "mis.png", "--rows", "64"}).exitCode, 0);
    const image::Image picture = image::readImage(path("mis.png"));
    EXPECT_EQ(picture.width, 192u);
    const auto isDot = [&](std::uint32_t x, std::uint32_t y) {
        return picture.pixel(x, y)[0] > 2 * picture.pixel(x, y)[1] + 0.1f;
    };
    std::size_t dots[2] = {0, 0}, below = 0;
    for (std::uint32_t y = 0; y < picture.height; ++y) {
        for (std::uint32_t x = 0; x < picture.width; ++x) dots[x >= 128] += isDot(x, y);
        for (std::uint32_t x = 0; y >= 33 && x < 128; ++x) below += isDot(x, y); // the floor's normal is +Y
    }
    EXPECT_GT(dots[0], 100u);
    EXPECT_GT(dots[1], 100u);
    EXPECT_EQ(below, 0u);
}

// What the map is of, and where numbers come from.
TEST_F(ProbeTool, ShowsLightAndStrata) {
    EXPECT_EQ(probe("20,20", "lights", {"-o", "light.pfm", "--rows", "64", "--show", "radiance"}).exitCode, 0);
    const image::Image light = image::readImage(path("light.pfm"));
    EXPECT_NEAR(*std::max_element(light.data.begin(), light.data.end()), 9, 1e-3) << "of the lamps";
    EXPECT_EQ(probe("20,20", "bsdf", {"-o", "weight.pfm", "--rows", "64", "--show", "mis-weight"}).exitCode, 0);
    const image::Image weight = image::readImage(path("weight.pfm"));
    EXPECT_EQ(*std::max_element(weight.data.begin(), weight.data.end()), 1) << "where no lamp is";

    const Outcome strata = probe("20,20", "1", {"-o", "a.png", "--sampler", "stratified", "--strata", "8", "--json"});
    ASSERT_EQ(strata.exitCode, 0) << strata.err;
    const nlohmann::json found = nlohmann::json::parse(strata.out);
    EXPECT_EQ(found["sampler"], "stratified");
    EXPECT_GT(found["chi_square"]["p"], 0.5) << "better than by chance";
    EXPECT_EQ(found["chi_square_growth"].back()[0], 4096);
    EXPECT_TRUE(failsWith(probe("20,20", "bsdf", {"--show", "dark"}), 2, "pdf|radiance|product|mis-weight"));
    EXPECT_TRUE(failsWith(probe("20,20", "bsdf", {"--strata", "0"}), 2, "--strata"));
}

TEST_F(ProbeTool, SameSeedSameFiguresAndLinesForReaders) {
    EXPECT_EQ(probe("20,20", "mis", {"--json"}).out, probe("20,20", "mis", {"--json"}).out);
    EXPECT_NE(probe("20,20", "mis", {"--json", "--seed", "1"}).out, probe("20,20", "mis", {"--json"}).out);
    const std::string lines = probe("20,20", "mis").out;
    for (const char* line : {"\npixel 20 20\n", "\nstrategy mis\n", "\nmaterial floor\n", "\nchi_square.p 0."})
        EXPECT_NE(lines.find(line), std::string::npos) << line << lines;
}

TEST_F(ProbeTool, WhatCannotBeProbedIsOneLine) {
    EXPECT_TRUE(failsWith(probe("0,0", "bsdf"), 3, "shows no surface"));
    EXPECT_TRUE(failsWith(probe("20,20", "2"), 3, "has no extent"));
    EXPECT_TRUE(failsWith(probe("3,23", "bsdf"), 3, "mirror"));
    EXPECT_TRUE(failsWith(probe("40,20", "bsdf"), 2, "0,0 to 39,39"));
    for (const char* pixel : {"20", "20,", ",20", "20;20", "20,20,20", "-1,2", "1e1,2", "99999999999,0", ""})
        EXPECT_TRUE(failsWith(probe(pixel, "bsdf"), 2, "X,Y")) << pixel;
    for (const char* strategy : {"3", "light", "", "-1", "1.5"})
        EXPECT_TRUE(failsWith(probe("20,20", strategy), 2, "--strategy")) << strategy;
    EXPECT_TRUE(failsWith(probe("20,20", "bsdf", {"-o", "a.jpg"}), 2, ".png"));
    EXPECT_TRUE(failsWith(probe("20,20", "bsdf", {"--rows", "4"}), 2, "--rows"));
    EXPECT_TRUE(failsWith(probe("20,20", "bsdf", {"--samples", "1"}), 2, "--samples"));
    EXPECT_TRUE(failsWith(run("ray-tracing-image", {"probe", "nowhere", "1,1"}), 3, "nowhere"));
    writeFile("dark.json", R"({"materials": {"m": {"type": "lambertian", "albedo": [1, 1, 1]}},
        "objects": [{"type": "sphere", "center": [0, 0, -3], "radius": 1, "material": "m"}]})");
    EXPECT_TRUE(failsWith(run("ray-tracing-image", {"probe", "dark.json", "300,300"}), 3, "no lights"));
}

} // namespace rt::test
