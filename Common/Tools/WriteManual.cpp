// rt-write-manual FOLDER: writes man pages, completions and the reference of the flags; the build runs it.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "Common/Core/BuildInfo.h"
#include "Common/Core/RunMain.h"
#include "Common/Manual/Formats.h"
#include "Common/Tools/Pages.h"

namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream out(file, std::ios::binary);
    out << text;
    if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

int writeManual(const fs::path& folder) {
    const std::vector<std::string> scenes = rt::tools::sceneIds();
    for (const rt::manual::Page& page : rt::tools::allPages()) {
        write(folder / "man" / (page.name + ".1"), rt::manual::manPage(page, rt::programVersion()));
        write(folder / "bash" / page.name, rt::manual::bashCompletion(page, scenes));
        write(folder / "zsh" / ("_" + page.name), rt::manual::zshCompletion(page, scenes));
        write(folder / "fish" / (page.name + ".fish"), rt::manual::fishCompletion(page, scenes));
    }
    write(folder / "reference.md", rt::tools::referenceText());
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("rt-write-manual: say which folder to write to\n", stderr);
        return 2;
    }
    return rt::runMain("rt-write-manual", [argv] { return writeManual(argv[1]); });
}
