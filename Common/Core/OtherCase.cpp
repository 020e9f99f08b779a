#include "Common/Core/OtherCase.h"

#include <algorithm>
#include <string>
#include <system_error>

namespace rt {

namespace fs = std::filesystem;

namespace {

char lowerLetter(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool areAlike(const std::string& a, const std::string& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return lowerLetter(x) == lowerLetter(y); });
}

// What there is in a folder under this name, or in other case.
fs::path findEntry(const fs::path& folder, const fs::path& name) {
    std::error_code error;
    if (fs::exists(folder / name, error)) return folder / name;
    fs::path best;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        const fs::path entry = at->path().filename();
        if (areAlike(entry.string(), name.string()) && (best.empty() || entry < best)) best = entry;
    }
    return best.empty() ? fs::path() : folder / best;
}

} // namespace

fs::path findInOtherCase(const fs::path& path) {
    if (!path.is_absolute()) return {};
    fs::path found = path.root_path();
    for (const fs::path& name : path.lexically_normal().relative_path()) {
        found = findEntry(found, name);
        if (found.empty()) return {};
    }
    std::error_code ignored;
    return fs::is_regular_file(found, ignored) ? found : fs::path();
}

} // namespace rt
