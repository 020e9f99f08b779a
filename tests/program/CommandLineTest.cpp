// Flags and their values: what is accepted, what is refused, and with which exit code.
#include <algorithm>
#include <set>

#include "tests/program/Program.h"

namespace rt::test {
namespace {

class CommandLine : public ProgramTest {};

TEST_F(CommandLine, HelpVersionAndScenesGoToStandardOutput) {
    for (const char* flag : {"--help", "-h", "--version", "--list-scenes"}) {
        const Outcome outcome = cpu({flag});
        EXPECT_EQ(outcome.exitCode, 0) << flag;
        EXPECT_EQ(outcome.err, "") << flag;
        EXPECT_GT(outcome.out.size(), 15u) << flag;
    }
    EXPECT_EQ(cpu({"--version"}).out.rfind("ray-tracing-cpu ", 0), 0u);
}

TEST_F(CommandLine, ListedScenesAreUniqueAndTheDefaultIsAmongThem) {
    const auto list = nlohmann::json::parse(cpu({"--list-scenes", "--json"}).out);
    const std::string lines = cpu({"--list-scenes"}).out;
    std::set<std::string> ids;
    for (const auto& scene : list) {
        EXPECT_TRUE(ids.insert(scene["id"]).second) << scene;
        EXPECT_FALSE(scene["title"].get<std::string>().empty()) << scene;
        EXPECT_NE(("\n" + lines).find("\n" + scene["id"].get<std::string>() + " "), std::string::npos) << scene;
    }
    EXPECT_EQ(ids.size(), static_cast<std::size_t>(std::count(lines.begin(), lines.end(), '\n')));
    EXPECT_EQ(ids.count("cornell-box-lights"), 1u);
}

// Programs of these tests see no display.
TEST_F(CommandLine, WithoutADisplayTheErrorNamesHeadless) {
#ifdef RT_HAS_WINDOW
    constexpr int kExitCode = 1;
#else
    constexpr int kExitCode = 2;
#endif
    EXPECT_TRUE(failsWith(cpu({}), kExitCode, "--headless"));
    EXPECT_TRUE(failsWith(cpu({"--spp", "4"}), kExitCode, "--headless"));
    EXPECT_TRUE(failsWith(cpu({"--window"}), kExitCode, "--headless"));
}

TEST_F(CommandLine, UsageErrors) {
    EXPECT_TRUE(failsWith(cpu({"--window", "--headless"}), 2, "--window"));
    const std::vector<std::pair<Arguments, std::string>> cases = {
        {{"--frames", "3"}, "--frames"},
        {{"--shutter", "0.1"}, "--shutter"},
        {{"--shutter", "0.2,0.1"}, "--shutter"},
        {{"cornell-box-lights"}, "cornell-box-lights"},
        {{"--spp", "0"}, "--spp 0: must be a whole number from 1 to 2147483647"},
        {{"--spp", "2147483648"}, "--spp 2147483648"},
        {{"--spp", "-1"}, "--spp -1"},
        {{"--spp", "ten"}, "--spp ten"},
        {{"--samples", "0"}, "--spp 0"},
        {{"--width", "0", "--height", "0"}, "--width 0: must be a whole number from 1 to 16384"},
        {{"--width", "100000", "--height", "100000"}, "16384"},
        {{"--width", "32", "--height", "32", "--aspect", "2"}, "--aspect"},
        {{"--aspect", "nan"}, "--aspect nan"},
        {{"--max-depth", "0"}, "--max-depth 0"},
        {{"--max-depth", "4097"}, "--max-depth 4097"},
        {{"--light-sampling", "nee"}, "mis, mis-balance, mixture or bsdf"},
        {{"--light-selection", "best"}, "contribution, power or uniform"},
        {{"--sphere-light", "disk"}, "--sphere-light disk"},
        {{"--quad-light", "cone"}, "--quad-light cone"},
        {{"--triangle-light", ""}, "--triangle-light"},
        {{"--sampler", "halton"}, "sobol, sobol-blue, stratified or independent"},
        {{"--one-sided-lights", "maybe"}, "on or off"},
        {{"--russian-roulette", "1"}, "on or off"},
        {{"--seed", "-3"}, "--seed -3"},
        {{"--replicates", "0"}, "--replicates 0"},
        {{"--replicates", "101"}, "--spp 100"},
        {{"--exposure", "inf"}, "--exposure inf"},
        {{"--tonemap", "filmic"}, "none, reinhard, aces, agx or neutral"},
        {{"--aov", "albedo"}, "--aov"},
        {{"--aov", "albedo,shadow", "-o", "a.png"}, "--aov shadow"},
        {{"--time-limit", "0"}, "--time-limit 0"},
        {{"--time-limit", "nan"}, "--time-limit nan"},
        {{"--target-error", "-1"}, "--target-error -1"},
        {{"--save-every", "5"}, "--save-every"},
        {{"--save-every", "inf", "-o", "a.png"}, "--save-every inf"},
        {{"--threads", "x"}, "--threads x"},
        {{"--policy", "unseq"}, "par, seq or par_unseq"},
        {{"--engine", "gpu"}, "multi or single"},
        {{"--engine", "single", "--policy", "par"}, "contradicts"},
        {{"--device", "0"}, "a flag of ray-tracing-gpu"},
        {{"--list-devices"}, "a flag of ray-tracing-gpu"},
        {{"--headless", "--validation"}, "a flag of ray-tracing-gpu"},
        {{"--features", "spheres,teapots"}, "--features teapots"},
        {{"--features", "spheres"}, "the scene also needs quads"},
        {{"--config", "missing.json"}, "missing.json"},
        {{"--json"}, "--list-scenes"},
        {{"-o", "a.gif"}, "a.gif"},
        {{"-o", "image"}, "image"},
        {{"-o", ""}, "--output"},
    };
    for (const auto& [arguments, mentioning] : cases) {
        Arguments all = {"--headless"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        EXPECT_TRUE(failsWith(cpu(all), 2, mentioning)) << arguments[0];
    }
    EXPECT_EQ(cpu({"--spp"}).exitCode, 2); // without its value
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(CommandLine, EveryChoiceOfEveryFlagRenders) {
    const std::vector<std::pair<std::string, Arguments>> choices = {
        {"--light-sampling", {"mis", "mis-balance", "mixture", "bsdf"}},
        {"--light-selection", {"contribution", "power", "uniform"}},
        {"--sphere-light", {"auto", "cone", "area"}},
        {"--quad-light", {"auto", "solid-angle", "area"}},
        {"--triangle-light", {"auto", "solid-angle", "area"}},
        {"--sampler", {"sobol", "sobol-blue", "stratified", "independent"}},
        {"--one-sided-lights", {"on", "off"}},
        {"--russian-roulette", {"on", "off"}},
        {"--tonemap", {"none", "reinhard", "aces"}},
        {"--policy", {"par", "seq", "par_unseq"}},
        {"--engine", {"multi", "single"}},
        {"--features", {"auto", "all"}},
        {"--max-depth", {"1", "4096"}},
        {"--seed", {"0", "4294967295"}},
        {"--replicates", {"1", "2"}},
        {"--exposure", {"-1.5", "2"}},
        {"--threads", {"0", "1", "3"}},
    };
    for (const auto& [flag, values] : choices)
        for (const std::string& value : values) {
            const Outcome outcome = render({flag, value, "--spp", "2", "-o", "a.png", "--stats", "stats.json"});
            EXPECT_EQ(outcome.exitCode, 0) << flag << " " << value << ": " << outcome.err;
            EXPECT_EQ(outcome.out + outcome.err, "");
            const auto settings = jsonOf("stats.json")["settings"];
            std::string key = flag.substr(2);
            std::replace(key.begin(), key.end(), '-', '_');
            if (settings.contains(key) && settings[key].is_string()) {
                EXPECT_TRUE(settings[key] == value || key == "features") << flag;
            }
        }
}

TEST_F(CommandLine, ConfigurationAndEnvironment) {
    writeFile("mine.json", R"({"spp": 3, "threads": 1, "quiet": true})");
    const Arguments common = {"--config", "mine.json", "--headless", "--width", "16", "--stats", "stats.json"};
    const auto statistics = [&](Arguments more, const Environment& environment) {
        more.insert(more.begin(), common.begin(), common.end());
        const Outcome outcome = cpu(more, environment);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        return jsonOf("stats.json");
    };
    EXPECT_EQ(statistics({}, {})["spp"], 3);
    EXPECT_EQ(statistics({}, {})["threads"], 1);
    EXPECT_EQ(statistics({}, {{"RT_THREADS", "2"}})["threads"], 2);
    EXPECT_EQ(statistics({"--threads", "3"}, {{"RT_THREADS", "2"}})["threads"], 3);
    EXPECT_EQ(statistics({"--spp", "5"}, {})["spp"], 5);
    EXPECT_TRUE(failsWith(render({}, {{"RT_THREADS", "0x2"}}), 2, "RT_THREADS 0x2"));
    EXPECT_TRUE(failsWith(render({}, {{"RT_LOG", "loud"}}), 2, "RT_LOG loud"));
    writeFile("broken.json", "{\"spp\": ");
    EXPECT_TRUE(failsWith(render({"--config", "broken.json"}), 2, "broken.json"));

    // The user's own file, which --no-config ignores.
    std::filesystem::create_directories(folder_ / "config" / "ray-tracing");
    writeFile("config/ray-tracing/config.toml", "replicates = 2\n");
    EXPECT_EQ(render({"--stats", "stats.json"}).exitCode, 0);
    EXPECT_EQ(jsonOf("stats.json")["settings"]["replicates"], 2);
    EXPECT_EQ(render({"--stats", "stats.json", "--no-config"}).exitCode, 0);
    EXPECT_EQ(jsonOf("stats.json")["settings"]["replicates"], 1);
}

TEST_F(CommandLine, ProgressGoesToStandardErrorOnly) {
    const Arguments arguments = {"--width", "16", "--spp", "2", "-o", "a.png"};
    const Outcome told = cpu(arguments);
    EXPECT_EQ(told.out, "");
    EXPECT_NE(told.err.find("2 spp in "), std::string::npos);
    EXPECT_EQ(told.err.find('\r'), std::string::npos); // no terminal
    EXPECT_EQ(told.err.find('\033'), std::string::npos);
    Arguments quiet = arguments;
    quiet.push_back("-q");
    EXPECT_EQ(cpu(quiet).err, "");
}

TEST_F(CommandLine, AShutterOfASceneThatStandsStillIsTold) {
    const Outcome outcome = cpu({"--width", "8", "--spp", "1", "--shutter", "0,0.1", "-o", "a.png"});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("--shutter counts for nothing"), std::string::npos) << outcome.err;
}

TEST_F(CommandLine, LogFile) {
    EXPECT_EQ(render({"-v", "--log-file", "log.txt"}).exitCode, 0);
    EXPECT_TRUE(std::filesystem::exists(path("log.txt")));
    EXPECT_TRUE(failsWith(render({"--log-file", "."}), 1, "log")); // a folder
}

} // namespace
} // namespace rt::test
