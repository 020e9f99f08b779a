// Flags of the environment and of configuration files: order of precedence, and errors that name file and line.
#include <algorithm>

#include "Common/Manual/Page.h"
#include "tests/unit/OptionsFixture.h"

namespace rt::app {
namespace {

class OptionsFileTest : public OptionsFixture {};

// A configuration file speaks of all renders: those that cannot be denoised are made all the same.
TEST_F(OptionsFileTest, AFileMayAskForDenoising) {
    const auto asked = [this](const std::string& value, std::vector<std::string> more) {
        more.insert(more.end(), {"--config", writeFile("c.json", "{\"denoise\": " + value + "}")});
        return render(std::move(more));
    };
    for (const char* value : {"true", "\"on\""}) EXPECT_TRUE(asked(value, {"-o", "a.pfm"}).wants(Aov::Denoised));
    for (const char* value : {"false", "\"off\""}) EXPECT_FALSE(asked(value, {"-o", "a.pfm"}).denoises()) << value;
    EXPECT_TRUE(asked("\"only\"", {"-o", "a.pfm"}).denoisedOnly);
    EXPECT_FALSE(asked("true", {"-o", "a.pfm", "--denoise", "off"}).denoises());
    EXPECT_FALSE(asked("\"only\"", {"-o", "a.pfm", "--spp", "1"}).denoises());
    EXPECT_FALSE(asked("true", {"-o", "a.pfm", "--tiles", "1/2"}).denoises());
    EXPECT_FALSE(asked("true", {"--stats", "s.json"}).denoises());
    EXPECT_FALSE(read({"--config", writeFile("c.json", R"({"denoise": true})"), "--window"}).value().denoises());
    EXPECT_NE(error({"--config", writeFile("c.json", R"({"denoise": "much"})")}).find("c.json"), std::string::npos);
}

TEST_F(OptionsFileTest, EnvironmentCountsBetweenFlagAndFile) {
    const std::string file = writeFile("c.json", R"({"threads": 5, "spp": 11})");
    EXPECT_EQ(render({"--config", file}).threads, 5u);
    test::setVariable("RT_THREADS", "3");
    EXPECT_EQ(render({"--config", file}).threads, 3u);
    EXPECT_EQ(render({"--config", file}).settings.spp, 11u);
    EXPECT_EQ(render({"--config", file, "--threads", "2"}).threads, 2u);
    test::setVariable("RT_THREADS", "many");
    EXPECT_EQ(error({}), "RT_THREADS many: must be a whole number from 0 to 4096");
}

// What a line said, or was refused for, is forgotten with the next one.
TEST_F(OptionsFileTest, AParserReadsEachLineAsIfItWereTheFirst) {
    OptionParser parser("ray-tracing-cpu");
    std::ostringstream out;
    const std::string bad = writeFile("bad.toml", "# mine\nspp = 0\n");
    EXPECT_THROW(parser.parse({"--config", bad}, out), UsageError);
    try {
        parser.parse({"--no-config", "--spp", "0"}, out);
        ADD_FAILURE() << "taken";
    } catch (const UsageError& error) { // no longer of the file
        EXPECT_EQ(std::string(error.what()).rfind("--spp 0: ", 0), 0u) << error.what();
    }
    const Options full = parser
                             .parse({"--no-config", "--headless", "--spp", "7", "--width=9", "--region", "1,2,3,4",
                                     "-o", "a.png", "-o", "b.png", "--aov", "depth", "--time-limit", "3", "--quiet"},
                                    out)
                             .value();
    EXPECT_EQ(full.outputs, (std::vector<std::string>{"a.png", "b.png"}));
    EXPECT_THROW(parser.parse({"--no-config", "--unknown"}, out), UsageError);
    EXPECT_FALSE(parser.parse({"--version"}, out));

    const Options none = parser.parse({"--headless"}, out).value();
    EXPECT_EQ(none.settings, RenderSettings{});
    EXPECT_EQ(none.size, SizeRequest{});
    EXPECT_TRUE(none.keepsUserFiles && !none.quiet && !none.region && !none.timeLimit);
    EXPECT_TRUE(none.outputs.empty() && none.aovs.empty() && none.given.empty());
}

TEST_F(OptionsFileTest, ConfigurationFiles) {
    const std::string json =
        writeFile("c.json", R"({"spp": 5, "sampler": "stratified", "quiet": true, "aov": ["depth", "albedo"],
                                "output": ["a.png", "b.exr"], "exposure": -0.5})");
    const std::string toml =
        writeFile("c.toml",
                  "# ours\nspp = 5\nsampler = \"stratified\"\nquiet = true\naov = [\"depth\", \"albedo\"]\n"
                  "output = [\"a.png\", \"b.exr\"]\nexposure = -0.5\n");
    for (const std::string& file : {json, toml}) {
        const Options options = render({"--config", file});
        EXPECT_EQ(options.settings.spp, 5u);
        EXPECT_EQ(options.settings.sampler, SamplerKind::Stratified);
        EXPECT_TRUE(options.quiet);
        EXPECT_EQ(options.aovs, (std::vector<Aov>{Aov::Depth, Aov::Albedo}));
        EXPECT_EQ(options.outputs, (std::vector<std::string>{"a.png", "b.exr"}));
        EXPECT_EQ(options.exposure, -0.5f);
        EXPECT_EQ(render({"--config", file, "--spp", "6"}).settings.spp, 6u);
    }
}

TEST_F(OptionsFileTest, TheUsersConfigurationIsReadUnlessRefused) {
    const std::string own = writeFile("ray-tracing/config.json", R"({"spp": 13})");
    EXPECT_EQ(render({}).settings.spp, 13u);
    EXPECT_EQ(render({"--no-config"}).settings.spp, 100u);
    EXPECT_EQ(error({"--config=" + own, "--no-config"}), "--no-config: contradicts --config");
    const manual::Page page = OptionParser("ray-tracing-cpu").page(); // which is for everybody
    EXPECT_EQ(manual::findFlag(page, "--config")->byDefault, "");
    writeFile("ray-tracing/config.toml", "spp = 17\n");
    EXPECT_EQ(render({}).settings.spp, 17u);
    writeFile("ray-tracing/config.toml", "spp = zero\n");
    EXPECT_NE(error({}).find("config.toml:1: --spp zero: must be"), std::string::npos);
}

TEST_F(OptionsFileTest, BadConfigurationFilesAreNamed) {
    const std::string missing = (home_ / "missing.json").string();
    EXPECT_EQ(error({"--config", missing}), "--config " + missing + ": cannot be read");
    for (const char* text :
         {"{\"spp\": 5", "{\"spp\": {\"a\": 1}}", "{\"samples_per_pixel\": 5}", "{\"spp\": 0}",
          "{\"list-scenes\": true}", "{\"spp\": []}", "{\"quiet\": 1}", "{\"spp\": 5, \"spp\": 6}"}) {
        const std::string file = writeFile("bad", text);
        EXPECT_EQ(error({"--config", file}).rfind(file + ":", 0), 0u) << text << " -> " << error({"--config", file});
    }
    const std::string file = writeFile("lines", "");
    const auto second = [&](const std::string& line) { // the error of a line, which is the file's second
        writeFile("lines", "# mine\n" + line + "\nwidth = 64\n");
        const std::string message = error({"--config", file});
        EXPECT_EQ(message.rfind(file + ":2: ", 0), 0u) << line << " -> " << message;
        return message.substr(std::min(message.size(), (file + ":2: ").size()));
    };
    EXPECT_EQ(second("films = 3"), "\"films\" is no flag; --help-all lists them all");
    EXPECT_EQ(second("x = 3"), "\"x\" is no flag; --help-all lists them all");
    EXPECT_EQ(second("list-scenes = true"), "\"list-scenes\" can be given on the command line only");
    EXPECT_EQ(second("quiet = maybe"), "--quiet maybe: must be true or false");
    EXPECT_EQ(second("device = 0"), "--device: a flag of ray-tracing-gpu");
    EXPECT_EQ(second("output = \"\""), "--output '': must be the name of a file");
    EXPECT_EQ(second("spp = [5, 6]").rfind("--spp 5,6: must be a whole number", 0), 0u);
    EXPECT_LT(second("spp = " + std::string(100'000, '7')).size(), 200u);
    writeFile("lines", std::string(2'000'000, ' '));
    EXPECT_EQ(error({"--config", file}), "--config " + file + ": must be of at most 1048576 bytes");
    const std::string folder = home_.string();
    EXPECT_EQ(error({"--config", folder}), "--config " + folder + ": cannot be read");
    const std::string good = writeFile("good.json", "{}");
    EXPECT_EQ(error({"--config", good}), "no error");
    EXPECT_EQ(error({"--config", good, "--no-config"}), "--no-config: contradicts --config");
}

} // namespace
} // namespace rt::app
