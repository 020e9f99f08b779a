// Configuration files as text: what is understood, and that everything else is an error which names its line.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/App/Options/ConfigText.h"
#include "Common/Core/Error.h"

namespace rt::app {
namespace {

// "name=value|value@place" of each entry.
std::vector<std::string> read(const std::string& text) {
    std::vector<std::string> shown;
    for (const ConfigEntry& entry : readConfigText(text, "f")) {
        std::string line = entry.name + "=";
        for (const std::string& value : entry.values) line += (&value != &entry.values.front() ? "|" : "") + value;
        shown.push_back(line + "@" + entry.place);
    }
    return shown;
}

std::string error(const std::string& text) {
    try {
        readConfigText(text, "f");
    } catch (const UsageError& failure) {
        return failure.what();
    }
    return "no error";
}

using Lines = std::vector<std::string>;

TEST(ConfigTextTest, ReadsLines) {
    EXPECT_EQ(read(""), Lines());
    EXPECT_EQ(read("\n\n   \n# spp = 1\n; spp = 2"), Lines());
    EXPECT_EQ(read("spp = 5\nscene=white-spheres:9 # many\n  q =true"),
              (Lines{"spp=5@f:1", "scene=white-spheres:9@f:2", "q=true@f:3"}));
    EXPECT_EQ(read("a = \"b # c, d\"\n\nb = 'C:\\new \"x\"' # tail\nc = \"\"\nd = of two words"),
              (Lines{"a=b # c, d@f:1", "b=C:\\new \"x\"@f:3", "c=@f:4", "d=of two words@f:5"}));
}

TEST(ConfigTextTest, ReadsArrays) {
    EXPECT_EQ(read("a = [x, \"y, ]\", z]\nb = [1]"), (Lines{"a=x|y, ]|z@f:1", "b=1@f:2"}));
    EXPECT_EQ(read("a = [ # first\n  x,\n\n  'y', # and a last comma\n]\nb = 1"), (Lines{"a=x|y@f:1", "b=1@f:6"}));
    EXPECT_EQ(read("a = depth,albedo"), (Lines{"a=depth,albedo@f:1"})); // as on the command line
}

TEST(ConfigTextTest, ReadsFilesOfAnySystem) {
    EXPECT_EQ(read("\xef\xbb\xbfspp = 5\r\nscene = \"a\"\r\nb = [1,\r\n2]\r\n"),
              (Lines{"spp=5@f:1", "scene=a@f:2", "b=1|2@f:3"}));
    EXPECT_EQ(read("\xef\xbb\xbf\r\n {\"spp\": 5, \"aov\": [\"depth\", \"albedo\"]}"),
              (Lines{"aov=depth|albedo@f", "spp=5@f"}));
}

TEST(ConfigTextTest, EveryLineThatIsNotUnderstoodIsNamed) {
    const std::string form = "must be FLAG = VALUE, such as spp = 500";
    EXPECT_EQ(error("spp = 1\nx\n"), "f:2: \"x\": " + form);
    EXPECT_EQ(error("=\n"), "f:1: \"=\": " + form);
    EXPECT_EQ(error("= 5\n"), "f:1: \"= 5\": " + form);
    EXPECT_EQ(error("\na="), "f:2: \"a\": has no value; a line " + form);
    EXPECT_EQ(error("a = # 5"), "f:1: \"a\": has no value; a line " + form);
    EXPECT_EQ(error("["), "f:1: \"[\": there are no sections; a line " + form);
    EXPECT_EQ(error("[]"), "f:1: \"[]\": there are no sections; a line " + form);
    EXPECT_EQ(error("spp = 1\n[default]\n"), "f:2: \"[default]\": there are no sections; a line " + form);
    EXPECT_EQ(error("a = \"b\nc = 2"), "f:1: \"a\": lacks the closing quote");
    EXPECT_EQ(error("a = \"b"), "f:1: \"a\": lacks the closing quote");
    EXPECT_EQ(error("a = \"b\" c"), "f:1: \"c\": follows the value; a line " + form);
    EXPECT_EQ(error("a = [b] c"), "f:1: \"c\": follows the value; a line " + form);
    EXPECT_EQ(error("a = [b\nc = 2\n"), "f:2: \"a\": its values must be separated by , and end with ]");
    EXPECT_EQ(error("a = ["), "f:1: \"a\": has no value; a line " + form);
    EXPECT_EQ(error("a = []"), "f:1: \"a\": has no value; a line " + form);
    EXPECT_EQ(error("a = [b,,c]"), "f:1: \"a\": has no value; a line " + form);
    EXPECT_EQ(error("a = 1\nb = 2\na = 3"), "f:3: \"a\" appears twice, first at f:1; several values go into [ ]");
    EXPECT_EQ(error("{\n\"spp\": 5,\n}").rfind("f:3:", 0), 0u) << error("{\n\"spp\": 5,\n}");
    EXPECT_EQ(error("{\"spp\": 5, \"spp\": 6}").rfind("f:1:", 0), 0u);
    EXPECT_EQ(error("{").rfind("f:1:", 0), 0u);
}

TEST(ConfigTextTest, BytesThatAreNoTextAreNamed) {
    const std::string text = " is no text; must be TOML, INI or JSON in UTF-8";
    EXPECT_EQ(error(std::string("a = 1\nb\0 = 2", 12)), "f:2: the byte 0x00" + text);
    EXPECT_EQ(error(std::string("\xff\xfes\0p\0", 6)), "f:1: the byte 0x00" + text); // UTF-16
    EXPECT_EQ(error("a = \"\x1b[31m\""), "f:1: the byte 0x1b" + text);
    EXPECT_EQ(error("a = 1\rb = 2"), "f:1: the byte 0x0d" + text);
    EXPECT_EQ(error("\x7f"
                    "ELF"),
              "f:1: the byte 0x7f" + text);
}

TEST(ConfigTextTest, ErrorsAreShortWhateverTheLine) {
    const std::string huge(500'000, 'x');
    for (const std::string& line :
         {huge, huge + " = [" + huge, "[" + huge, "a = '" + huge, "a = 'b' " + huge, "{" + huge})
        EXPECT_LT(error(line).size(), 300u);
    EXPECT_EQ(read("a = " + huge), (Lines{"a=" + huge + "@f:1"}));
    EXPECT_NE(error("{\"a\": " + std::string(100'000, '[')), "no error");
}

} // namespace
} // namespace rt::app
