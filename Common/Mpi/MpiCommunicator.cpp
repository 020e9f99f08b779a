// Ranks over MPI. A library of its own that is loaded when mpirun has started the program, so that the programs run
// where there is no MPI.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <list>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#define OMPI_SKIP_MPICXX 1 // the C++ bindings are not used
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include "Common/App/Ranks/Communicator.h"

#ifdef _WIN32
#define RT_EXPORT __declspec(dllexport)
#else
#define RT_EXPORT __attribute__((visibility("default")))
#endif

namespace rt::app {
namespace {

constexpr std::chrono::milliseconds kPush{20};
constexpr std::chrono::microseconds kShortestPushPause{100}, kLongestPushPause{1600};

// On one host Open MPI needs nothing but what sends through memory; that it looks for networks takes it a fifth of a
// second. What its user has chosen stays.
void skipNetworksOfOneHost() {
#ifdef OPEN_MPI
    const char* const all = std::getenv("OMPI_COMM_WORLD_SIZE");
    const char* const here = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
    if (all != nullptr && here != nullptr && std::string(all) == here) setenv("OMPI_MCA_pml", "ob1", 0);
#endif
}

// MPI's default is to end all ranks when one of its calls fails, so results are not looked at.
class MpiCommunicator final : public Communicator {
  public:
    MpiCommunicator() {
        skipNetworksOfOneHost();
        int provided = 0;
        MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
        MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
        MPI_Comm_size(MPI_COMM_WORLD, &size_);
        MPI_Comm host = MPI_COMM_NULL;
        MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &host);
        MPI_Comm_rank(host, &localRank_);
        MPI_Comm_size(host, &localSize_);
        MPI_Comm_free(&host);
    }
    ~MpiCommunicator() override {
        for (Sending& sending : sending_) MPI_Wait(&sending.request, MPI_STATUS_IGNORE);
        MPI_Finalize();
    }

    int rank() const override { return rank_; }
    int size() const override { return size_; }
    int localRank() const override { return localRank_; }
    int localSize() const override { return localSize_; }

    void setProcessorsRender(bool render) override { processorsRender_ = render; }

    void send(int to, Bytes message) override {
        forgetSent();
        Sending& sending = sending_.emplace_back();
        sending.message = std::move(message);
        MPI_Isend(sending.message.data(), static_cast<int>(sending.message.size()), MPI_BYTE, to, 0, MPI_COMM_WORLD,
                  &sending.request);
    }

    std::optional<Received> receive() override {
        push();
        int arrived = 0;
        MPI_Status status;
        MPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &arrived, &status);
        if (arrived == 0) return std::nullopt;
        int bytes = 0;
        MPI_Get_count(&status, MPI_BYTE, &bytes);
        Received received{status.MPI_SOURCE, Bytes(static_cast<std::size_t>(bytes))};
        MPI_Recv(received.message.data(), bytes, MPI_BYTE, status.MPI_SOURCE, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        return received;
    }

    [[noreturn]] void abort(int exitCode) override {
        MPI_Abort(MPI_COMM_WORLD, exitCode);
        std::_Exit(exitCode);
    }

  private:
    struct Sending {
        Bytes message; // must stay where it is until it is sent
        MPI_Request request = MPI_REQUEST_NULL;
    };

    // A large message goes out piece by piece, whenever MPI is called: a result would take as long as its rank is
    // asleep between two looks. Rank 0, which sends little, does not wait for a rank that may have stopped. The pauses
    // leave the processor to threads that render, if there are any, the longer the longer rank 0 does not look.
    void push() {
        const auto begin = std::chrono::steady_clock::now();
        auto pause = kShortestPushPause;
        forgetSent();
        while (rank_ != 0 && !sending_.empty() && std::chrono::steady_clock::now() - begin < kPush) {
            std::this_thread::sleep_for(pause);
            if (processorsRender_) pause = std::min(2 * pause, kLongestPushPause);
            forgetSent();
        }
    }

    void forgetSent() {
        std::erase_if(sending_, [](Sending& sending) {
            int sent = 0;
            MPI_Test(&sending.request, &sent, MPI_STATUS_IGNORE);
            return sent != 0;
        });
    }

    int rank_ = 0, size_ = 1, localRank_ = 0, localSize_ = 1;
    bool processorsRender_ = true;
    std::list<Sending> sending_;
};

} // namespace
} // namespace rt::app

extern "C" RT_EXPORT rt::app::Communicator* rtMakeCommunicator() {
    return new rt::app::MpiCommunicator; // which the caller owns
}
