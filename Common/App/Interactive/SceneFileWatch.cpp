#include "Common/App/Interactive/SceneFileWatch.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace rt::app {

bool SceneFileWatch::isDue(const std::vector<WatchedFile>& files) {
    std::vector<std::optional<FileFingerprint>> marks;
    marks.reserve(files.size());
    for (const WatchedFile& watched : files) marks.push_back(markOf(watched.file));
    if (std::exchange(seen_, marks) != marks) return false;
    const auto has = [](const auto& list, const auto& mark) {
        return std::find(list.begin(), list.end(), mark) != list.end();
    };
    for (std::size_t i = 0; i < files.size(); ++i)
        if (marks[i] && !has(files[i].known, marks[i]) && !has(asked_, marks[i])) return true;
    return false;
}

} // namespace rt::app
