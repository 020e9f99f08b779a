// ray-tracing-gpu as a user meets it. Tests fail where no device traces rays.
#ifdef RT_HAS_GPU

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <vulkan/vulkan.h>

#include "Common/Image/ImageIo.h"
#include "tests/program/Program.h"

namespace rt::test {
namespace {

class Gpu : public ProgramTest {
  protected:
    // A picture of 32x32 pixels, silently.
    Outcome gpu(const Arguments& arguments, const Environment& environment = {}) const {
        Arguments all = {"-q", "--headless", "--width", "32", "--height", "32", "--spp", "4"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        return run("ray-tracing-gpu", all, environment);
    }
    // The picture as the bytes of a PFM file; the render must succeed.
    std::string picture(Arguments arguments) const {
        arguments.insert(arguments.end(), {"-o", "picture.pfm"});
        const Outcome outcome = gpu(arguments);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        return bytesOf("picture.pfm");
    }
};

TEST_F(Gpu, ListsDevices) {
    const Outcome outcome = run("ray-tracing-gpu", {"--list-devices"});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(outcome.out.rfind("0: ", 0), 0u) << outcome.out;
    EXPECT_NE(outcome.out.find("pipeline, compute: suitable\n"), std::string::npos) << outcome.out;
}

// "1.3.239"
std::string loaderVersion() {
    std::uint32_t version = 0;
    vkEnumerateInstanceVersion(&version);
    return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
           std::to_string(VK_API_VERSION_PATCH(version));
}

// A damaged file is no driver to some loaders, and memory that ran out to others.
TEST_F(Gpu, WithoutADriverSaysSo) {
    SCOPED_TRACE("Vulkan's loader " + loaderVersion());
    const Environment none = {{"VK_DRIVER_FILES", "/none.json"}, {"VK_ICD_FILENAMES", "/none.json"}};
    EXPECT_TRUE(failsWith(run("ray-tracing-gpu", {"--list-devices"}, none), 4, "no Vulkan driver"));
    writeFile("words.json", "no driver is here");
    const Environment damaged = {{"VK_DRIVER_FILES", path("words.json")}, {"VK_ICD_FILENAMES", path("words.json")}};
    EXPECT_TRUE(failsWith(run("ray-tracing-gpu", {"--list-devices"}, damaged), 4, "a driver's file is damaged"));
    EXPECT_TRUE(failsWith(gpu({"-o", "a.png"}, none), 4, "no Vulkan driver"));
}

TEST_F(Gpu, DevicesThatDoNotExist) {
    for (const char* device : {"no-such-device", "99", "-1", "0x0"}) {
        EXPECT_TRUE(failsWith(gpu({"-o", "a.png", "--device", device}), 4, "'" + std::string(device) + "'")) << device;
        EXPECT_TRUE(failsWith(gpu({"-o", "a.png"}, {{"RT_DEVICE", device}}), 4, device)) << device;
    }
    EXPECT_FALSE(std::filesystem::exists(path("a.png")));
}

TEST_F(Gpu, FlagsOfTheOtherEngine) {
    EXPECT_TRUE(failsWith(gpu({"-o", "a.png", "--threads", "2"}), 2, "--threads"));
    EXPECT_TRUE(failsWith(gpu({"-o", "a.png", "--engine", "multi"}), 2, "--engine"));
}

TEST_F(Gpu, StatisticsNameWhatWasSkipped) {
    EXPECT_EQ(gpu({"-o", "a.pfm", "--stats", "s.json", "--replicates", "2", "--engine", "pipeline"}).exitCode, 0);
    const auto stats = jsonOf("s.json");
    EXPECT_EQ(stats["app"], "ray-tracing-gpu");
    EXPECT_EQ(stats["engine"], "pipeline");
    EXPECT_EQ(stats["spp_done"], 4);
    EXPECT_GT(stats["seconds"]["render_device"], 0.0);
    EXPECT_GT(stats["seconds"]["accel_build"], 0.0);
    EXPECT_GT(stats["memory"]["device_bytes"], 0);
    EXPECT_EQ(stats["rays"]["camera"], 32 * 32 * 4);
    for (const char* feature : {"triangles", "textures", "volumes"}) {
        EXPECT_EQ(std::count(stats["skipped"].begin(), stats["skipped"].end(), feature), 1) << feature;
    }
    std::string more = "textures";
    for (const auto& feature : stats["features"]) more += "," + feature.get<std::string>();
    EXPECT_EQ(gpu({"-o", "b.pfm", "--stats", "s.json", "--engine", "pipeline", "--features", more}).exitCode, 0);
    const auto forced = jsonOf("s.json");
    EXPECT_EQ(std::count(forced["skipped"].begin(), forced["skipped"].end(), "textures"), 0);
    EXPECT_EQ(std::count(forced["skipped"].begin(), forced["skipped"].end(), "volumes"), 1);
    EXPECT_EQ(forced["settings"]["features"], "forced");
}

// Drivers compile all code there is for tens of seconds.
class NightlyGpu : public Gpu {};

TEST_F(NightlyGpu, EveryFeatureCanBeForced) {
    const Arguments whole = {"-o", "b.pfm", "--stats", "s.json", "--engine", "pipeline", "--features", "all"};
    EXPECT_EQ(gpu(whole).exitCode, 0);
    EXPECT_TRUE(jsonOf("s.json")["skipped"].empty());
    EXPECT_EQ(jsonOf("s.json")["settings"]["features"], "forced");
}

TEST_F(Gpu, TheImageDependsOnNothingButSettings) {
    for (const char* engine : {"pipeline", "compute"}) {
        const std::string expected = picture({"--engine", engine});
        EXPECT_TRUE(picture({"--engine", engine, "--device", "0", "-v"}) == expected) << engine;
        EXPECT_FALSE(picture({"--engine", engine, "--seed", "1"}) == expected) << engine;
    }
}

TEST_F(Gpu, TheStatisticsNameTheEngine) {
    EXPECT_EQ(gpu({"--stats", "s.json", "--engine", "compute"}).exitCode, 0);
    EXPECT_EQ(jsonOf("s.json")["engine"], "compute");
    EXPECT_EQ(jsonOf("s.json")["kernel"], "list+quads+spheres");
    EXPECT_FALSE(jsonOf("s.json").contains("engine_choice"));
    EXPECT_EQ(gpu({"--stats", "s.json", "--engine", "auto"}).exitCode, 0);
    const auto stats = jsonOf("s.json");
    const auto& rates = stats["engine_choice"]["rays_per_second"];
    for (const auto& [engine, rate] : rates.items()) EXPECT_LE(rate, rates[stats["engine"]]) << engine;
}

// Whatever lies where the compiled pipelines are kept.
TEST_F(Gpu, ADamagedPipelineCacheIsNoError) {
    const Environment cache = {{"XDG_CACHE_HOME", path("cache")}};
    ASSERT_EQ(gpu({"-o", "a.pfm", "--engine", "compute"}, cache).exitCode, 0);
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(path("cache/ray-tracing"))) {
        ++files;
        std::ofstream(entry.path(), std::ios::binary) << "garbage";
    }
    EXPECT_EQ(files, 1u);
    const Outcome outcome = gpu({"-o", "b.pfm", "--engine", "compute"}, cache);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_TRUE(bytesOf("a.pfm") == bytesOf("b.pfm"));
}

TEST_F(Gpu, GoesOnFromACheckpointAsIfNeverStopped) {
    ASSERT_EQ(gpu({"--spp", "21", "-o", "part.pfm", "--checkpoint", "c.rtc"}).exitCode, 0);
    EXPECT_TRUE(picture({"--spp", "50", "--resume", "c.rtc"}) == picture({"--spp", "50"}));
    EXPECT_TRUE(failsWith(
        cpu({"-q", "--headless", "--width", "32", "--height", "32", "--spp", "50", "--resume", "c.rtc", "-o", "a.pfm"}),
        3, "engine"));
}

TEST_F(Gpu, DenoisesItsFilm) {
    const Outcome outcome =
        gpu({"--spp", "8", "--denoise", "-o", "a.pfm", "--aov", "wide-albedo,emission", "--stats", "s.json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_TRUE(image::readImage(path("a.pfm")).data != image::readImage(path("a.denoised.pfm")).data);
    for (const char* name : {"a.wide-albedo.pfm", "a.emission.pfm"}) EXPECT_TRUE(std::filesystem::exists(path(name)));
    const auto stats = jsonOf("s.json");
    EXPECT_LT(stats["denoised"]["estimated_relmse"].get<double>(), stats["estimated_relmse"].get<double>());
}

TEST_F(Gpu, WritesEveryImageWithoutAMessageOfTheValidationLayers) {
    const Outcome outcome = gpu({"--validation", "-o", "a.exr", "--aov", "albedo,normal,depth,variance,samples",
                                 "--checkpoint", "c.rtc", "--time-limit", "100"});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    for (const char* name :
         {"a.exr", "a.albedo.exr", "a.normal.exr", "a.depth.exr", "a.variance.exr", "a.samples.exr"}) {
        EXPECT_EQ(image::readImage(path(name)).width, 32u) << name;
    }
}

#ifdef RT_LAYER_DIR

// 10 000 meshes, each with an acceleration structure of its own, on a driver that allows no more allocations than
// Vulkan guarantees.
TEST_F(Gpu, TenThousandPrototypesNeedFewAllocations) {
    std::string mesh; // a strip of as many triangles as make a prototype worth its instances
    for (int i = 0; i <= 32; ++i)
        mesh += "v " + std::to_string(i / 40.0) + " 0 0\nv " + std::to_string(i / 40.0) + " 0.5 0\n";
    for (int i = 1; i < 65; i += 2) {
        const std::string a = std::to_string(i), b = std::to_string(i + 1), c = std::to_string(i + 2),
                          d = std::to_string(i + 3);
        mesh += "f " + a + " " + c + " " + d + "\nf " + a + " " + d + " " + b + "\n";
    }
    writeFile("strip.obj", mesh);
    nlohmann::json scene;
    scene["camera"] = {{"look_from", {0, 40, 80}}, {"look_at", {0, 0, 0}}, {"vertical_fov", 50}};
    scene["background"] = {{"type", "gradient"}, {"bottom", {1, 1, 1}}, {"top", {0.5, 0.7, 1}}};
    scene["materials"]["white"] = {{"type", "lambertian"}, {"albedo", {0.7, 0.7, 0.7}}};
    for (int i = 0; i < 10'000; ++i) {
        const std::string name = std::to_string(i);
        scene["prototypes"][name] = {{{"type", "mesh"}, {"file", "strip.obj"}, {"material", "white"}}};
        for (const int y : {0, 2}) {
            const nlohmann::json step = {{"translate", {i % 100 - 50, y, i / 100 - 50}}};
            scene["objects"].push_back({{"type", "instance"}, {"prototype", name}, {"transform", {step}}});
        }
    }
    writeFile("many.json", scene.dump());
    const Environment limited = {{"VK_ADD_LAYER_PATH", RT_LAYER_DIR},
                                 {"VK_INSTANCE_LAYERS", "VK_LAYER_RT_faults"},
                                 {"RT_MAX_ALLOCATIONS", "4096"}};
    const Arguments arguments = {"--scene", "many.json", "--engine", "pipeline", "--spp",
                                 "1",       "-o",        "a.pfm",    "--stats",  "s.json"};
    const Outcome outcome = gpu(arguments, limited);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(jsonOf("s.json")["kernel"], "paths+triangles");
    EXPECT_EQ(jsonOf("s.json")["spp_done"], 1);
    // The limit holds.
    const Environment none = {
        {"VK_ADD_LAYER_PATH", RT_LAYER_DIR}, {"VK_INSTANCE_LAYERS", "VK_LAYER_RT_faults"}, {"RT_MAX_ALLOCATIONS", "0"}};
    EXPECT_TRUE(failsWith(gpu({"-o", "b.pfm"}, none), 1, "too many objects"));
}

#endif

TEST_F(Gpu, EnginesDrawTheSamePicture) {
    ASSERT_EQ(gpu({"-o", "gpu.pfm", "--spp", "16"}).exitCode, 0);
    ASSERT_EQ(cpu({"-q", "--headless", "--width", "32", "--height", "32", "--spp", "16", "-o", "cpu.pfm"}).exitCode, 0);
    const Outcome diff =
        run("ray-tracing-image", {"diff", "gpu.pfm", "cpu.pfm", "--metric", "relmse", "--max", "1e-3"});
    EXPECT_EQ(diff.exitCode, 0) << diff.out << diff.err;
}

} // namespace
} // namespace rt::test

#endif
