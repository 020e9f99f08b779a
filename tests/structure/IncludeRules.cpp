// Who may include whom. Arrows are transitive; a folder may always include itself.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = RT_SOURCE_DIR;
const std::set<std::string> kMains = {"Main.cpp", "RayTracingBench.cpp"};

const std::map<std::string, std::vector<std::string>> kArrows = {
    {"Common/Shared", {}},
    {"Common/Core", {}},
    {"Common/Manual", {"Common/Core"}},
    {"Common/Scene", {"Common/Core", "Common/Shared"}},
    {"Common/Accel", {"Common/Core", "Common/Shared"}},
    {"Common/Image", {"Common/Core", "Common/Shared"}},
    {"Common/Render", {"Common/Scene", "Common/Image"}},
    {"Common/App", {"Common/Render", "Common/Manual"}},
    {"Common/Bench", {"Common/App"}},
    {"Common/Probe", {"Common/App", "Common/Accel"}},
    {"Common/Tools", {"Common/App", "Common/Bench", "Common/Probe"}},
    {"Common/Mpi", {"Common/App"}},
    {"Common/Vulkan", {"Common/Core"}},
    // The panel of the sampler shows what Probe works out, which sees the scene as App has loaded it: below App it
    // cannot be.
    {"Common/Gui", {"Common/App", "Common/Probe", "Common/Vulkan", "Shaders"}},
    {"RayTracingCPU", {"Common/Render", "Common/Accel"}},
    {"RayTracingGPU", {"Common/Render", "Common/Accel", "Common/Vulkan", "Shaders"}},
    {"Python", {"Common/App", "Common/Probe", "RayTracingCPU", "RayTracingGPU"}},
    {"Shaders", {"Common/Shared"}},
};

void addReachable(const std::string& folder, std::set<std::string>& reachable) {
    if (!reachable.insert(folder).second) return;
    for (const std::string& next : kArrows.at(folder)) addReachable(next, reachable);
}

// "Common/Scene" for Common/Scene/a/b.h, "Shaders" for Shaders/x.glsl.
std::string folderOf(const fs::path& relative) {
    auto part = relative.begin();
    std::string folder = part->string();
    if (folder == "Common" && std::next(part) != relative.end()) folder += "/" + std::next(part)->string();
    return folder;
}

struct Include {
    std::size_t line;
    std::string target; // as written between the quotes
};

std::vector<Include> quotedIncludes(const fs::path& file) {
    static const std::regex pattern(R"(^\s*#\s*include\s*\"([^\"]+)\")");
    std::vector<Include> includes;
    std::ifstream in(file);
    std::string text;
    for (std::size_t line = 1; std::getline(in, text); ++line) {
        std::smatch match;
        if (std::regex_search(text, match, pattern)) includes.push_back({line, match[1]});
    }
    return includes;
}

// Path relative to the root of what `target` names in `file`; empty when there is no such file of ours. The header
// X.rgen.h is generated from Shaders/X.rgen and counts as that.
fs::path resolve(const fs::path& file, const std::string& target) {
    fs::path shader = fs::path("Shaders") / fs::path(target).stem();
    if (fs::exists(kRoot / shader)) return shader;
    for (const fs::path& base : {kRoot, file.parent_path()}) {
        if (fs::exists(base / target))
            return fs::weakly_canonical(base / target).lexically_relative(fs::canonical(kRoot));
    }
    return {};
}

// Sources of a folder whose includes are bound by the rule: the mains of the two programs and of the benchmark alone
// may see everything.
std::vector<fs::path> sourcesOf(const std::string& folder) {
    std::vector<fs::path> sources;
    if (!fs::exists(kRoot / folder)) return sources;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kRoot / folder)) {
        if (entry.is_regular_file() && !kMains.count(entry.path().filename().string())) sources.push_back(entry.path());
    }
    return sources;
}

} // namespace

TEST(IncludeRules, EveryQuotedIncludeFollowsAnArrow) {
    std::size_t checked = 0;
    for (const auto& [folder, unused] : kArrows) {
        std::set<std::string> reachable;
        addReachable(folder, reachable);
        for (const fs::path& file : sourcesOf(folder)) {
            for (const Include& include : quotedIncludes(file)) {
                const fs::path target = resolve(file, include.target);
                EXPECT_FALSE(target.empty())
                    << file.string() << ":" << include.line << ": no file of this project is named \"" << include.target
                    << "\"; others are included with <>";
                EXPECT_TRUE(target.empty() || reachable.count(folderOf(target)))
                    << file.string() << ":" << include.line << ": " << folder << " may not include " << include.target;
                ++checked;
            }
        }
    }
    EXPECT_GT(checked, 0u) << "found no include below " << kRoot;
}

TEST(IncludeRules, EveryFolderOfCommonHasItsArrows) {
    for (const fs::directory_entry& entry : fs::directory_iterator(kRoot / "Common")) {
        if (!entry.is_directory()) continue;
        const std::string folder = "Common/" + entry.path().filename().string();
        EXPECT_TRUE(kArrows.count(folder)) << folder << " is missing in the table of arrows";
    }
}
