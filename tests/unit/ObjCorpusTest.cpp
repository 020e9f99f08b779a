// OBJ and MTL files as they are found: each is read as people mean it, or refused in one line.
#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Scene/Compiler/SceneCompiler.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/Obj/ObjLoader.h"
#include "tests/TempFolder.h"
#include "tests/unit/ObjFolder.h"

namespace rt::scene {
namespace {

using test::kSquare;

const std::string kUvs = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
const std::string kBlue = "newmtl a\nKd 0.25 0.5 0.75\n";
const std::string kUse = "mtllib a.mtl\nusemtl a\n";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += by.size())
        text.replace(at, what.size(), by);
    return text;
}

// What is expected of a model with m.obj and a.mtl.
struct Nasty {
    const char* name;
    std::string obj, mtl;
    std::size_t triangles;         // 0: it is refused
    std::vector<std::string> says; // parts of as many notices, or of the error
    bool isBlue = true;            // every triangle has the colour of kBlue
};

void PrintTo(const Nasty& nasty, std::ostream* out) {
    *out << nasty.name;
}

std::vector<Nasty> filesOfLines() {
    const std::string face = "f 1 2 3 4\n", plain = kUse + kSquare + face;
    const std::string spaces(100'000, ' ');
    std::string continued = "f";
    for (const char* corner : {"1", "2", "3", "4"}) continued += std::string(" \\\n ") + corner;
    return {
        {"lines of Windows", replaced(plain, "\n", "\r\n"), replaced(kBlue, "\n", "\r\n"), 2, {}},
        {"lines of old Macs", replaced(plain, "\n", "\r"), replaced(kBlue, "\n", "\r"), 2, {}},
        {"tabs", replaced(plain, " ", "\t"), replaced(kBlue, " ", " \t "), 2, {}},
        {"indented", "  " + replaced(plain, "\n", "  \n\t "), "  " + replaced(kBlue, "\n", "\n\t"), 2, {}},
        {"a byte order mark", "\xef\xbb\xbf" + plain, "\xef\xbb\xbf" + kBlue, 2, {}},
        {"no last line end", plain.substr(0, plain.size() - 1), kBlue.substr(0, kBlue.size() - 1), 2, {}},
        {"ends in a backslash", plain + "\\", kBlue + "\\", 2, {}},
        {"a face over many lines", kUse + kSquare + continued + "\n", kBlue, 2, {}},
        {"the same of Windows", replaced(kUse + kSquare + continued, "\n", "\r\n"), kBlue, 2, {}},
        {"a backslash and spaces", kUse + kSquare + "f 1 2 \\  \n3 4\n", kBlue, 2, {}},
        {"a comment behind the backslash", kUse + kSquare + "f 1 2 \\ # more\n3 4 # all\n", kBlue, 2, {}},
        {"a comment with a backslash", kUse + "# C:\\models\\\n" + kSquare + face, "# C:\\\n" + kBlue, 2, {}},
        {"a split keyword's line", "mtllib \\\na.mtl\nusemtl\\\n a\n" + kSquare + face, kBlue, 2, {}},
        {"a very long line", kUse + kSquare + "f 1" + spaces + "2" + spaces + "3 4 #" + spaces + "\n", kBlue, 2, {}},
        {"a very long number", kUse + kSquare + "v 2." + std::string(100'000, '0') + " 0 0\n" + face, kBlue, 2, {}},
        {"upper case",
         "MTLLIB a.mtl\nUSEMTL a\n" + replaced(kSquare, "v", "V") + "F 1 2 3 4\n",
         replaced(replaced(kBlue, "newmtl", "NEWMTL"), "Kd", "KD"),
         2,
         {}},
        {"bytes of nothing", plain + std::string("\0\x01\xff # \n\0", 7), kBlue + std::string("\0\xfe\n", 3), 2, {}},
        {"a comment after everything",
         replaced(plain, "\n", " # mtl, v 1 2 3\n"),
         replaced(kBlue, "\n", " # x\n"),
         2,
         {}},
    };
}

std::vector<Nasty> filesOfFaces() {
    const std::string start = kUse + kSquare;
    return {
        {"negative indices", start + kUvs + "vn 0 0 1\nf -4/-4/-1 -3/-3/-1 -2/-2/-1 -1/-1/-1\n", kBlue, 2, {}},
        {"an index far out",
         start + "f 1 2 3\nf 1 2 99999999999999999999\n",
         kBlue,
         1,
         {"m.obj:8: vertex index 99999999999999999999: there are 4"}},
        {"one far back", start + "f 1 2 3\nf 1 2 -99999999999999999999\n", kBlue, 1, {"m.obj:8: vertex index"}},
        {"position and normal", start + "vn 0 0 1\nf 1//1 2//1 3//1 4//1\n", kBlue, 2, {}},
        {"position and place", start + kUvs + "f 1/1 2/2 3/3 4/4\n", kBlue, 2, {}},
        {"slashes of nothing", start + "f 1/ 2// 3 4/\n", kBlue, 2, {}},
        {"zero for none", start + "f 1/0/0 2/0/0 3/0/0 4/0/0\n", kBlue, 2, {}},
        {"mixed corners",
         start + kUvs + "vn 0 0 1\nf 1/1 2//1 3 4/4/1\n",
         kBlue,
         2,
         {"texture coordinate at 2 of its 4 corners", "normal at 2 of its 4 corners"}},
        {"an indexed normal that is none", start + "f 1//1 2//1 3//1\n", kBlue, 1, {"m.obj:7: normal index 1"}},
        {"a corner twice", start + "f 1 2 2 3\n", kBlue, 2, {}},
        {"all corners one", start + "f 1 2 3\nf 1 1 1\n", kBlue, 2, {}},
        {"faces first", kUse + "f 1 2 3 4\n" + kSquare, kBlue, 2, {}},
        {"points, lines and curves",
         start + "p 1 2\nl 1/1 2/2\ncstype bezier\ndeg 3\ncurv 0 1 1 2 3 4\nparm u 0 1\nend\nf 1 2 3\n",
         kBlue,
         1,
         {"1 line, 1 point, 1 curve"}},
        {"points alone", kSquare + "p 1 2 3\n", "", 0, {"m.obj: there is no face in it", "1 point"}},
        {"weights", kUse + replaced(kSquare, " 0\n", " 0 1.0\n") + "f 1 2 3 4\n", kBlue, 2, {}},
        {"three texture coordinates", start + replaced(kUvs, "\n", " 0.0\n") + "f 1/1 2/2 3/3\n", kBlue, 1, {}},
        {"broken numbers that nobody uses", start + "v x y z\nv 1\nvn nan 0 0\nvt\nf 1 2 3\n", kBlue, 1, {}},
        {"a comma for a point",
         start + "v 0,5 0 0\nf 1 2 3\nf 1 2 5\n",
         kBlue,
         1,
         {"v must have three finite numbers"}},
        {"more coordinates than float has", start + "v 1e39 0 0\nf 1 2 3\nf 1 2 5\n", kBlue, 1, {"\"v 1e39 0 0\""}},
        {"odd numbers",
         kUse + "v +0. -.0 0e5\nv 1.E0 .0 -0\nv 10e-1 +1.00 000\nv 0 1 1e-400\nf 1 2 3 4\n",
         kBlue,
         2,
         {}},
        {"nothing right", "f 1 2 3\nf 4 5\n", "", 0, {"m.obj:1: vertex index 1: there are 0"}},
        {"an outline of the first format", start + "fo 1 2 3 4\n", kBlue, 2, {}},
        {"smoothing beyond numbers", start + "s 99999999999\ns -1\ns x\nf 1 2 3 4\n", kBlue, 2, {}},
    };
}

std::vector<Nasty> filesOfMaterials() {
    const std::string rest = kSquare + kUvs + "f 1/1 2/2 3/3 4/4\n", plain = kUse + rest;
    const std::string image = "newmtl a\nKd 0.25 0.5 0.75\nmap_Kd ";
    return {
        {"groups of odd names", "g\ng  a b \"c\" # d\no\no \xe4\xff\nmg 1 0.5\n" + plain, kBlue, 2, {}},
        {"an unknown material", "mtllib a.mtl\nusemtl b\n" + rest, kBlue, 2, {"grey instead: \"b\""}, false},
        {"no name of a material", "mtllib a.mtl\nusemtl\n" + rest, kBlue, 2, {}, false},
        {"no material file", kUse + rest, "", 2, {"there is no material in it", "grey instead"}, false},
        {"several material files", "mtllib gone.mtl a.mtl\nusemtl a\n" + rest, kBlue, 2, {"\"gone.mtl\""}},
        {"a material file again and again", "mtllib a.mtl a.mtl a.mtl\nmtllib a.mtl\nusemtl a\n" + rest, kBlue, 2, {}},
        {"no name of a material file", "mtllib\nmtllib  \n" + plain, kBlue, 2, {}},
        {"a folder as material file", "mtllib .\nmtllib ..\\..\n" + plain, kBlue, 2, {"\".\" and \"..\\..\""}},
        {"statements before a material", plain, "Kd 1 1 1\nmap_Kd x.png\n" + kBlue, 2, {}},
        {"a material twice", plain, "newmtl a\nKd 1 1 1\n" + kBlue, 2, {}},
        {"options and a comment", plain, image + "-s 2 2 -o 0.5 -mm 0 1 -clamp on t.png # colour\n", 2, {}, false},
        {"an option without its value",
         plain,
         image + "-clamp\nmap_d -s\nmap_Ks -bm\n",
         2,
         {"a.mtl:5: map_Ks: a number"}},
        {"an option of no kind", plain, image + "-x 1 t.png\n", 2, {"images that do not exist"}},
        {"a path with backslashes", plain, image + "C:\\a\\b\\t.png\n", 2, {}, false},
        {"a path that ends in one", plain, image + "C:\\a\\b\\\nNs 10\n", 2, {"images that do not exist"}},
        {"an image and no place in it",
         kUse + kSquare + "f 1 2 3 4\n",
         image + "t.png\n",
         2,
         {"2 triangles are without"}},
        {"numbers that are none", plain, kBlue + "Ns x\nNi\nd 0.5.5\nillum a\n", 2, {"a.mtl:3: Ns: \"x\""}},
        {"an unlit one", plain, kBlue + "illum 0\n", 2, {}, false},
    };
}

class ObjCorpus : public testing::TestWithParam<Nasty> {};

TEST_P(ObjCorpus, IsReadOrRefusedInOneLine) {
    const Nasty& nasty = GetParam();
    const test::TempFolder folder;
    const auto write = [&](const std::string& name, const std::string& text) {
        std::ofstream(folder / name, std::ios::binary) << text;
    };
    write("m.obj", nasty.obj);
    write("a.mtl", nasty.mtl);
    write("t.png", "");
    std::vector<std::string> lines;
    std::size_t triangles = 0;
    try {
        const ObjModel model = loadObj(folder / "m.obj", true);
        lines = model.notices;
        for (const ObjPart& part : model.parts) {
            triangles += part.mesh.triangles.size();
            const MaterialDesc material = part.material.empty() ? plainMaterial() : model.materials.at(part.material);
            const auto* color = std::get_if<glm::dvec3>(&material.albedo);
            EXPECT_EQ(color && *color == glm::dvec3(0.25, 0.5, 0.75), nasty.isBlue);
        }
        // It is a scene, which a scene file holds.
        const SceneDesc scene = loadObjScene(folder / "m.obj");
        SceneDesc again = parseScene(toJson(scene), "again.json", {});
        again.id = scene.id;
        again.notices = scene.notices;
        EXPECT_EQ(again, scene);
        EXPECT_GE(triangles, loadObj(folder / "m.obj", false).parts.at(0).mesh.triangles.size());
    } catch (const InputError& error) {
        lines.assign(nasty.triangles == 0 ? nasty.says.size() : 1, error.what());
    }
    EXPECT_EQ(triangles, nasty.triangles);
    EXPECT_EQ(lines.size(), nasty.says.size()) << (lines.empty() ? "" : lines.front());
    for (const std::string& text : nasty.says)
        EXPECT_TRUE(std::ranges::any_of(lines, [&](const std::string& line) { return line.find(text) != line.npos; }))
            << text << " is not in " << (lines.empty() ? "" : lines.front());
    for (const std::string& line : lines) EXPECT_EQ(line.find_first_of("\r\n"), line.npos) << line;
}

INSTANTIATE_TEST_SUITE_P(Lines, ObjCorpus, testing::ValuesIn(filesOfLines()));
INSTANTIATE_TEST_SUITE_P(Faces, ObjCorpus, testing::ValuesIn(filesOfFaces()));
INSTANTIATE_TEST_SUITE_P(Materials, ObjCorpus, testing::ValuesIn(filesOfMaterials()));

} // namespace
} // namespace rt::scene
