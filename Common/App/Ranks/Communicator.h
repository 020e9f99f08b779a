// Processes that render one image together, as mpirun starts them; each has a number, its rank.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

namespace rt::app {

using Bytes = std::vector<std::byte>;

struct Received {
    int from = 0; // its rank
    Bytes message;
};

// For one thread. Messages from one rank to another arrive in the order in which they were sent.
struct Communicator {
    virtual ~Communicator() = default; // waits for the others to do the same
    virtual int rank() const = 0;
    virtual int size() const = 0;
    virtual int localRank() const = 0; // among those on the same host
    virtual int localSize() const = 0;
    // Whether threads of this rank render on its processors, to which sending then leaves them; otherwise large
    // messages go out faster.
    virtual void setProcessorsRender(bool) {}
    // Returns at once. At most 1 GiB.
    virtual void send(int to, Bytes message) = 0;
    // A message that has arrived. Does not wait for one.
    virtual std::optional<Received> receive() = 0;
    // Ends all ranks, this one too.
    [[noreturn]] virtual void abort(int exitCode) = 0;
};

} // namespace rt::app
