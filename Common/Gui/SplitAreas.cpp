#include "Common/Gui/SplitAreas.h"

#include <algorithm>
#include <cmath>

#include "Common/App/Interactive/GuiSettings.h"

namespace rt::gui {
namespace {

struct Halves {
    float first, second, secondAt; // lengths, and where the second begins
};

Halves halved(float from, float length, float share, float gap) {
    const float rest = std::max(2.0f, length - gap);
    const float first = std::clamp(std::floor(rest * share), 1.0f, rest - 1);
    return {first, rest - first, from + first + gap};
}

} // namespace

std::vector<Rect> splitAreas(const Rect& all, std::size_t count, const Splits& splits, float gap) {
    if (count < 2) return {all};
    const Halves x = halved(all.x, all.width, splits.x, gap);
    if (count < 4) return {{all.x, all.y, x.first, all.height}, {x.secondAt, all.y, x.second, all.height}};
    const Halves y = halved(all.y, all.height, splits.y, gap);
    return {{all.x, all.y, x.first, y.first},
            {x.secondAt, all.y, x.second, y.first},
            {all.x, y.secondAt, x.first, y.second},
            {x.secondAt, y.secondAt, x.second, y.second}};
}

Splitter splitterAt(const Rect& all, std::size_t count, const Splits& splits, float gap, float x, float y) {
    if (count < 2 || !all.contains(x, y)) return {};
    const std::vector<Rect> areas = splitAreas(all, count, splits, gap);
    const Rect &first = areas.front(), &last = areas.back();
    Splitter splitter;
    splitter.isX = x >= first.x + first.width && x < last.x;
    splitter.isY = count > 2 && y >= first.y + first.height && y < last.y;
    return splitter;
}

Splits movedTo(const Splits& splits, const Splitter& splitter, const Rect& all, float x, float y) {
    const auto share = [](float at, float from, float length) {
        return std::clamp((at - from) / std::max(1.0f, length), app::kMinSplit, app::kMaxSplit);
    };
    return {splitter.isX ? share(x, all.x, all.width) : splits.x,
            splitter.isY ? share(y, all.y, all.height) : splits.y};
}

} // namespace rt::gui
