// The guides name files and symbols of this tree, and only such: in README.md and docs/*.md, whatever stands between
// backquotes and looks like a path, a file or a name has to exist.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

const fs::path kSources = RT_SOURCE_DIR;

struct Tree {
    std::vector<std::string> files; // relative to the root, with forward slashes
    std::set<std::string, std::less<>> words;
};

std::string textOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

bool isWordCharacter(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

void addWords(std::string_view text, std::set<std::string, std::less<>>& words) {
    for (std::size_t i = 0; i < text.size();) {
        std::size_t end = i;
        while (end < text.size() && isWordCharacter(text[end])) ++end;
        if (end > i && words.find(text.substr(i, end - i)) == words.end()) words.emplace(text.substr(i, end - i));
        i = std::max(end, i + 1);
    }
}

Tree readTree() {
    Tree tree;
    const std::set<std::string> texts = {".h",    ".cpp",   ".glsl",  ".comp",  ".frag", ".vert", ".rgen", ".rchit",
                                         ".rint", ".rmiss", ".rcall", ".cmake", ".txt",  ".json", ".sh",   ".py"};
    for (const char* top :
         {"Assets", "Common", "Python", "RayTracingCPU", "RayTracingGPU", "Shaders", "cmake", "tests", "examples",
          "docs", "build.sh", "build.bat", "CMakeLists.txt", "CMakePresets.json", "vcpkg.json"}) {
        std::vector<fs::path> found = {kSources / top};
        if (fs::is_directory(kSources / top)) {
            found.assign(fs::recursive_directory_iterator(kSources / top), fs::recursive_directory_iterator());
        }
        for (const fs::path& path : found) {
            const std::string relative = path.lexically_relative(kSources).generic_string();
            tree.files.push_back(relative);
            addWords(path.stem().string(), tree.words);
            if (!relative.starts_with("docs") && texts.count(path.extension().string()) != 0) {
                addWords(textOf(path), tree.words);
            }
        }
    }
    return tree;
}

std::vector<fs::path> guides() {
    std::vector<fs::path> found = {kSources / "README.md"};
    for (const fs::directory_entry& entry : fs::directory_iterator(kSources / "docs"))
        if (entry.path().extension() == ".md") found.push_back(entry.path());
    return found;
}

// What stands between single backquotes; blocks of code are left out.
std::vector<std::string> codeSpans(const fs::path& guide) {
    static const std::regex fence("```[^`]*```"), span("`([^`\n]+)`");
    const std::string text = std::regex_replace(textOf(guide), fence, "");
    std::vector<std::string> spans;
    for (std::sregex_iterator match(text.begin(), text.end(), span), end; match != end; ++match)
        spans.push_back((*match)[1]);
    return spans;
}

// Source files, folders and files of this tree. X.ext and F.json stand for any name.
bool looksLikePath(const std::string& span) {
    static const std::regex path(R"([A-Za-z][\w.-]*(/[\w.*-]+)+/?)");
    static const std::regex file(
        R"([A-Za-z]\w[\w.*-]*\.(h|cpp|glsl|comp|rgen|rcall|rchit|rint|rmiss|vert|frag|cmake|sh|json|md))");
    return std::regex_match(span, path) || std::regex_match(span, file);
}

bool existsInTree(const Tree& tree, std::string span) {
    if (span.back() == '/') span.pop_back();
    std::string pattern;
    for (const char c : span)
        pattern += c == '*' ? std::string(".*") : c == '.' ? std::string("\\.") : std::string(1, c);
    const std::regex ending("(.*/)?" + pattern);
    const auto isNamed = [&](const std::string& file) { return std::regex_match(file, ending); };
    if (std::ranges::any_of(tree.files, isNamed)) return true;
    // X.Variant.ext is a shader that is made of X.ext.
    static const std::regex variant(R"((\w+)(\.\w+)+(\.\w+))");
    std::smatch parts;
    return std::regex_match(span, parts, variant) && existsInTree(tree, parts[1].str() + parts[3].str());
}

// Extensions of Vulkan are named by Vulkan.
bool looksLikeName(const std::string& span) {
    static const std::regex name(R"([A-Za-z_]\w*(::\w+)*(\(\))?)");
    return std::regex_match(span, name) && !span.starts_with("VK_");
}

} // namespace

// [text](file#place) and src="file" lead to files of this tree.
TEST(Guides, LinksLeadSomewhere) {
    static const std::regex link(R"re(\]\(([^)#\s]+)(#[^)]*)?\)|src="([^"]+)")re");
    std::size_t links = 0;
    std::vector<fs::path> pages = {kSources / "README.md", kSources / "CONTRIBUTING.md", kSources / "CHANGELOG.md"};
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kSources / "docs"))
        if (entry.path().extension() == ".md") pages.push_back(entry.path());
    for (const fs::path& guide : pages) {
        const std::string text = textOf(guide);
        for (std::sregex_iterator match(text.begin(), text.end(), link), end; match != end; ++match) {
            const std::string target = (*match)[1].matched ? (*match)[1] : (*match)[3];
            if (target.starts_with("http")) continue;
            ++links;
            EXPECT_TRUE(fs::exists(guide.parent_path() / target)) << guide.string() << " links " << target;
        }
    }
    EXPECT_GT(links, 30u);
}

TEST(Guides, ReadmeIsOnePage) {
    const std::string text = textOf(kSources / "README.md");
    EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 100);
    for (const char* command : {"./build.sh run", "./build.sh test", "./build.sh package"})
        EXPECT_NE(text.find("\n    " + std::string(command) + " "), std::string::npos) << command;
}

TEST(Guides, NameOnlyWhatExists) {
    const Tree tree = readTree();
    std::size_t paths = 0, names = 0;
    for (const fs::path& guide : guides()) {
        for (const std::string& span : codeSpans(guide)) {
            if (looksLikePath(span)) {
                ++paths;
                EXPECT_TRUE(existsInTree(tree, span))
                    << guide.filename().string() << " names the file `" << span << "`";
            } else if (looksLikeName(span)) {
                ++names;
                std::set<std::string, std::less<>> parts;
                addWords(span, parts);
                for (const std::string& part : parts)
                    EXPECT_TRUE(tree.words.count(part)) << guide.filename().string() << " names `" << span << "`";
            }
        }
    }
    EXPECT_GT(paths, 20u);
    EXPECT_GT(names, 50u);
}
