#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "Common/App/Session/SceneSource.h"
#include "Common/Bench/BenchOptions.h"
#include "Common/Bench/Suite.h"
#include "Common/Core/Error.h"
#include "Common/Render/Names.h"
#include "tests/unit/JsonSchema.h"

namespace rt::bench {
namespace {

std::string suiteWith(const std::string& experiment) {
    return R"({"version": 1, "experiments": [{"name": "a", )" + experiment + "}]}";
}

std::string failureOf(const std::string& text) {
    try {
        parseSuite(text, "s.json");
    } catch (const InputError& error) {
        return error.what();
    }
    return "no failure";
}

TEST(BenchSuite, NamedOnesAreValidAndUseScenesAndAxesThatExist) {
    std::set<std::string> names;
    for (const NamedSuite& named : namedSuites()) {
        const Suite suite = loadSuite(named.name);
        EXPECT_FALSE(suite.title.empty());
        for (const Experiment& experiment : suite.experiments)
            EXPECT_GT(combinations(experiment, 8).size(), 0u) << named.name << " " << experiment.name;
        names.insert(named.name);
    }
    EXPECT_EQ(names, (std::set<std::string>{"defaults", "denoise", "full", "lights", "peers", "predecessor", "quick",
                                            "samplers", "scaling"}));
}

TEST(BenchSuite, ThePublishedSchemaAgrees) {
    std::ifstream in(RT_SOURCE_DIR "/Assets/bench.schema.json");
    const nlohmann::json json = nlohmann::json::parse(in);
    const test::JsonSchema schema(json);
    for (const NamedSuite& named : namedSuites())
        EXPECT_TRUE(schema.accepts(nlohmann::json::parse(named.text))) << named.name;
    for (const char* wrong : {R"("spp": 0)", R"("spp": [1], "smapler": "sobol")", R"("spp": 1, "repeats": 0)",
                              R"("spp": 1}, {"name": "", "spp": 1)"}) {
        EXPECT_FALSE(schema.accepts(nlohmann::json::parse(suiteWith(wrong)))) << wrong;
        EXPECT_THROW(parseSuite(suiteWith(wrong), "s.json"), InputError) << wrong;
    }
    // Every axis is in it.
    for (const Axis& axis : axes())
        EXPECT_TRUE(json["definitions"]["experiment"]["properties"].contains(std::string(axis.name))) << axis.name;
    // It names what each method may be.
    app::RenderSettings settings;
    app::forEachMethod(
        [&](const char* key, const char*, const char*, const auto& table, auto&) {
            EXPECT_EQ(json["definitions"]["experiment"]["properties"][key]["description"], app::joinedNames(table))
                << key;
        },
        settings);
}

TEST(BenchSuite, ThePredecessorsTableIsWhole) {
    const Suite suite = loadSuite("predecessor");
    const Experiment& table = suite.experiments.front();
    EXPECT_EQ(table.spp.front(), 10u);
    EXPECT_EQ(table.spp.back(), 20000u);
    EXPECT_EQ(table.maxSpp.at("single"), 100u);
    const Config config = combinations(table, 8).front();
    EXPECT_EQ(config.settings.width, 600u);
    EXPECT_EQ(config.settings.maxDepth, 50u);
    for (const std::uint32_t spp : table.spp) EXPECT_TRUE(suite.published.front().seconds.count(spp)) << spp;
}

TEST(BenchSuite, CombinationsAreTheProductOfTheAxes) {
    const Suite suite = parseSuite(suiteWith(R"("scene": ["furnace", "veach-mis"], "sampler": ["sobol", "independent"],
        "light_sampling": "mixture", "width": 64, "spp": [1, 2])"),
                                   "s.json");
    const std::vector<Config> configs = combinations(suite.experiments.front(), 4);
    ASSERT_EQ(configs.size(), 4u);
    std::set<std::string> keys;
    for (const Config& config : configs) {
        keys.insert(keyOf(config));
        EXPECT_EQ(config.settings.width, 64u);
        EXPECT_EQ(config.settings.lightSampling, app::LightSampling::Mixture);
    }
    EXPECT_EQ(keys.size(), 4u);
}

TEST(BenchSuite, CombinationsThatMeanTheSameAreMadeOnce) {
    const auto count = [](const std::string& text) {
        return combinations(parseSuite(suiteWith(text), "s.json").experiments.front(), 4).size();
    };
    // How lights are chosen is of no meaning where none is sampled.
    EXPECT_EQ(count(R"("light_sampling": ["mis", "bsdf"], "light_selection": ["power", "uniform"], "spp": 1)"), 3u);
    // One thread is all that "single" has; 4 are all that there are, 8 are more.
    EXPECT_EQ(count(R"("engine": ["single", "multi"], "threads": [1, 2, 4, 8, 0], "spp": 1)"), 1u + 3u);
}

TEST(BenchSuite, VariantsAreValuesThatBelongTogether) {
    const Suite suite = parseSuite(suiteWith(R"("max_depth": [3, 4], "width": 64, "spp": 4,
        "camera": {"look_from": [1, 2, 3], "look_at": [0, 0, 0]},
        "variants": [{"sampler": "sobol", "light_sampling": "bsdf"},
                     {"light_sampling": "mis", "sampler": "independent"}])"),
                                   "s.json");
    const Experiment& experiment = suite.experiments.front();
    const std::vector<Config> configs = combinations(experiment, 4);
    ASSERT_EQ(configs.size(), 4u); // two variants, each with both depths
    for (const Config& config : configs) {
        const bool isFirst = config.settings.sampler == app::SamplerKind::Sobol;
        EXPECT_EQ(config.settings.lightSampling, isFirst ? app::LightSampling::Bsdf : app::LightSampling::Mis);
        EXPECT_EQ(app::poseOf(config.camera, {}).lookFrom.y, 2);
    }
    EXPECT_TRUE(varies(experiment, *findAxis("sampler")));
    EXPECT_TRUE(varies(experiment, *findAxis("max_depth")));
    EXPECT_FALSE(varies(experiment, *findAxis("width")));
    EXPECT_FALSE(varies(experiment, *findAxis("adaptive")));
}

TEST(BenchSuite, ErrorsNameFilePlaceAndWhatIsAllowed) {
    const auto expect = [](const std::string& text, const std::string& a, const std::string& b) {
        const std::string failure = failureOf(text);
        EXPECT_NE(failure.find("s.json"), std::string::npos) << failure;
        EXPECT_NE(failure.find(a), std::string::npos) << failure;
        EXPECT_NE(failure.find(b), std::string::npos) << failure;
    };
    expect("{", "1:2", "");
    expect(R"({"version": 2, "experiments": []})", "/version", "1");
    expect(R"({"version": 1, "experiments": []})", "/experiments", "empty");
    expect(R"({"version": 1})", "experiments", "");
    expect(suiteWith(R"("spp": [4, 2])"), "/experiments/0/spp/1", "ascending");
    expect(suiteWith(R"("spp": [0])"), "/experiments/0/spp/0", "1 to 2147483647");
    expect(suiteWith(R"("spp": -1)"), "/experiments/0/spp: -1", "1 to 2147483647");
    expect(R"({"version": 1, "experiments": [{"name": "", "spp": 1}]})", "/experiments/0/name", "empty");
    expect(suiteWith(R"("scene": "furnace")"), "/experiments/0", "spp or seconds");
    expect(suiteWith(R"("spp": 1, "seconds": 1)"), "/experiments/0", "spp or seconds");
    expect(suiteWith(R"("seconds": 1, "ranks": [1, 2])"), "/experiments/0/ranks", "spp");
    expect(suiteWith(R"("spp": [1, 4], "denoise": "on")"), "/experiments/0/denoise", "2 or more");
    expect(suiteWith(R"("spp": 4, "denoise": ["off", "much"])"), "/experiments/0/denoise/1", "live");
    expect(suiteWith(R"("spp": 4, "denoise": "on", "ranks": 2)"), "/experiments/0/denoise", "ranks");
    expect(suiteWith(R"("spp": 1, "sampler": ["sobol", "halton"])"), "/experiments/0/sampler/1", "stratified");
    expect(suiteWith(R"("spp": 1, "engine": [])"), "/experiments/0/engine", "empty");
    expect(suiteWith(R"("spp": 1, "smapler": "sobol")"), "/experiments/0/smapler", "sampler");
    expect(suiteWith(R"("spp": 1, "repeats": 0)"), "/experiments/0/repeats", "1 to 1000");
    expect(suiteWith(R"("spp": 1, "baseline": {"colour": 1})"), "/baseline/colour", "axis");
    expect(suiteWith(R"("spp": 1, "variants": [])"), "/variants", "empty");
    expect(suiteWith(R"("spp": 1, "variants": [{"colour": 1}])"), "/variants/0/colour", "axis");
    expect(suiteWith(R"("spp": 1, "variants": [{"sampler": "sobol"}, {"adaptive": "on"}])"), "/variants/1",
           "same axes");
    expect(suiteWith(R"("spp": 1, "sampler": "sobol", "variants": [{"sampler": "sobol"}])"), "/variants/0/sampler",
           "as well");
    expect(suiteWith(R"("spp": 1, "variants": [{"denoise": "on"}])"), "/variants", "2 or more");
    expect(suiteWith(R"("spp": 1, "variants": [{"ranks": 2}])"), "/variants", "ranks");
    expect(suiteWith(R"("spp": 1, "camera": {"look": 1})"), "/camera", "look_from");
    expect(suiteWith(R"("spp": 1, "max_spp": {"quantum": 1})"), "/max_spp/quantum", "pipeline");
    expect(R"({"version": 1, "experiments": [{"name": "a", "spp": 1}, {"name": "a", "spp": 1}]})",
           "/experiments/1/name", "earlier");
}

TEST(BenchSuite, UnknownNamesSayWhatThereIs) {
    try {
        loadSuite("quik");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("quick"), std::string::npos) << error.what();
    }
    EXPECT_THROW(loadSuite("/nowhere/suite.json"), InputError);
}

TEST(BenchSuite, ScenesAndEnginesOfTheCommandLine) {
    Suite suite = loadSuite("quick");
    replaceScenes(suite, {"furnace"});
    restrictEngines(suite, {"single"});
    ASSERT_FALSE(suite.experiments.empty());
    for (const Experiment& experiment : suite.experiments)
        for (const Config& config : combinations(experiment, 4)) {
            EXPECT_EQ(config.scene, "furnace");
            EXPECT_EQ(config.engine, "single");
        }
    restrictEngines(suite, {"compute"});
    EXPECT_TRUE(suite.experiments.empty());
}

TEST(BenchSuite, CommandLine) {
    std::ostringstream out;
    const auto options = parseBenchOptions({"lights", "--scene", "a", "--scene", "b", "--report", "d", "-q"}, out);
    ASSERT_TRUE(options);
    EXPECT_EQ(options->suite, "lights");
    EXPECT_EQ(options->scenes, (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(options->report, "d");
    EXPECT_EQ(parseBenchOptions({"--compare", "A", "B"}, out)->compare, (std::vector<std::string>{"A", "B"}));
    EXPECT_EQ(parseBenchOptions({"--quick"}, out)->suite, "quick");
    EXPECT_TRUE(out.str().empty());
    EXPECT_FALSE(parseBenchOptions({"--help"}, out));
    EXPECT_NE(out.str().find("--compare"), std::string::npos);
    const std::vector<std::vector<std::string>> wrong = {{"--compare", "A"},
                                                         {"--compare", "A", "B", "--report", "c"},
                                                         {"--nonsense"},
                                                         {"--engine", "quantum"},
                                                         {"lights", "--quick"}};
    for (const auto& arguments : wrong) EXPECT_THROW(parseBenchOptions(arguments, out), UsageError) << arguments[0];
    EXPECT_EQ(parseBenchOptions({"--suite", "live"}, out)->suite, "live");
    EXPECT_THROW(parseBenchOptions({"quick", "--suite", "live"}, out), UsageError);
    EXPECT_THROW(parseBenchOptions({"live", "--report", "folder"}, out), UsageError);
}

} // namespace
} // namespace rt::bench
