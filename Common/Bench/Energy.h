// What the processor has consumed, where the system says so.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace rt::bench {

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

} // namespace rt::bench
