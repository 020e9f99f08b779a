// Files that are missing, damaged or out of reach: one line, the documented exit code, nothing left behind.
#include <fstream>

#ifndef _WIN32
#include <sys/resource.h>
#include <sys/stat.h>
#endif

#include "Common/Image/ImageIo.h"
#include "tests/program/Program.h"

namespace rt::test {
namespace {

namespace fs = std::filesystem;

class BadInput : public ProgramTest {};

TEST_F(BadInput, Scenes) {
    EXPECT_TRUE(failsWith(render({"--scene", "cornell"}), 3, "cornell"));
    EXPECT_TRUE(failsWith(render({"--scene", "cornell-box-lights:5"}), 3, "cornell-box-lights"));
    EXPECT_TRUE(failsWith(render({"--scene", "missing.json"}), 3, "missing.json"));
    EXPECT_TRUE(failsWith(render({"--scene", "missing.obj"}), 3, "missing.obj"));
}

TEST_F(BadInput, NamesThatAreTooLong) {
    const std::string name(300, 'n');
    EXPECT_TRUE(failsWith(render({"-o", name + ".png"}), 1, "cannot write nnn"));
    EXPECT_TRUE(failsWith(render({"-o", name + "/a.png"}), 1, "cannot write nnn"));
    EXPECT_TRUE(failsWith(render({"--scene", name + ".json"}), 3, "cannot read nnn"));
    EXPECT_TRUE(failsWith(render({"--resume", name}), 3, "cannot read nnn"));
}

TEST_F(BadInput, AspectsOfScenes) {
    writeFile("thin.json", R"({"render": {"aspect": 1e-9}, "objects": []})");
    EXPECT_TRUE(failsWith(cpu({"-q", "--scene", "thin.json", "--headless", "--spp", "1"}), 3, "thin.json: an aspect"));
}

TEST_F(BadInput, ScenesThatAreNotTrusted) {
    fs::create_directories(folder_ / "theirs");
    writeFile("mine.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    writeFile("theirs/scene.json", R"({"objects": [{"type": "mesh", "file": "../mine.obj"}]})");
    EXPECT_EQ(render({"--scene", "theirs/scene.json"}).exitCode, 0);
    const Outcome refused = render({"--scene", "theirs/scene.json", "--assets-below", "theirs"});
    EXPECT_TRUE(failsWith(refused, 3, "mine.obj: --assets-below does not allow it"));
    EXPECT_EQ(render({"--scene", "theirs/scene.json", "--assets-below", "."}).exitCode, 0);
    EXPECT_TRUE(failsWith(render({"--assets-below", "none"}), 3, "--assets-below none"));
}

TEST_F(BadInput, References) {
    const Arguments reference = {"--stats", "s.json", "--reference"};
    const auto against = [&](const std::string& file) {
        Arguments all = reference;
        all.push_back(file);
        return render(all);
    };
    EXPECT_TRUE(failsWith(against("missing.exr"), 3, "missing.exr"));
    writeFile("empty.exr", "");
    EXPECT_TRUE(failsWith(against("empty.exr"), 3, "empty.exr"));
    writeFile("text.pfm", "PF 32 32 and then words");
    EXPECT_TRUE(failsWith(against("text.pfm"), 3, "text.pfm"));
    writeFile("huge.pfm", "PF\n60000 60000\n-1.0\n");
    EXPECT_TRUE(failsWith(against("huge.pfm"), 3, "huge.pfm"));
    ASSERT_EQ(render({"-o", "whole.exr"}).exitCode, 0);
    writeFile("half.exr", bytesOf("whole.exr").substr(0, bytesOf("whole.exr").size() / 2));
    EXPECT_TRUE(failsWith(against("half.exr"), 3, "half.exr"));
    image::writeImage(path("small.pfm"), image::Image(8, 8));
    EXPECT_TRUE(failsWith(against("small.pfm"), 3, "8x8"));
    image::writeImage(path("display.png"), image::Image(32, 32));
    EXPECT_TRUE(failsWith(against("display.png"), 3, "linear"));
    std::string nan = "PF\n32 32\n-1.0\n";
    for (int i = 0; i < 32 * 32 * 3; ++i) nan += std::string("\x00\x00\xc0\x7f", 4);
    writeFile("nan.pfm", nan);
    EXPECT_TRUE(failsWith(against("nan.pfm"), 3, "not finite"));
}

TEST_F(BadInput, Checkpoints) {
    EXPECT_TRUE(failsWith(render({"--resume", "missing.rtc"}), 3, "missing.rtc"));
    ASSERT_EQ(render({"--checkpoint", "c.rtc"}).exitCode, 0);
    const std::string whole = bytesOf("c.rtc");
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{9}, std::size_t{40}, whole.size() / 2, whole.size() - 1}) {
        writeFile("cut.rtc", whole.substr(0, size));
        EXPECT_TRUE(failsWith(render({"--resume", "cut.rtc"}), 3, "cut.rtc")) << size;
    }
    for (std::size_t at = 0; at < whole.size(); at += whole.size() / 97) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
        writeFile("damaged.rtc", damaged);
        EXPECT_TRUE(failsWith(render({"--resume", "damaged.rtc"}), 3, "damaged.rtc")) << at;
    }
}

