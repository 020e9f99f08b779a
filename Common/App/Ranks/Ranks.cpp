#include "Common/App/Ranks/Ranks.h"

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "Common/App/Platform.h"
#include "Common/App/Ranks/Message.h"
#include "Common/Core/Error.h"
#include "Common/Core/Log.h"
#include "Common/Core/Paths.h"
#include "Common/Render/Stopwatch.h"

namespace rt::app {
namespace {

constexpr double kFarewell = 10; // seconds that rank 0 waits for the others in the end

// Where launchers tell processes how many there are: Open MPI; MPICH, Intel's and Microsoft's; Slurm.
constexpr const char* kSizeVariables[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"};

bool isStartedAsRank() {
    return std::any_of(std::begin(kSizeVariables), std::end(kSizeVariables), [](const char* variable) {
        const char* const value = std::getenv(variable);
        return value != nullptr && std::atoi(value) > 1;
    });
}

// Says farewell to all ranks. One that does not answer is stuck: then all are ended, so that nobody waits for ever, and
// `failure`, if there is one, is told before.
void endRanks(Communicator& ranks, int exitCode, const char* failure = nullptr) {
    for (int rank = 1; rank < ranks.size(); ++rank) ranks.send(rank, toBytes({MessageKind::End, nullptr, {}}));
    std::vector<bool> hasLeft(static_cast<std::size_t>(ranks.size()), false);
    hasLeft[0] = true;
    const Stopwatch watch;
    while (std::find(hasLeft.begin(), hasLeft.end(), false) != hasLeft.end()) {
        if (watch.seconds() > kFarewell) {
            const auto stuck = std::find(hasLeft.begin(), hasLeft.end(), false) - hasLeft.begin();
            logWarning("rank " + std::to_string(stuck) + " does not answer; all are ended");
            if (failure != nullptr) logWarning(failure);
            ranks.abort(exitCode);
        }
        if (auto received = ranks.receive()) {
            if (toMessage(std::move(received->message)).kind == MessageKind::Bye)
                hasLeft[static_cast<std::size_t>(received->from)] = true;
        } else {
            std::this_thread::sleep_for(kPollInterval);
        }
    }
}

void waitForEnd(Communicator& ranks) {
    for (;;) {
        auto received = ranks.receive();
        if (received && toMessage(std::move(received->message)).kind == MessageKind::End) return;
        if (!received) std::this_thread::sleep_for(kPollInterval);
    }
}

int lead(Communicator& ranks, const std::function<int()>& body) {
    try {
        const int code = body();
        endRanks(ranks, code);
        return code;
    } catch (const Error& error) {
        endRanks(ranks, static_cast<int>(error.code()), error.what());
        throw;
    } catch (const std::exception& error) {
        endRanks(ranks, static_cast<int>(ExitCode::Failure), error.what());
        throw;
    }
}

int follow(Communicator& ranks, const std::function<bool()>& body) {
    bool hasEnded = false;
    try {
        hasEnded = body();
    } catch (const std::exception& error) {
        ranks.send(0, toBytes(failureMessage(error)));
    }
    if (!hasEnded) waitForEnd(ranks);
    ranks.send(0, toBytes({MessageKind::Bye, nullptr, {}}));
    return static_cast<int>(ExitCode::Done);
}

} // namespace

std::unique_ptr<Communicator> joinRanks() {
    if (!isStartedAsRank()) return nullptr;
    const std::filesystem::path folder = executablePath().parent_path();
    const std::string file = (folder / RT_MPI_LIBRARY).string(),
                      installed = (folder / "../lib/ray-tracing-twins" / RT_MPI_LIBRARY).string();
    static const SharedLibrary library({file.c_str(), installed.c_str()}); // stays until the program ends, as MPI must
    const auto make = library.find<Communicator*()>("rtMakeCommunicator");
    if (make == nullptr)
        throw UsageError("mpirun has started several of these programs, but there is no " + file +
                         ", which is built where MPI is installed");
    std::unique_ptr<Communicator> ranks(make());
    if (ranks->size() < 2)
        throw UsageError(
            "several of these programs were started that do not know each other: start them by the mpirun "
            "of the MPI that they were built with, or by srun --mpi=pmix or --mpi=pmi2");
    return ranks;
}

int runOnRank(Communicator* ranks, const std::function<int()>& leader, const std::function<bool()>& follower) {
    if (ranks == nullptr) return leader();
    return ranks->rank() == 0 ? lead(*ranks, leader) : follow(*ranks, follower);
}

std::uint32_t threadsOfRank(const Communicator& ranks) {
    const std::uint32_t mine = std::max(1u, std::thread::hardware_concurrency()), all = processorCount();
    const auto share = all / static_cast<std::uint32_t>(ranks.localSize());
    return mine < all ? mine : std::max(1u, share); // fewer than all: the launcher has chosen them for this rank
}

} // namespace rt::app
