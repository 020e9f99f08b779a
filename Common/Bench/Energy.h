// What processor and GPU have consumed, where the system says so.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "Common/App/Platform.h"

namespace rt::bench {

// Joules since some time; nothing where that is not known.
using EnergyCounter = std::function<std::optional<double>()>;

// From its making on. Reads the counters of the packages that Linux shows below /sys/class/powercap (Intel's and AMD's
// RAPL); elsewhere, or where they may not be read, nothing is known.
class EnergyMeter {
  public:
    explicit EnergyMeter(const std::filesystem::path& folder = "/sys/class/powercap");

    std::optional<double> joules() const;

  private:
    struct Counter {
        std::filesystem::path file;
        std::uint64_t start; // microjoules
        std::uint64_t range; // after which it begins anew
    };
    std::vector<Counter> counters_;
};

// An NVIDIA GPU's own counter, which its driver's library NVML tells; nothing where there is no such library or GPU, or
// the GPU does not count (before Volta).
class NvidiaEnergy {
  public:
    explicit NvidiaEnergy(const std::array<std::uint8_t, 16>& uuid); // as Vulkan names the device
    ~NvidiaEnergy();
    NvidiaEnergy(const NvidiaEnergy&) = delete;
    NvidiaEnergy& operator=(const NvidiaEnergy&) = delete;

    // Since the driver was loaded. The counter moves every tenth of a second or so.
    std::optional<double> joules() const;

  private:
    app::SharedLibrary library_;
    bool started_ = false;
    void* device_ = nullptr;
};

// As NVML and the driver's tools write it: "GPU-8a6b...".
std::string nvidiaUuid(const std::array<std::uint8_t, 16>& uuid);

} // namespace rt::bench
