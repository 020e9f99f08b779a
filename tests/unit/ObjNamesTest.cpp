// Names of materials and files in OBJ and MTL files, with comments, in quotes and in other case.
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Scene/Obj/ObjLoader.h"
#include "tests/unit/MtlFolder.h"

namespace rt::scene {
namespace {

using test::kTriangle;

class ObjNames : public test::MtlFolder {};

TEST_F(ObjNames, NamesWithCommentsQuotesAndInOtherCase) {
    const auto colorOf = [&](const std::string& newmtl, const std::string& usemtl) {
        write("a.mtl", "newmtl other\nKd 1 1 1\nnewmtl " + newmtl + "\nKd 0.25 0.5 0.75 # blue\n");
        model = load("mtllib a.mtl\nusemtl " + usemtl + "\n" + kTriangle);
        const std::string& key = model.parts.at(0).material;
        return key.empty() ? glm::dvec3(0) : std::get<glm::dvec3>(model.materials.at(key).albedo);
    };
    const glm::dvec3 blue(0.25, 0.5, 0.75);
    const std::vector<std::pair<const char*, const char*>> alike = {
        {"a # first", "a"}, {"a", "a # first"}, {"a #first", "a"},
        {"a", "a #first"},  {"\"a b\"", "a b"}, {"Material #25", "Material #25"},
        {"a", "\"a\" # x"}, {"#1", "#1"}};
    for (const auto& [newmtl, usemtl] : alike) {
        EXPECT_EQ(colorOf(newmtl, usemtl), blue) << newmtl << ", " << usemtl;
        EXPECT_TRUE(model.notices.empty()) << model.notices[0];
    }
    EXPECT_EQ(colorOf("Red", "red"), blue);
    EXPECT_TRUE(notices(R"(materials that are named in other case: "red")"));
    EXPECT_EQ(colorOf("Material #25", "Material #26"), glm::dvec3(0)) << "another one";
    EXPECT_TRUE(notices("grey instead"));
}

TEST_F(ObjNames, FilesWithCommentsQuotesAndInOtherCase) {
    write("Two Words.PNG", "");
    for (const char* name :
         {"Two Words.PNG", "\"Two Words.PNG\"", "Two Words.PNG # c", "-clamp on \"Two Words.PNG\" # c"}) {
        material("map_Kd " + std::string(name) + "\n");
        EXPECT_EQ(image("m/map_Kd").file, (folder / "Two Words.PNG").generic_string()) << name;
        EXPECT_TRUE(model.notices.empty()) << name << model.notices[0];
    }
    write("a #1.png", "");
    material("map_Kd a #1.png\n");
    EXPECT_EQ(image("m/map_Kd").file, (folder / "a #1.png").generic_string());
    material("map_Kd gone.png # c\n");
    EXPECT_TRUE(notices("images that do not exist are left out of materials: \"gone.png\""));
    write("b.mtl", "newmtl m\nKd 0.25 0.5 0.75\n");
    for (const char* name : {"\"b.mtl\"", "b.mtl # c", "b.mtl #c", "gone.mtl b.mtl", "from\\afar\\b.mtl"}) {
        model = load("mtllib " + std::string(name) + "\nusemtl m\n" + kTriangle);
        EXPECT_EQ(model.parts.at(0).material, "m") << name;
    }
    if (std::filesystem::exists(folder / "B.MTL")) return; // where case makes no other file
    model = load("MTLLIB B.MTL\nUSEMTL m\n" + kTriangle);
    EXPECT_EQ(model.parts.at(0).material, "m");
    EXPECT_TRUE(notices(R"(files that are named in other case: "B.MTL")"));
    std::filesystem::create_directory(folder / "Maps");
    write("Maps/leaf.png", "");
    material("map_Kd maps\\Leaf.png\n");
    EXPECT_EQ(image("m/map_Kd").file, (folder / "Maps" / "leaf.png").generic_string());
    EXPECT_TRUE(notices(R"(files that are named in other case: "maps/Leaf.png")"));
}

} // namespace
} // namespace rt::scene
