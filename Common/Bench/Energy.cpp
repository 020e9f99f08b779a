#include "Common/Bench/Energy.h"

#include <algorithm>
#include <fstream>
#include <string>

namespace rt::bench {
namespace {

namespace fs = std::filesystem;

std::optional<std::uint64_t> readNumber(const fs::path& file) {
    std::ifstream in(file);
    std::uint64_t value = 0;
    return in >> value ? std::optional(value) : std::nullopt;
}

// "intel-rapl:0", a package; "intel-rapl:0:1" is a part of one, and "intel-rapl-mmio:0" the same package again.
bool isPackage(const std::string& name) {
    return name.rfind("intel-rapl:", 0) == 0 && std::count(name.begin(), name.end(), ':') == 1;
}

} // namespace

EnergyMeter::EnergyMeter(const fs::path& folder) {
    std::error_code none;
    for (const fs::directory_entry& zone : fs::directory_iterator(folder, none)) {
        if (!isPackage(zone.path().filename().string())) continue;
        const auto start = readNumber(zone.path() / "energy_uj");
        const auto range = readNumber(zone.path() / "max_energy_range_uj");
        if (start && range) counters_.push_back({zone.path() / "energy_uj", *start, *range});
    }
}

std::optional<double> EnergyMeter::joules() const {
    if (counters_.empty()) return std::nullopt;
    double total = 0;
    for (const Counter& counter : counters_) {
        const auto now = readNumber(counter.file);
        if (!now) return std::nullopt;
        total +=
            static_cast<double>(*now >= counter.start ? *now - counter.start : *now + counter.range - counter.start);
    }
    return total * 1e-6;
}

} // namespace rt::bench
