#include "Common/App/Session/DistinctFiles.h"

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "Common/App/Session/Outputs.h"
#include "Common/Core/Error.h"

namespace rt::app {
namespace {

namespace fs = std::filesystem;

struct NamedFile {
    std::string flag;
    fs::path path;
};

std::vector<NamedFile> writtenFiles(const Options& options) {
    std::vector<NamedFile> files;
    for (const fs::path output : options.outputs) {
        files.push_back({"--output", output});
        for (const Aov aov : options.aovs) files.push_back({"--aov", aovPath(output, aov)});
    }
    if (!options.checkpoint.empty()) files.push_back({"--checkpoint", options.checkpoint});
    if (!options.stats.empty() && options.stats != "-") files.push_back({"--stats", options.stats});
    return files;
}

std::vector<NamedFile> readFiles(const Options& options) {
    std::vector<NamedFile> files;
    std::error_code ignored;
    if (fs::exists(options.scene, ignored)) files.push_back({"--scene", options.scene}); // no built-in one
    if (!options.reference.empty()) files.push_back({"--reference", options.reference});
    if (!options.resume.empty()) files.push_back({"--resume", options.resume});
    return files;
}

// What a link that leads to no file yet stands for; it is made where the link says.
fs::path followed(fs::path path) {
    constexpr int kMaxLinks = 40; // as systems follow
    std::error_code ignored;
    for (int links = 0; links < kMaxLinks && fs::is_symlink(path, ignored); ++links)
        path = path.parent_path() / fs::read_symlink(path, ignored);
    return fs::weakly_canonical(fs::absolute(path, ignored), ignored);
}

bool isSame(const fs::path& a, const fs::path& b) {
    std::error_code ignored;
    const bool aExists = fs::exists(a, ignored), bExists = fs::exists(b, ignored);
    if (aExists != bExists) return false;
    if (aExists) return fs::is_regular_file(a, ignored) && fs::equivalent(a, b, ignored);
    return followed(a) == followed(b);
}

} // namespace

void checkDistinctFiles(const Options& options) {
    const std::vector<NamedFile> written = writtenFiles(options);
    for (std::size_t i = 0; i < written.size(); ++i) {
        const auto& [flag, path] = written[i];
        for (const NamedFile& read : readFiles(options)) {
            const bool goesOn = flag == "--checkpoint" && read.flag == "--resume";
            if (!goesOn && isSame(path, read.path))
                throw UsageError(flag + " " + path.string() + ": would overwrite the file of " + read.flag);
        }
        for (std::size_t j = 0; j < i; ++j)
            if (isSame(path, written[j].path))
                throw UsageError(flag + " " + path.string() + ": would overwrite " + written[j].path.string() + " of " +
                                 written[j].flag);
    }
}

} // namespace rt::app
