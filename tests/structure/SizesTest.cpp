// Files have at most 400 lines and functions at most 80, in production code: Common, both engines, Python, Shaders.
//
// Functions are found by braces, in the text without comments, strings and lines of the preprocessor: one that is
// opened outside of any function, behind a ')' and perhaps initialisers or qualifiers. Lambdas count to what they are
// in; what a macro spells out counts to nobody; a member initialised in braces counts as one more function. Lines are
// those from the opening brace to the closing one.
#include <algorithm>
#include <cctype>
#include <cstddef>
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

constexpr std::size_t kMaxFileLines = 400;
constexpr std::size_t kMaxFunctionLines = 80;

struct FoundFunction {
    std::string head; // what stands before its brace
    std::size_t line = 0;
    std::size_t lines = 0;
};

// Moves behind the string or character that begins at i.
std::size_t behindQuotes(std::string_view text, std::size_t i) {
    const char quote = text[i++];
    while (i < text.size() && text[i] != quote) i += text[i] == '\\' ? 2 : 1;
    return i + 1;
}

std::size_t behindRawString(std::string_view text, std::size_t i) {
    const std::size_t open = text.find('(', i);
    const std::string end = ")" + std::string(text.substr(i + 2, open - i - 2)) + "\"";
    const std::size_t found = text.find(end, open);
    return found == std::string_view::npos ? text.size() : found + end.size();
}

std::size_t behindPreprocessorLine(std::string_view text, std::size_t i) {
    std::size_t end = text.find('\n', i);
    while (end != std::string_view::npos && text[end - 1] == '\\') end = text.find('\n', end + 1);
    return end == std::string_view::npos ? text.size() : end;
}

// The code alone, with every line where it was.
std::string codeOf(std::string_view text) {
    std::string code;
    bool isLineStart = true;
    for (std::size_t i = 0; i < text.size();) {
        std::size_t end = i;
        if (text.substr(i, 2) == "//") {
            end = std::min(text.find('\n', i), text.size());
        } else if (text.substr(i, 2) == "/*") {
            end = std::min(text.find("*/", i), text.size() - 2) + 2;
        } else if (text.substr(i, 2) == "R\"") {
            end = behindRawString(text, i);
        } else if (text[i] == '"' ||
                   (text[i] == '\'' && (i == 0 || std::isalnum(static_cast<unsigned char>(text[i - 1])) == 0))) {
            end = behindQuotes(text, i);
        } else if (text[i] == '#' && isLineStart) {
            end = behindPreprocessorLine(text, i);
        }
        if (end > i) {
            for (; i < end && i < text.size(); ++i)
                if (text[i] == '\n') code += '\n';
            continue;
        }
        isLineStart = text[i] == '\n' || (isLineStart && text[i] == ' ');
        code += text[i++];
    }
    return code;
}

// Whether a brace behind this is that of a function, where none is open.
bool beginsFunction(const std::string& head) {
    static const std::regex type(R"(\b(namespace|class|struct|union|enum|concept)\b[^()]*$)");
    static const std::regex parameters(R"(\(.*\)|operator\s*\S+)");
    if (head.find('(') == std::string::npos || std::regex_search(head, type)) return false;
    return std::regex_replace(head, parameters, "").find('=') == std::string::npos;
}

std::vector<FoundFunction> functionsOf(std::string_view text) {
    std::vector<FoundFunction> functions;
    std::vector<bool> open; // braces, and whether they are those of a function
    FoundFunction current;
    bool isInside = false;
    std::string head;
    std::size_t line = 1;
    for (const char c : codeOf(text)) {
        if (c == '\n') ++line;
        if (c == '{') {
            open.push_back(!isInside && beginsFunction(head));
            if (open.back()) current = {head, line, 0};
            isInside = isInside || open.back();
        } else if (c == '}' && !open.empty()) {
            if (open.back()) {
                current.lines = line - current.line + 1;
                functions.push_back(current);
                isInside = false;
            }
            open.pop_back();
        }
        if (c == '{' || c == '}' || c == ';')
            head.clear();
        else if (!isInside)
            head += c == '\n' ? ' ' : c;
    }
    return functions;
}

std::string textOfSource(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<fs::path> productionFiles() {
    static const std::set<std::string> kinds = {".cpp",  ".h",    ".glsl",  ".comp", ".frag",
                                                ".vert", ".rgen", ".rchit", ".rint", ".rmiss"};
    std::vector<fs::path> files;
    for (const char* folder : {"Common", "Python", "RayTracingCPU", "RayTracingGPU", "Shaders"})
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(fs::path(RT_SOURCE_DIR) / folder))
            if (kinds.count(entry.path().extension().string()) != 0) files.push_back(entry.path());
    return files;
}

} // namespace

TEST(Sizes, NoFileIsTooLong) {
    for (const fs::path& file : productionFiles()) {
        const std::string text = textOfSource(file);
        const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
        EXPECT_LE(lines, kMaxFileLines) << file.string() << ": divide it by what it is about";
    }
}

TEST(Sizes, NoFunctionIsTooLong) {
    std::size_t count = 0;
    for (const fs::path& file : productionFiles())
        for (const FoundFunction& function : functionsOf(textOfSource(file))) {
            EXPECT_LE(function.lines, kMaxFunctionLines)
                << file.string() << ":" << function.line << ": " << function.head;
            ++count;
        }
    EXPECT_GT(count, 3000u) << "most functions were not found";
}

TEST(Sizes, FunctionsAreFoundByTheirBraces) {
    const std::vector<FoundFunction> found = functionsOf(R"text(
#define BODY(x) { \
    x; }
namespace a {
const int kList[] = {1, 2};
struct S {
    S() : x_{1}, y_(2) { // two lines
    }
    bool operator==(const S&) const = default;
    int x_ = 0;
};
template <class T>
auto f(T t) -> int { const char c = '{'; return [&] { return "}"; }().size(); }
int g() /* { */ {
    if (true) {
    }

}
} // namespace a
)text");
    ASSERT_EQ(found.size(), 4u);
    EXPECT_EQ(found[1].lines, 2u);
    EXPECT_EQ(found[2].lines, 1u);
    EXPECT_EQ(found[3].lines, 5u);
    EXPECT_EQ(found[3].line, 14u);
}
