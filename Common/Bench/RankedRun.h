// One render by several ranks: programs of their own, which mpirun starts.
#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "Common/Bench/Measurement.h"

namespace rt::bench {

// What starts ranks here.
struct RankLauncher {
    std::filesystem::path mpirun;      // empty: there is none
    std::vector<std::string> settings; // lets ranks share processors, as threads of one program do
    std::string missing;               // why there is none
    std::string version = {};          // as it says: "mpirun (Open MPI) 5.0.7"
};

// The mpirun of $PATH.
RankLauncher findRankLauncher();
// The given one, which is asked what it is.
RankLauncher rankLauncherAt(const std::filesystem::path& mpirun);

// What the launcher is told to do, but for its own name: `config` at `spp` samples per pixel.
std::vector<std::string> rankArguments(const RankLauncher& launcher, const std::filesystem::path& program,
                                       const Config& config, std::uint32_t spp, std::uint32_t seed,
                                       const std::filesystem::path& picture, const std::filesystem::path& statistics);

// Figures of a program's file of statistics, without its image. Throws what a JSON library throws.
Run toRun(const std::string& statistics);

// As measure(), at numbers of samples only: each is a render from the start, as long as the launcher runs, and figures
// are what rank 0 says of sampling. There is no warm-up, no energy, no processor time. Throws RenderError with the
// program's last line where it fails.
Run measureRanks(const RankLauncher& launcher, const Config& config, const Ladder& ladder, std::uint32_t seed,
                 const std::atomic<bool>& stop);

} // namespace rt::bench
