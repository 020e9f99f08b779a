// An image file tells how to render it again.
#include <string>

#include "tests/program/Program.h"

namespace rt::test {
namespace {

class RenderNote : public ProgramTest {
  protected:
    nlohmann::json noteOf(const std::string& image) const {
        const std::string text = run("ray-tracing-image", {"info", path(image)}).out;
        const std::size_t at = text.find("\nrender ");
        return at == text.npos ? nlohmann::json() : nlohmann::json::parse(text.substr(at + 8));
    }
};

TEST_F(RenderNote, ArgumentsGiveTheSameFilesBitForBit) {
    const Outcome first = render({"--scene",
                                  "white-spheres:9",
                                  "--spp",
                                  "20",
                                  "--seed",
                                  "4",
                                  "--sampler",
                                  "stratified",
                                  "--light-sampling",
                                  "mixture",
                                  "--one-sided-lights",
                                  "off",
                                  "--exposure",
                                  "0.3",
                                  "--tonemap",
                                  "aces",
                                  "--camera",
                                  R"({"look_from": [300.25, 270, -750]})",
                                  "-o",
                                  path("a.exr"),
                                  "-o",
                                  path("a.png"),
                                  "--threads",
                                  "1"});
    ASSERT_EQ(first.exitCode, 0) << first.err;
    const nlohmann::json note = noteOf("a.exr");
    ASSERT_TRUE(note.is_object());
    EXPECT_EQ(note["program"], "ray-tracing-cpu");
    EXPECT_EQ(note["spp_done"], 20);
    EXPECT_EQ(noteOf("a.png"), note);
    Arguments arguments = note["arguments"].get<Arguments>();
    arguments.insert(arguments.end(), {"-q", "-o", path("b.exr"), "-o", path("b.png")});
    const Outcome second = cpu(arguments);
    ASSERT_EQ(second.exitCode, 0) << second.err;
    EXPECT_EQ(bytesOf("a.exr"), bytesOf("b.exr"));
    EXPECT_EQ(bytesOf("a.png"), bytesOf("b.png"));
}

TEST_F(RenderNote, TheCameraIsThePoseOrThatOfTheScene) {
    const std::string scenes = pixels({"--spp", "2"});
    const std::string pose = R"({"look_from":[278,278,-800],"look_at":[278,278,0]})"; // of the scene
    EXPECT_EQ(pixels({"--spp", "2", "--camera", pose}), scenes);
    EXPECT_NE(pixels({"--spp", "2", "--camera", R"({"vertical_fov": 20})"}), scenes);

    ASSERT_EQ(cpu({"--camera", R"({"look_from":[1,2,3]})", "--export-scene", path("a.json")}).exitCode, 0);
    EXPECT_EQ(jsonOf("a.json")["camera"]["look_from"], nlohmann::json({1, 2, 3}));
    for (const char* bad :
         {"", "x", "[]", R"({"look_from":[1,2]})", R"({"vertical_fov":200})", R"({"look_form":[1,2,3]})"})
        EXPECT_TRUE(failsWith(render({"--camera", bad}), 2, "--camera")) << bad;
    EXPECT_TRUE(failsWith(render({"--camera", R"({"look_from":[278,278,0],"look_at":[278,278,0]})"}), 2, "--camera"));
}

} // namespace
} // namespace rt::test
