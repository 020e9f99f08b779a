// Flags: values, defaults, what contradicts, and the one line that each error is.
#include <iostream>
#include <set>
#include <sstream>

#include "Common/App/Session/FeatureNames.h"
#include "Common/Shared/Base/Features.h"
#include "tests/unit/OptionsFixture.h"

namespace rt::app {
namespace {

class OptionsTest : public OptionsFixture {};

TEST_F(OptionsTest, AnAspectOutOfRangeIsOfWhoGaveIt) {
    EXPECT_THROW(sized({}, 1e-6), InputError);
    EXPECT_THROW(sized({"--width", "700"}, 1e-6), UsageError);
    EXPECT_THROW(sized({"--height", "700"}, 1e6), UsageError);
    EXPECT_EQ(sized({"--width", "700", "--height", "70"}, 1e-6).settings.height, 70u);
    EXPECT_EQ(sized({"--aspect", "2"}, 1e-6).settings.height, 300u);
}

TEST_F(OptionsTest, DefaultsAreThoseOfTheInterface) {
    const Options options = sized({});
    EXPECT_EQ(options.command, Command::Render);
    EXPECT_EQ(options.scene, "cornell-box-lights");
    EXPECT_EQ(options.settings, RenderSettings{});
    EXPECT_TRUE(options.oneSidedLights);
    EXPECT_EQ(options.threads, 0u);
    EXPECT_EQ(options.policy, Policy::Par);
    EXPECT_EQ(options.exposure, 0.0f);
    EXPECT_EQ(options.tonemap, Tonemap::None);
    EXPECT_TRUE(options.outputs.empty() && options.checkpoint.empty() && options.stats.empty());
}

TEST_F(OptionsTest, EveryFlagReachesItsSetting) {
    const Options options = render({"--scene",
                                    "furnace",
                                    "--spp",
                                    "7",
                                    "--max-depth",
                                    "9",
                                    "--light-sampling",
                                    "mixture",
                                    "--light-selection",
                                    "power",
                                    "--sphere-light",
                                    "cone",
                                    "--quad-light",
                                    "area",
                                    "--triangle-light",
                                    "solid-angle",
                                    "--sampler",
                                    "stratified",
                                    "--one-sided-lights",
                                    "off",
                                    "--russian-roulette",
                                    "off",
                                    "--seed",
                                    "4294967295",
                                    "--replicates",
                                    "3",
                                    "-o",
                                    "a.png",
                                    "--output",
                                    "b.exr",
                                    "--exposure",
                                    "-1.5",
                                    "--tonemap",
                                    "aces",
                                    "--aov",
                                    "albedo,samples",
                                    "--reference",
                                    "r.pfm",
                                    "--stats",
                                    "-",
                                    "--time-limit",
                                    "2.5",
                                    "--save-every",
                                    "60",
                                    "--checkpoint",
                                    "c.rtc",
                                    "--resume",
                                    "d.rtc",
                                    "--threads",
                                    "2",
                                    "--policy",
                                    "par_unseq",
                                    "--engine",
                                    "multi",
                                    "-q",
                                    "-v",
                                    "--log-file",
                                    "log.txt"});
    const RenderSettings& settings = options.settings;
    EXPECT_EQ(options.scene, "furnace");
    EXPECT_EQ(settings.spp, 7u);
    EXPECT_EQ(settings.maxDepth, 9u);
    EXPECT_EQ(settings.lightSampling, LightSampling::Mixture);
    EXPECT_EQ(settings.lightSelection, LightSelection::Power);
    EXPECT_EQ(settings.sphereLight, ShapeSampling::SolidAngle);
    EXPECT_EQ(settings.quadLight, ShapeSampling::Area);
    EXPECT_EQ(settings.triangleLight, ShapeSampling::SolidAngle);
    EXPECT_EQ(settings.sampler, SamplerKind::Stratified);
    EXPECT_FALSE(settings.russianRoulette);
    EXPECT_EQ(settings.seed, 4294967295u);
    EXPECT_EQ(settings.replicates, 3u);
    EXPECT_FALSE(settings.sppIsKnown);
    EXPECT_FALSE(options.oneSidedLights);
    EXPECT_EQ(options.outputs, (std::vector<std::string>{"a.png", "b.exr"}));
    EXPECT_EQ(options.exposure, -1.5f);
    EXPECT_EQ(options.tonemap, Tonemap::Aces);
    EXPECT_EQ(options.aovs, (std::vector<Aov>{Aov::Albedo, Aov::Samples}));
    EXPECT_EQ(options.reference, "r.pfm");
    EXPECT_EQ(options.stats, "-");
    EXPECT_EQ(options.timeLimit, 2.5);
    EXPECT_EQ(options.saveEvery, 60.0);
    EXPECT_EQ(options.checkpoint, "c.rtc");
    EXPECT_EQ(options.resume, "d.rtc");
    EXPECT_EQ(options.threads, 2u);
    EXPECT_EQ(options.policy, Policy::ParUnseq);
    EXPECT_TRUE(options.quiet && options.verbose);
    EXPECT_EQ(options.logFile, "log.txt");
}

TEST_F(OptionsTest, AliasesAndRepetition) {
    const Options options = render({"--samples=3", "--outfile", "a.png", "--spp", "4", "-oc.hdr"});
    EXPECT_EQ(options.settings.spp, 4u); // the last one wins
    EXPECT_EQ(options.outputs, (std::vector<std::string>{"a.png", "c.hdr"}));
}

TEST_F(OptionsTest, ErrorsNameFlagValueAndWhatIsAllowed) {
    EXPECT_EQ(error({"--spp", "0"}), "--spp 0: must be a whole number from 1 to 2147483647");
    EXPECT_EQ(error({"--spp", "2147483648"}), "--spp 2147483648: must be a whole number from 1 to 2147483647");
    EXPECT_EQ(error({"--spp", "-5"}), "--spp -5: must be a whole number from 1 to 2147483647");
    EXPECT_EQ(error({"--spp", "1e3"}), "--spp 1e3: must be a whole number from 1 to 2147483647");
    EXPECT_EQ(error({"--spp", ""}), "--spp '': must be a whole number from 1 to 2147483647");
    EXPECT_EQ(error({"--max-depth", "4097"}), "--max-depth 4097: must be a whole number from 1 to 4096");
    EXPECT_EQ(error({"--width", "16385"}), "--width 16385: must be a whole number from 1 to 16384");
    EXPECT_EQ(error({"--height", "0"}), "--height 0: must be a whole number from 1 to 16384");
    EXPECT_EQ(error({"--seed", "4294967296"}), "--seed 4294967296: must be a whole number from 0 to 4294967295");
    EXPECT_EQ(error({"--sampler", "halton"}), "--sampler halton: must be sobol, sobol-blue, stratified or independent");
    EXPECT_EQ(error({"--russian-roulette", "yes"}), "--russian-roulette yes: must be on or off");
    EXPECT_EQ(error({"--aov", "albedo,colour", "-o", "a.png"}),
              "--aov colour: must be albedo, normal, depth, wide-albedo, wide-normal, wide-depth, emission, variance, "
              "samples, denoised or denoised-error");
    EXPECT_EQ(error({"--aov", "albedo,", "-o", "a.png"}), "--aov albedo,: must be a list like a,b,c");
    EXPECT_EQ(error({"-o", ""}), "--output '': must be the name of a file");
    EXPECT_EQ(error({"--films", "3"}), "--films: unknown flag; --help-all lists them all");
    EXPECT_EQ(error({"cornell"}), "cornell: unknown flag; --help-all lists them all");
    for (const char* bad : {"nan", "inf", "-inf", "0", "-1", "1e400", "x", ""})
        EXPECT_EQ(error({"--time-limit", bad}).rfind("--time-limit ", 0), 0u) << bad;
    for (const char* bad : {"nan", "inf", "1e9", "one", "1e", "1,5", " 1", "1 ", "0x10", "1.5.2"})
        EXPECT_EQ(error({"--exposure", bad}).rfind("--exposure ", 0), 0u) << bad;
    EXPECT_NE(error({"--spp"}), "no error"); // the value is missing: --headless is taken for it
}

TEST_F(OptionsTest, AWindowIsTheDefaultUnlessAFileOrALimitIsAskedFor) {
    const auto window = [](std::vector<std::string> arguments) {
        return parseOptions("ray-tracing-cpu", std::move(arguments), std::cout).value().window;
    };
    EXPECT_TRUE(window({}));
    EXPECT_TRUE(window({"--spp", "10"}));
    EXPECT_TRUE(window({"--validation"}));
    EXPECT_FALSE(window({"--headless"}));
    EXPECT_FALSE(window({"-o", "a.png"}));
    EXPECT_FALSE(window({"--stats", "-"}));
    EXPECT_FALSE(window({"--time-limit", "1"}));
    EXPECT_TRUE(window({"-o", "a.png", "--window"}));
    EXPECT_TRUE(window({"--time-limit", "1", "--window"}));
    EXPECT_THROW(window({"--resume", "a.rtc"}), UsageError);
    EXPECT_TRUE(window({"--stats", "-", "--window"}));
    EXPECT_TRUE(window({"-o", "a.png", "--aov", "depth", "--window"}));
    EXPECT_THROW(window({"-o", "a.png", "--window", "--save-every", "1"}), UsageError);
    EXPECT_TRUE(window({"--target-error", "1", "--window"}));
}

TEST_F(OptionsTest, TellsWhichSettingsWereGiven) {
    const Options options =
        parseOptions("ray-tracing-cpu", {"--spp", "100", "--scene", "veach-mis"}, std::cout).value();
    EXPECT_EQ(options.given, (std::set<std::string>{"--spp", "--scene"}));
}

TEST_F(OptionsTest, FlagsThatMakeNoSenseSaySo) {
    EXPECT_EQ(error({"--device", "0"}), "--device: a flag of ray-tracing-gpu");
    EXPECT_EQ(error({"--list-devices"}), "--list-devices: a flag of ray-tracing-gpu");
    EXPECT_EQ(error({"--validation"}), "--validation: a flag of ray-tracing-gpu, or of a window");
    EXPECT_EQ(error({"--window"}), "--window: contradicts --headless");
    EXPECT_EQ(error({"--engine", "compute"}), "--engine compute: must be multi or single");
    EXPECT_EQ(render({"--sphere-light", "projected"}).settings.sphereLight, ShapeSampling::Projected);
    for (const auto& implied :
         std::vector<std::vector<std::string>>{{"-o", "a.png"}, {"--stats", "-"}, {"--time-limit", "1"}})
        EXPECT_TRUE(read(implied).has_value()) << implied[0];
}

TEST_F(OptionsTest, ContradictionsAreRefused) {
    EXPECT_EQ(error({"--engine", "single", "--policy", "par"}), "--policy par: contradicts --engine single");
    EXPECT_EQ(error({"--engine", "multi", "--policy", "seq"}), "--policy seq: contradicts --engine multi");
    EXPECT_EQ(render({"--engine", "single"}).policy, Policy::Seq);
    EXPECT_EQ(render({"--engine", "single", "--policy", "seq"}).policy, Policy::Seq);
    EXPECT_EQ(error({"--json"}), "--json: only with --list-scenes");
    EXPECT_EQ(error({"--aov", "depth"}), "--aov: needs --output");
    EXPECT_EQ(error({"--save-every", "5"}), "--save-every: needs --checkpoint or --output");
    EXPECT_EQ(error({"--replicates", "8", "--spp", "7"}), "--replicates 8: must be at most --spp 7");
    EXPECT_EQ(error({"--replicates", "3", "--adaptive", "on"}),
              "--replicates 3: must be even with --adaptive on, which makes two halves of them");
    EXPECT_EQ(error({"--sampler", "stratified", "--adaptive", "on"}),
              "--adaptive on: not with --sampler stratified, whose strata are made for one number of samples");
    EXPECT_EQ(read({"--list-scenes", "--json"})->command, Command::ListScenes);
    EXPECT_EQ(read({"--export-scene", "a.json"})->command, Command::ExportScene);
}

TEST_F(OptionsTest, AnyTwoOfWidthHeightAspectGiveTheSize) {
    const auto size = [](const Options& options) { return std::pair(options.settings.width, options.settings.height); };
    EXPECT_EQ(size(sized({})), std::pair(600u, 600u));
    EXPECT_EQ(size(sized({}, 1.5)), std::pair(600u, 400u));
    EXPECT_EQ(size(sized({"--aspect", "2"}, 1.5)), std::pair(600u, 300u));
    EXPECT_EQ(size(sized({"--width", "32"}, 2)), std::pair(32u, 16u));
    EXPECT_EQ(size(sized({"--height", "32"}, 2)), std::pair(64u, 32u));
    EXPECT_EQ(size(sized({"--height", "50", "--aspect", "0.5"})), std::pair(25u, 50u));
    EXPECT_EQ(size(sized({"--width", "7", "--height", "3"}, 2)), std::pair(7u, 3u));
    EXPECT_EQ(size(sized({"--width", "160", "--height", "90", "--aspect", "1.7777778"})), std::pair(160u, 90u));
    EXPECT_EQ(size(sized({"--width", "1", "--aspect", "100"})), std::pair(1u, 1u));
    EXPECT_EQ(error({"--width", "160", "--height", "90", "--aspect", "2"}),
              "--aspect: contradicts --width 160 --height 90");
    EXPECT_EQ(error({"--height", "16384", "--aspect", "2"}),
              "--height 16384: makes an image larger than 16384 pixels a side");
    EXPECT_EQ(error({"--aspect", "0"}), "--aspect 0: must be a number from 1/16384 to 16384");
}

TEST_F(OptionsTest, ErrorEstimatesAreKeptOnlyWhereSomethingReadsThem) {
    EXPECT_FALSE(render({"-o", "a.png"}).settings.secondMoments);
    EXPECT_TRUE(render({"--stats", "-"}).settings.secondMoments);
    EXPECT_TRUE(render({"-o", "a.exr", "--aov", "variance"}).settings.secondMoments);
    EXPECT_FALSE(render({"--stats", "-", "--replicates", "4"}).settings.secondMoments);
    EXPECT_EQ(render({"--target-error", "0.1"}).settings.replicates, 4u);
    EXPECT_EQ(render({"--target-error", "0.1", "--replicates", "8"}).settings.replicates, 8u);
    EXPECT_EQ(render({"--target-error", "0.1", "--adaptive", "on"}).settings.replicates, 4u);
    EXPECT_EQ(render({"--adaptive", "on"}).settings.replicates, 2u);
    EXPECT_EQ(render({"--adaptive", "on", "--spp", "15"}).settings.replicates, 1u); // too few for a pilot
    EXPECT_FALSE(render({"--target-error", "0.1"}).settings.sppIsKnown);
}

TEST_F(OptionsTest, CheckpointStandsBesideTheOutput) {
    EXPECT_EQ(render({"--save-every", "5", "-o", "dir/a.png"}).checkpoint, "dir/a.png.rtc");
    EXPECT_EQ(render({"--save-every", "5", "-o", "a.png", "--resume", "b.rtc"}).checkpoint, "b.rtc");
    EXPECT_EQ(render({"--save-every", "5", "-o", "a.png", "--checkpoint", "c.rtc"}).checkpoint, "c.rtc");
    EXPECT_EQ(render({"-o", "a.png"}).checkpoint, "");
}

TEST_F(OptionsTest, FeatureNames) {
    EXPECT_EQ(render({"--features", "auto"}).settings.features, std::nullopt);
    EXPECT_EQ(render({"--features", "all"}).settings.features, shared::kFeatureAll);
    EXPECT_EQ(render({"--features", "spheres,thin-lens"}).settings.features,
              shared::kFeatureSpheres | shared::kFeatureThinLens);
    EXPECT_EQ(error({"--features", "spheres,teapots"}).rfind("--features teapots: must be textures, spheres, ", 0), 0u);
    EXPECT_TRUE(absentFeatureNames(shared::kFeatureAll).empty());
    EXPECT_EQ(featureNames(shared::kFeatureNoise), (std::vector<std::string>{"textures", "noise"}));
    for (const std::string& name : featureNames(shared::kFeatureAll)) {
        const shared::Features bits = parseFeatures(name);
        EXPECT_NE(bits, shared::kFeatureNone) << name;
        if (name != "textures") {
            EXPECT_EQ(featureNames(bits).back(), name);
        }
    }
}

TEST_F(OptionsTest, HelpAndVersion) {
    std::ostringstream help, version;
    EXPECT_FALSE(parseOptions("ray-tracing-cpu", {"--help-all"}, help).has_value());
    for (const char* flag :
         {"--scene", "--light-sampling", "mis|mis-balance|mixture|bsdf", "--target-error", "--resume"})
        EXPECT_NE(help.str().find(flag), std::string::npos) << flag;
    EXPECT_FALSE(parseOptions("ray-tracing-cpu", {"--version"}, version).has_value());
    EXPECT_EQ(version.str().rfind("ray-tracing-cpu ", 0), 0u);
}

} // namespace
} // namespace rt::app
