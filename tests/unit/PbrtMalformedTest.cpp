// Files of pbrt that are wrong end in one line that names file, line and value, and in little memory.
#include <algorithm>
#include <filesystem>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Core/Error.h"
#include "Common/Core/ReadFile.h"
#include "Common/Scene/Json/SceneJson.h"
#include "tests/FileBytes.h"
#include "tests/unit/PbrtFolder.h"

namespace rt::scene {
namespace {

struct PbrtMistake {
    const char* text;    // after WorldBegin, on line 2
    const char* message; // a part of the error
};

std::string errorOf(const test::PbrtFolder& folder, const std::string& text) {
    try {
        folder.load(text);
    } catch (const InputError& error) {
        EXPECT_EQ(error.code(), ExitCode::Input);
        return error.what();
    }
    return "none";
}

TEST(PbrtMalformed, EveryMistakeIsNamed) {
    const test::PbrtFolder folder;
    folder.write("none.ply", "plu\n");
    folder.write("self.pbrt", "Include \"self.pbrt\"");
    const PbrtMistake mistakes[] = {
        {"Sphere", "a.pbrt:2: \"Sphere\" is no directive; known are Accelerator,"},
        {"]", "a.pbrt:2: ] is no directive"},
        {"Shape sphere", "Shape: \"sphere\": must be a string in quotes"},
        {"Shape \"cube\"", "a.pbrt:2: Shape \"cube\": the shape is unknown; known are sphere,"},
        {"Shape \"sphere\" \"radius\" 1", "must be a type and a name; types are float,"},
        {"Shape \"sphere\" \"flout radius\" 1", "\"flout radius\": must be a type and a name"},
        {"Shape \"sphere\" \"float radius\" one", "\"float radius\": \"one\": must be a number"},
        {"Shape \"sphere\" \"float radius\" [1 2", "\"float radius\": the end of the file: must be a value"},
        {"Shape \"sphere\" \"float radius\" [1 2]", "\"float radius\": has 2 values: must have 1"},
        {"Shape \"sphere\" \"integer radius\" 1", "\"integer radius\": must be of type float"},
        {"Shape \"sphere\" \"float radius\" -1", "-1: must be from 1e-09 to 1e+09"},
        {"Shape \"sphere\" \"float radius\" nan", "\"nan\": must be a number"},
        {"Shape \"sphere\" \"float radius\" 1e30", "must be from -1e9 to 1e9"},
        {"Shape \"disk\" \"float innerradius\" 2", "\"innerradius\" must be below \"radius\""},
        {"Shape \"trianglemesh\" \"point3 P\" [0 0]", "\"point3 P\": has 2 numbers"},
        {"Shape \"trianglemesh\" \"integer indices\" [0 1 2]", "\"point3 P\" is missing"},
        {"Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 3]",
         "3: must be from 0 to 2"},
        {"Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 -1]", "-1: must be from 0"},
        {"Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1]", "has 2 indices"},
        {"Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 .5]", "a whole number"},
        {"Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"normal N\" [0 0 1]", "\"N\": has 1 element"},
        {"Shape \"loopsubdiv\" \"integer levels\" 99 \"point3 P\" [0 0 0 1 0 0 0 1 0]",
         "\"levels\" must be from 0 to 10"},
        {"Shape \"loopsubdiv\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 0 0]", "meets itself"},
        {"Shape \"plymesh\"", "\"string filename\" is missing"},
        {"Shape \"plymesh\" \"string filename\" \"gone.ply\"", "\"gone.ply\": must be an existing file"},
        {"Shape \"plymesh\" \"string filename\" \"none.ply\"", "none.ply: its first line must be \"ply\""},
        {"Material \"matte\"\nShape \"sphere\"", "Material \"matte\": the material is unknown; known are diffuse,"},
        {"NamedMaterial \"a\"\nShape \"sphere\"", "is not defined by any MakeNamedMaterial"},
        {"MakeNamedMaterial \"a\"", "\"string type\" is missing"},
        {"MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [\"a\" \"a\"]\nNamedMaterial \"a\"\n"
         "Shape \"sphere\"",
         "too deep, or of themselves"},
        {"Material \"diffuse\" \"texture reflectance\" \"a\"\nShape \"sphere\"", "\"a\" is no texture of spectra"},
        {"Material \"diffuse\" \"rgb reflectance\" [1 2]\nShape \"sphere\"", "has 2 numbers: must have 3"},
        {"Material \"diffuse\" \"rgb reflectance\" [-1 0 0]\nShape \"sphere\"", "must be from 0 to 1e9"},
        {"Material \"diffuse\" \"spectrum reflectance\" \"pink\"\nShape \"sphere\"", "\"pink\" is unknown; known are"},
        {"Material \"diffuse\" \"spectrum reflectance\" [500 1 400 1]\nShape \"sphere\"", "its wavelengths must grow"},
        {"Texture \"a\" \"spectrum\" \"wood\"", "Texture \"wood\" is unknown; known are constant,"},
        {"Texture \"a\" \"spectrum\" \"imagemap\"", "\"string filename\" is missing"},
        {"LightSource \"lamp\"", "LightSource \"lamp\": the light is unknown; known are point,"},
        {"LightSource \"point\" \"blackbody I\" -5", "must be from 500 to 1e6"},
        {"LightSource \"distant\" \"point3 to\" [0 0 0]", "\"from\" and \"to\" must differ"},
        {"AreaLightSource \"sun\"", "the area light is unknown; known is diffuse"},
        {"AttributeBegin", "a.pbrt:2: there is no end of this AttributeBegin"},
        {"AttributeEnd", "a.pbrt:2: AttributeEnd has no begin"},
        {"ObjectEnd", "ObjectEnd has no begin"},
        {"ObjectBegin \"a\"", "there is no end of this ObjectBegin"},
        {"ObjectBegin \"a\"\nObjectBegin \"b\"", "a.pbrt:3: ObjectBegin must not stand within another"},
        {"ObjectInstance \"a\"", "is not defined by any ObjectBegin before"},
        {"Camera \"perspective\"", "Camera must stand before WorldBegin"},
        {"Translate 1 2", "the end of the file: must be a number"},
        {"Scale [1 2 3 4]", "must be ], as Scale has 3 numbers"},
        {"Rotate 5 0 0 0", "its axis must not be 0"},
        {"LookAt 0 0 0 0 0 0 0 1 0", "eye and point must differ"},
        {"LookAt 1e300 0 0 0 1e300 0 1e300 1e300 1", "LookAt: "},
        {"Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2]", "Transform: its last number must be 1"},
        {"Option \"seed\"", "Option: the end of the file: must be a value"},
        {"Option \"seed\" [1 2]", "\"2\": must be ], as an option has one value"},
        {"Option seed 1", "Option: \"seed\": must be a string in quotes"},
        {"Translate 1e30 0 0 Shape \"sphere\"", "the transform exceeds 1e9"},
        {"CoordSysTransform \"there\"", "is no coordinate system; known are"},
        {"ColorSpace \"cmyk\"", "the colour space is unknown; known are srgb,"},
        {"ActiveTransform Now", "must be StartTime, EndTime or All"},
        {"Attribute \"shapes\" \"float alpha\" 1", "must be of shape,"},
        {"Include \"gone.pbrt\"", "a.pbrt:2: \"gone.pbrt\": must be an existing file"},
        {"Include \"self.pbrt\"", "self.pbrt:1: "},
        {"Include \"a.pbrt\"", "a.pbrt\" includes itself"},
        {"Shape \"sphere", "the file ends within a string"},
        {"Shape \"sphere\n\"", "a string must end on its line"},
        {"Shape \"sp\\here\"", "the escape \"\\h\" is unknown"},
    };
    for (const PbrtMistake& mistake : mistakes) {
        const std::string error = errorOf(folder, std::string("WorldBegin\n") + mistake.text);
        EXPECT_NE(error.find(mistake.message), error.npos) << mistake.text << "\n    " << error;
        EXPECT_EQ(error.find('\n'), error.npos) << error;
    }
}

TEST(PbrtMalformed, WhatStandsBeforeTheWorldOrNowhere) {
    const test::PbrtFolder folder;
    EXPECT_NE(errorOf(folder, "Shape \"sphere\"").find("a.pbrt:1: Shape must stand after WorldBegin"),
              std::string::npos);
    EXPECT_NE(errorOf(folder, "").find("there is no WorldBegin"), std::string::npos);
    EXPECT_NE(errorOf(folder, "Camera \"fisheye\"\nWorldBegin").find("known are perspective"), std::string::npos);
    EXPECT_NE(errorOf(folder, "Scale 0 1 1\nCamera \"perspective\"\nWorldBegin").find("cannot be inverted"),
              std::string::npos);
    EXPECT_NE(errorOf(folder, "Film \"rgb\" \"integer xresolution\" 0\nWorldBegin").find("1 or more"),
              std::string::npos);
}

TEST(PbrtMalformed, FewBytesAskForLittle) {
    const test::PbrtFolder folder;
    std::string text = "WorldBegin\n"; // 2^30 includes of nothing
    for (int i = 0; i < 30; ++i) {
        const std::string next = "Include \"" + std::to_string(i + 1) + ".pbrt\"\n";
        folder.write(std::to_string(i) + ".pbrt", next + next);
    }
    folder.write("30.pbrt", "");
    EXPECT_NE(errorOf(folder, text + "Include \"0.pbrt\"").find("elements, the most for files of this size"),
              std::string::npos);
    const std::string triangle = "\"point3 P\" [0 0 0 1 0 0 0 1 0]";
    for (int i = 0; i < 9; ++i) text += "Shape \"loopsubdiv\" \"integer levels\" 9 " + triangle + "\n";
    EXPECT_NE(errorOf(folder, text).find("a.pbrt:"), std::string::npos) << errorOf(folder, text);
    folder.write("many.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n");
    EXPECT_NE(errorOf(folder, "WorldBegin\nShape \"plymesh\" \"string filename\" \"many.ply\"").find("asks for more"),
              std::string::npos);
    folder.write("deep0.pbrt", "");
    for (int i = 1; i <= 70; ++i)
        folder.write("deep" + std::to_string(i) + ".pbrt", "Include \"deep" + std::to_string(i - 1) + ".pbrt\"");
    EXPECT_NE(errorOf(folder, "WorldBegin\nInclude \"deep70.pbrt\"").find("deeper than 64"), std::string::npos);
}

// Whatever the bytes are, a file is a scene that can be written and read again, or it is refused in one line.
TEST(PbrtMalformed, ChangedFilesAreReadOrRefused) {
    const test::PbrtFolder folder;
    std::vector<std::string> seeds;
    std::vector<std::string> words = {"[", "]", "\"", "-1", "0", "1e300", "1e-300", "2147483647", "#", "true"};
    for (const auto& entry : std::filesystem::directory_iterator(RT_TEST_DATA_DIR "/pbrt")) {
        if (!entry.is_regular_file()) continue;
        seeds.push_back(test::bytesOfFile(entry.path()));
        std::istringstream in(seeds.back());
        for (std::string word; in >> word;) words.push_back(word);
    }
    std::sort(seeds.begin(), seeds.end()); // whatever order the folder has
    std::sort(words.begin(), words.end());
    std::mt19937 random(7);
    const auto below = [&random](std::size_t count) { return random() % std::max<std::size_t>(count, 1); };
    std::size_t accepted = 0;
    for (int i = 0; i < 3000; ++i) {
        std::string text = seeds[below(seeds.size())];
        const bool isMesh = text.starts_with("ply");
        for (std::size_t change = below(5); change < 5 && !text.empty(); ++change) {
            const std::size_t at = below(text.size());
            if (change == 0) text.erase(at, 1 + below(30));
            if (change == 1) text[at] = static_cast<char>(below(256));
            if (change > 1) text.insert(at, ' ' + words[below(words.size())] + ' ');
        }
        if (isMesh) folder.write("a.ply", text);
        const std::string scene = isMesh ? "WorldBegin Shape \"plymesh\" \"string filename\" \"a.ply\"" : text;
        SceneDesc read;
        try {
            read = folder.load(scene);
        } catch (const InputError& error) {
            ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
            continue;
        }
        ++accepted;
        if (!read.textures.empty()) continue; // of images that are not there
        ASSERT_NO_THROW(parseScene(toJson(read), "again.json", folder.path())) << text;
    }
    EXPECT_GT(accepted, 300u);
}

TEST(PbrtMalformed, FilesAreConfined) {
    const test::PbrtFolder folder;
    folder.write("mine.pbrt", "Shape \"sphere\"\n");
    folder.write("theirs/a.pbrt", "WorldBegin\nInclude \"../mine.pbrt\"\n");
    const std::filesystem::path scene = folder.path() / "theirs/a.pbrt";
    EXPECT_NO_THROW(loadPbrtScene(scene));
    const ReadsBelow confined(folder.path() / "theirs", scene);
    try {
        loadPbrtScene(scene);
        ADD_FAILURE();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("--assets-below does not allow it"), std::string::npos)
            << error.what();
    }
}

} // namespace
} // namespace rt::scene
