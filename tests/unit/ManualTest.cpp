// One table: what the programs take is what their help, man pages, completions and reference tell.
#include <cstddef>
#include <exception>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "Common/Core/BuildInfo.h"
#include "Common/Manual/Formats.h"
#include "Common/Manual/Help.h"
#include "Common/Manual/Values.h"
#include "Common/Tools/Pages.h"

namespace rt::manual {
namespace {

using tools::allPages;

std::string pageOfMan(const Page& page) {
    return manPage(page, programVersion());
}

std::string withoutBackslashes(std::string text) {
    std::erase(text, '\\');
    return text;
}

// Flags and arguments of the page and of its commands.
std::vector<Flag> allFlags(const Page& page) {
    std::vector<Flag> flags = page.flags;
    for (const Page& command : page.commands) flags.insert(flags.end(), command.flags.begin(), command.flags.end());
    return flags;
}

TEST(Manual, EveryFlagIsToldEverywhere) {
    const std::string reference = tools::referenceText();
    for (const Page& page : allPages()) {
        const std::string help = fullHelpText(page), man = withoutBackslashes(pageOfMan(page));
        const std::string bash = bashCompletion(page, {}), zsh = zshCompletion(page, {});
        const std::string fish = fishCompletion(page, {});
        EXPECT_GE(allFlags(page).size(), 9u) << page.name;
        for (const Flag& flag : allFlags(page))
            for (const std::string& name : flag.names) {
                for (const std::string* text : {&reference, &help, &man, &bash, &zsh})
                    EXPECT_NE(text->find(name), std::string::npos) << page.name << " " << name;
                const std::string option = name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
                EXPECT_NE(fish.find(option + " "), std::string::npos) << page.name << " " << name;
                EXPECT_FALSE(flag.help.empty()) << page.name << " " << name;
            }
    }
}

// What the parser takes is in the page, and the reverse: each flag is known to the program that the page is of.
TEST(Manual, PagesAreOfTheParsers) {
    std::ostringstream out;
    for (const char* program : {app::kCpuProgram, app::kGpuProgram}) {
        app::OptionParser parser(program);
        for (const Flag& flag : parser.page().flags) {
            std::string message;
            try {
                parser.parse({flag.names.front()}, out);
            } catch (const std::exception& error) {
                message = error.what();
            }
            EXPECT_EQ(message.find("unknown flag"), std::string::npos) << message;
            EXPECT_EQ(message.find("a flag of ray-tracing"), std::string::npos) << message;
        }
    }
}

TEST(Manual, HelpIsOneScreen) {
    for (const Page& page : allPages()) {
        std::istringstream help(helpText(page));
        std::size_t lines = 0;
        for (std::string line; std::getline(help, line); ++lines) EXPECT_LE(line.size(), 80u) << line;
        EXPECT_LE(lines, 24u) << page.name;
        for (const std::string& name : page.essentials)
            EXPECT_NE(findFlag(page, name), nullptr) << page.name << " has no " << name;
    }
    EXPECT_EQ(allPages().front().essentials.size(), 12u);
}

TEST(Manual, DocsReferenceIsWhatTheFlagsSay) {
    std::ifstream file(std::string(RT_SOURCE_DIR) + "/docs/reference.md", std::ios::binary);
    const std::string committed{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(committed, tools::referenceText()) << "cmake --build build --target reference writes it anew";
}

TEST(Manual, ChoicesAndDefaultsComeFromTheTables) {
    const Page page = allPages().front();
    const Flag* sampler = findFlag(page, "--sampler");
    ASSERT_NE(sampler, nullptr);
    EXPECT_EQ(sampler->byDefault, "sobol");
    EXPECT_EQ(formOf(sampler->value).words,
              (std::vector<std::string>{"sobol", "sobol-blue", "stratified", "independent"}));
    EXPECT_EQ(sampler->choices.size(), 4u);
    EXPECT_EQ(findFlag(page, "-o"), findFlag(page, "--output"));
    EXPECT_TRUE(findFlag(page, "-o")->isRepeatable);
    EXPECT_EQ(formOf(findFlag(page, "-o")->value).endings, (std::vector<std::string>{".png", ".exr", ".hdr", ".pfm"}));
    EXPECT_TRUE(findFlag(page, "--denoise")->mayOmitValue);
    EXPECT_TRUE(formOf(findFlag(page, "--aov")->value).isList);
    EXPECT_EQ(findFlag(page, "--device"), nullptr); // it is ray-tracing-gpu's
}

TEST(Manual, FormsOfValues) {
    using Kind = ValueForm::Kind;
    EXPECT_EQ(formOf("N").kind, Kind::Text);
    EXPECT_EQ(formOf("X,Y,W,H").kind, Kind::Text);
    EXPECT_EQ(formOf("N|TEXT").kind, Kind::Text);
    EXPECT_EQ(formOf("F").kind, Kind::File);
    EXPECT_TRUE(formOf("F").endings.empty());
    EXPECT_EQ(formOf("DIR").kind, Kind::Folder);
    EXPECT_EQ(formOf("SCENE").kind, Kind::Scene);
    EXPECT_EQ(formOf("LIST|auto|all").words, (std::vector<std::string>{"auto", "all"}));
    EXPECT_FALSE(formOf("LIST|auto|all").isList);
}

TEST(Manual, SameBytesEachTime) {
    EXPECT_EQ(tools::referenceText(), tools::referenceText());
    const Page page = allPages().back();
    EXPECT_EQ(pageOfMan(page), pageOfMan(page));
    EXPECT_EQ(pageOfMan(page).find(RT_SOURCE_DIR), std::string::npos);
}

TEST(Manual, TextCannotBecomeMarkup) {
    Page page;
    page.name = "p";
    page.summary = ".SH not a heading. More";
    page.flags.push_back({{"--a"}, "", "it's \\n [x]: 'y'", {}, "", "G"});
    EXPECT_EQ(pageOfMan(page).find("\n.SH not"), std::string::npos);
    EXPECT_NE(pageOfMan(page).find("it's \\en [x]: 'y'"), std::string::npos);
    EXPECT_NE(zshCompletion(page, {}).find("\\[x\\]\\: '\\''y'\\''"), std::string::npos);
}

} // namespace
} // namespace rt::manual