TEST_F(BadInput, PlacesThatCannotBeWritten) {
    fs::create_directory(folder_ / "folder.png");
    EXPECT_TRUE(failsWith(render({"-o", "missing/a.png"}), 1, "missing/a.png"));
    EXPECT_TRUE(failsWith(render({"-o", "folder.png"}), 1, "folder.png"));
    EXPECT_TRUE(failsWith(render({"-o", "a.png", "-o", "missing/b.exr"}), 1, "missing/b.exr"));
    EXPECT_TRUE(failsWith(render({"--stats", "missing/s.json"}), 1, "missing/s.json"));
    EXPECT_TRUE(failsWith(render({"--checkpoint", "missing/c.rtc"}), 1, "missing/c.rtc"));
    // Before rendering: the first picture would take years, and is not there.
    EXPECT_TRUE(failsWith(render({"-o", "a.png", "-o", "missing/b.png", "--spp", "2147483647"}), 1, "missing/b.png"));
    EXPECT_FALSE(fs::exists(path("a.png")));
}

TEST_F(BadInput, ReadOnlyFolder) {
    fs::create_directory(folder_ / "locked");
    fs::permissions(folder_ / "locked", fs::perms::owner_read | fs::perms::owner_exec);
    const bool bypassed = std::ofstream(folder_ / "locked" / "probe").good(); // by an administrator
    const std::string place = bypassed ? "/proc" : "locked";
    if (bypassed && !fs::exists(place)) GTEST_SKIP() << "nothing is read-only here";
    EXPECT_TRUE(failsWith(render({"-o", place + "/a.png"}), 1, place + "/a.png"));
}

TEST_F(BadInput, FullDisk) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no device that is always full";
    fs::create_symlink("/dev/full", folder_ / "full.png");
    const Outcome outcome = render({"-o", "full.png", "-o", "a.pfm", "--stats", "s.json"});
    EXPECT_TRUE(failsWith(outcome, 1, "full.png"));
    EXPECT_NE(outcome.err.find("full.png.rtc"), std::string::npos);
    EXPECT_EQ(jsonOf("s.json")["outputs"], nlohmann::json::array({"a.pfm"}));
    EXPECT_TRUE(pixels({"--resume", "full.png.rtc"}) == bytesOf("a.pfm"));

    fs::create_symlink("/dev/full", folder_ / "s-full.json");
    EXPECT_TRUE(failsWith(render({"--stats", "s-full.json", "-o", "b.pfm"}), 1, "s-full.json"));
    EXPECT_TRUE(bytesOf("a.pfm") == bytesOf("b.pfm"));
}

#ifndef _WIN32
TEST_F(BadInput, PipesThatNobodyReadsOrWrites) {
    for (const char* name : {"a.png", "s.json", "c.rtc", "scene.json"}) ASSERT_EQ(mkfifo(path(name).c_str(), 0600), 0);
    EXPECT_TRUE(failsWith(render({"-o", "a.png"}), 1, "a.png: nobody reads"));
    EXPECT_TRUE(failsWith(render({"--stats", "s.json"}), 1, "s.json: nobody reads"));
    EXPECT_TRUE(failsWith(render({"--resume", "c.rtc"}), 3, "c.rtc: it is not a regular file"));
    EXPECT_TRUE(failsWith(render({"--scene", "scene.json"}), 3, "scene.json: it is not a regular file"));
    EXPECT_TRUE(failsWith(render({"--stats", "s.json", "--reference", "a.png"}), 3, "a.png"));
}

TEST_F(BadInput, FilesLargerThanTheLimit) {
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    rlimit small = before;
    small.rlim_cur = 4096;
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0); // of the program, too
    const Outcome outcome = render({"--width", "64", "--height", "64", "-o", "a.pfm"});
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    EXPECT_TRUE(failsWith(outcome, 1, "a.pfm"));
    EXPECT_FALSE(fs::exists(path("a.pfm")));
}
#endif

#ifndef RT_SANITIZED // sanitizers end the program instead
TEST_F(BadInput, MoreThanTheMemory) {
    EXPECT_TRUE(failsWith(render({"--width", "16384", "--height", "16384", "--spp", "1024", "--replicates", "1024"}), 1,
                          "memory"));
}
#endif

} // namespace
} // namespace rt::test
