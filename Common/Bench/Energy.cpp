#include "Common/Bench/Energy.h"

#include <algorithm>
#include <fstream>

#include "Common/Core/Format.h"

namespace rt::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kNvmlSuccess = 0;

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

NvidiaEnergy::NvidiaEnergy(const std::array<std::uint8_t, 16>& uuid) : library_{"libnvidia-ml.so.1", "nvml.dll"} {
    auto* const init = library_.find<int()>("nvmlInit_v2");
    auto* const handleOf = library_.find<int(const char*, void**)>("nvmlDeviceGetHandleByUUID");
    if (init == nullptr || handleOf == nullptr || init() != kNvmlSuccess) return;
    started_ = true;
    if (handleOf(nvidiaUuid(uuid).c_str(), &device_) != kNvmlSuccess) device_ = nullptr;
}

NvidiaEnergy::~NvidiaEnergy() {
    if (auto* const shutdown = library_.find<int()>("nvmlShutdown"); started_ && shutdown != nullptr) shutdown();
}

std::optional<double> NvidiaEnergy::joules() const {
    auto* const energyOf = library_.find<int(void*, unsigned long long*)>("nvmlDeviceGetTotalEnergyConsumption");
    unsigned long long millijoules = 0;
    if (device_ == nullptr || energyOf == nullptr || energyOf(device_, &millijoules) != kNvmlSuccess)
        return std::nullopt;
    return static_cast<double>(millijoules) * 1e-3;
}

std::string nvidiaUuid(const std::array<std::uint8_t, 16>& uuid) {
    std::string text = "GPU";
    for (std::size_t i = 0; i < uuid.size(); ++i)
        text += (i == 0 || (i >= 4 && i <= 10 && i % 2 == 0) ? "-" : "") + formatted("%02x", uuid[i]);
    return text;
}

} // namespace rt::bench
