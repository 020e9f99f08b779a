#include "Common/Bench/Cells.h"

#include <cmath>
#include <cstdio>
#include <filesystem>

namespace rt::bench {

std::string percent(double value, int digits) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f %%", digits, 100 * value);
    return text;
}

std::string whole(const Figure& figure) {
    if (!figure) return kUnknown;
    char text[32];
    std::snprintf(text, sizeof text, "%.0f", *figure);
    return text;
}

std::string threeDigits(const Figure& figure) {
    if (!figure) return kUnknown;
    if (!std::isfinite(*figure)) return "∞";
    char text[32];
    const double size = std::abs(*figure);
    std::snprintf(text, sizeof text, size >= 1000 && size < 1e6 ? "%.0f" : "%.3g", *figure);
    return text;
}

std::string withInterval(const Figure& value, const Figure& half) {
    std::string text = threeDigits(value);
    if (value && half && *value > 0) text += " ±" + percent(*half / *value, 0);
    return text;
}

std::string sceneName(const std::string& scene) {
    return std::filesystem::path(scene).filename().string();
}

std::string nameOf(const Config& config, const std::vector<const Config*>& others,
                   const std::function<bool(const Axis&)>& counts) {
    if (config.imported) return config.engine;
    std::string name;
    for (const Axis& axis : axes()) {
        std::set<std::string> values;
        for (const Config* other : others) values.insert(axis.get(*other));
        if (values.size() > 1 && counts(axis)) name += (name.empty() ? "" : ", ") + axis.get(config);
    }
    return name;
}

} // namespace rt::bench
