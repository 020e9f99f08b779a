#include "Common/Bench/Cells.h"

#include <cmath>
#include <filesystem>

#include "Common/Core/Format.h"

namespace rt::bench {

std::string percent(double value, int digits) {
    return formatted("%.*f %%", digits, 100 * value);
}

std::string whole(const Figure& figure) {
    if (!figure) return kUnknown;
    return formatted("%.0f", *figure);
}

std::string threeDigits(const Figure& figure) {
    if (!figure) return kUnknown;
    if (!std::isfinite(*figure)) return "∞";
    const double size = std::abs(*figure);
    return formatted(size >= 1000 && size < 1e6 ? "%.0f" : "%.3g", *figure);
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
